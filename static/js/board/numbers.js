/** Numbers at the selection: a corner's place, an edge's length, a fold's ends on their edges, the placement. */

import { button, byId, element, field, group } from "../dom.js";
import { say } from "../language/say.js";
import { NumberFields } from "./number_fields.js";
import { unit } from "./units.js";

/** @import { Act, Field } from "./number_fields.js" */
/** @import { Point } from "pleat" */

export class Numbers {
  /** @param {import("./board.js").Board} board */
  constructor(board) {
    this.board = board;
    this.root = element("div", "numbers-at for-editors");
    group(this.root, say("numbers.label"));
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
    const { top } = this.board.place;
    const size = /** @type {Point} */ ([this.root.offsetWidth, this.root.offsetHeight]);
    const room = this.room;
    if (isNew) this.side = sideOf(at, size, room, this.board.pointer.last);
    const [x, y] = within(beside(at, size, this.side), size, room);
    this.root.style.left = `${x}px`;
    this.root.style.top = `${top + y}px`;
  }

  /** What of the board nothing else lies over. @returns {Room} */
  get room() {
    const { place, covered, coveredSide, root } = this.board;
    const [own, inset] = [root.getBoundingClientRect(), byId("swap").getBoundingClientRect()];
    const corner = /** @type {Point} */ ([inset.left - own.left, inset.top - own.top - place.top]);
    return { low: [0, covered], high: [place.width - coveredSide, place.height], corner: inset.width ? corner : null };
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
    const input = field({ ariaLabel: name });
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

const AWAY_PX = 16;
const MARGIN_PX = 8;
/** So far round the pointer nothing shall come between it and the board. */
const FREE_PX = 12;
/** @typedef {{low: Point, high: Point, corner: Point|null}} Room from where to where (px), and where on a phone the inset begins */

/** To the right and below, if it can be. @type {Point[]} */
const SIDES = [
  [1, 1],
  [-1, 1],
  [1, -1],
  [-1, -1],
];

/**
 * The side of a place on which a panel has room, and does not come to lie under the pointer: a second click is meant for
 * what the first one was.
 * @param {Point} at px
 * @param {Point} size the panel's (px)
 * @param {Room} room
 * @param {Point|null} pointer px
 * @returns {Point}
 */
function sideOf(at, size, room, pointer) {
  /** @param {Point} side */
  const cost = (side) => {
    const wanted = beside(at, size, side);
    const kept = within(wanted, size, room);
    const isUnder = pointer && pointer.every((p, axis) => kept[axis] - FREE_PX < p && p < kept[axis] + size[axis] + FREE_PX);
    return (isUnder ? 2 : 0) + (kept.some((part, axis) => part !== wanted[axis]) ? 1 : 0);
  };
  return SIDES.reduce((best, side) => (cost(side) < cost(best) ? side : best));
}

/** @param {Point} at @param {Point} size @param {Point} side @returns {Point} */
const beside = (at, size, side) => along((axis) => at[axis] + side[axis] * AWAY_PX - (side[axis] < 0 ? size[axis] : 0));

/** The panel's left and top, kept where it covers nothing. @param {Point} wanted @param {Point} size @param {Room} room @returns {Point} */
function within(wanted, size, { low, high, corner }) {
  /** @param {Point} to */
  const before = (to) =>
    along((axis) => Math.max(Math.min(wanted[axis], to[axis] - size[axis] - MARGIN_PX), low[axis] + MARGIN_PX));
  const place = before(high);
  const isOverInset = corner?.every((begin, axis) => place[axis] + size[axis] + MARGIN_PX > begin);
  return corner && isOverInset ? before([high[0], corner[1]]) : place;
}

/** The same along both axes. @param {(axis: 0|1) => number} part @returns {Point} */
const along = (part) => [part(0), part(1)];
