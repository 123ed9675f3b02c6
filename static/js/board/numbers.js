/** Numbers at the selection: a corner's place, an edge's length, a fold's ends on their edges, the placement. */

import { button, element } from "../dom.js";
import { say } from "../language/say.js";
import { placeOf, sideOf } from "./beside.js";
import { NumberFields } from "./number_fields.js";
import { unit } from "./units.js";

/** @import { Point } from "pleat" */
/** @import { Act, Field } from "./number_fields.js" */

export class Numbers {
  /** @param {import("./board.js").Board} board */
  constructor(board) {
    this.board = board;
    this.root = element("div", "numbers-at");
    this.root.setAttribute("role", "group");
    this.root.setAttribute("aria-label", say("numbers.label"));
    this.root.hidden = true;
    this.shown = "";
    this.known = new NumberFields(board);
    /** @type {Field[]} */
    this.fields = [];
    /** @type {Act[]} */
    this.acts = [];
    /** @type {Point} */
    this.side = [1, 1];
    board.root.append(this.root);
  }

  /** Show the fields of what is selected, beside it. */
  draw() {
    const found = this.board.isQuiet ? this.known.found() : null;
    this.root.hidden = !found;
    if (!found) {
      this.shown = "";
      return;
    }
    const { acts = [] } = found;
    const names = `${found.key} ${[...found.fields, ...acts].map(({ name }) => name)} ${unit.name}`;
    const isNew = names !== this.shown;
    this.fields = found.fields;
    this.acts = acts;
    if (isNew)
      this.root.replaceChildren(
        ...found.fields.map((field, index) => this.row(field, index)),
        ...acts.map((act, index) => this.verb(act, index)),
      );
    this.shown = names;
    for (const [index, input] of [...this.root.querySelectorAll("input")].entries()) {
      if (document.activeElement !== input) input.value = found.fields[index].value;
    }
    this.put(found.at, isNew);
  }

  /** Beside its place; on which side is chosen when it appears. @param {Point} at px @param {boolean} isNew */
  put(at, isNew) {
    const { width, height, top } = this.board.place;
    const size = /** @type {Point} */ ([this.root.offsetWidth, this.root.offsetHeight]);
    if (isNew) this.side = sideOf(at, size, [width, height], this.board.pointer.last);
    const [x, y] = placeOf(at, size, [width, height], this.side);
    this.root.style.left = `${x}px`;
    this.root.style.top = `${top + y}px`;
  }

  /** @param {string} [key] of the field; by default the first one gets the focus */
  focus(key = "") {
    this.draw(); // what was selected just now may not have been drawn yet
    const index = Math.max(this.fields.findIndex((field) => field.key === key), 0);
    const input = this.root.hidden ? null : this.root.querySelectorAll("input")[index];
    input?.focus();
    return Boolean(input);
  }

  /** @param {Field} field @param {number} index */
  row({ label, name }, index) {
    const input = /** @type {HTMLInputElement} */ (element("input", "field"));
    input.type = "text";
    input.autocomplete = "off";
    input.setAttribute("aria-label", name);
    input.addEventListener("focus", () => input.select());
    input.addEventListener("change", () => this.take(index, input));
    input.addEventListener("keydown", (event) => this.key(event, index, input));
    return element("label", "number-at", element("span", "", label), input);
  }

  /** @param {Act} act @param {number} index */
  verb({ label, name }, index) {
    const made = button("text-button is-dense", () => this.acts[index].act(), label);
    made.title = name;
    made.addEventListener("keydown", (event) => {
      event.stopPropagation();
      if (event.key === "Escape") this.board.svg.focus({ preventScroll: true });
    });
    return made;
  }

  /** @param {number} index @param {HTMLInputElement} input */
  take(index, input) {
    const problem = this.fields[index].put(input.value);
    if (!problem) return;
    this.board.store.refuse(problem);
    input.value = this.fields[index].value;
  }

  /**
   * With Enter or Escape the field is left, and what was written in it changes something as it always does then.
   * @param {KeyboardEvent} event
   * @param {number} index
   * @param {HTMLInputElement} input
   */
  key(event, index, input) {
    event.stopPropagation();
    if (event.key === "Escape") input.value = this.fields[index].value;
    if (event.key === "Enter" || event.key === "Escape") {
      event.preventDefault();
      this.board.svg.focus({ preventScroll: true });
    }
  }
}
