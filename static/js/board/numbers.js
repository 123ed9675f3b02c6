/** Numbers at the selection: a corner's place, an edge's length, a fold's ends on their edges, the placement. */

import { element } from "../dom.js";
import { numeral } from "../language/numeral.js";
import { inEnglish, say } from "../language/say.js";
import { placeOf, sideOf } from "./beside.js";
import { middleOf, moveCorners, moveFold } from "./edits.js";
import { between, distance, toOuter } from "./geometry.js";
import { MOVE_CORNER } from "./rules.js";
import { atLength } from "./snap.js";
import { laid } from "./tools/place.js";
import { evaluated, number, parsed, problemOf, unit } from "./units.js";

/** @import { Drawing, Fold, Point } from "pleat" */

const DEGREE = Math.PI / 180;

/** @typedef {{label: string, name: string, value: string, put: (text: string) => string}} Field */
/** @typedef {(metres: number, drawing: Drawing) => void} Put */
/** @typedef {{key: string, at: Point, fields: Field[]}|null} Found */

export class Numbers {
  /** @param {import("./board.js").Board} board */
  constructor(board) {
    this.board = board;
    this.root = element("div", "numbers-at");
    this.root.setAttribute("role", "group");
    this.root.setAttribute("aria-label", say("numbers.label"));
    this.root.hidden = true;
    this.shown = "";
    /** @type {Field[]} */
    this.fields = [];
    /** @type {Point} */
    this.side = [1, 1];
    board.root.append(this.root);
  }

  /** Show the fields of what is selected, beside it. */
  draw() {
    const found = this.board.isQuiet ? this.found() : null;
    this.root.hidden = !found;
    if (!found) {
      this.shown = "";
      return;
    }
    const names = `${found.key} ${found.fields.map(({ name }) => name)} ${unit.name}`;
    const isNew = names !== this.shown;
    this.fields = found.fields;
    if (isNew) this.root.replaceChildren(...found.fields.map((field, index) => this.row(field, index)));
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

  focus() {
    this.draw(); // what was selected just now may not have been drawn yet
    const input = this.root.hidden ? null : this.root.querySelector("input");
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

  /** @returns {Found} */
  found() {
    const { kind, ids } = this.board.store.selection ?? {};
    if (this.board.isPlacing) return this.ofPlacement();
    if (ids?.length !== 1) return null;
    const [id] = ids;
    if (kind === "vertex" && this.board.isSpread) return this.ofCorner(id);
    if (kind === "edge" && this.board.isSpread) return this.ofEdge(id);
    return kind === "fold" ? this.ofFold(id) : null;
  }

  /** @param {string} id @returns {Found} */
  ofCorner(id) {
    const corner = this.board.drawing.outline.find((other) => other.id === id);
    if (!corner) return null;
    /** @param {0|1} axis @returns {Field} */
    const field = (axis) => ({
      label: "xy"[axis],
      name: say("numbers.coordinate", { axis: "xy"[axis] }),
      value: number(corner.point[axis]),
      put: (text) =>
        this.move(
          text,
          (metres, drawing) => {
            const now = drawing.outline.find((other) => other.id === id)?.point ?? corner.point;
            moveCorners(drawing, new Map([[id, withPart(now, axis, metres)]]));
          },
          MOVE_CORNER,
        ),
    });
    return { key: id, at: this.board.view.toPx(corner.point), fields: [field(0), field(1)] };
  }

  /** @param {string} id @returns {Found} */
  ofEdge(id) {
    const { outline } = this.board.drawing;
    const index = outline.findIndex((corner) => corner.id === id);
    const next = outline[(index + 1) % outline.length];
    const [a, b] = [outline[index].point, next.point];
    /** @type {Field} */
    const field = {
      label: say("numbers.length"),
      name: say("numbers.edge_length"),
      value: number(distance(a, b)),
      put: (text) =>
        this.move(
          text,
          (metres, drawing) => moveCorners(drawing, new Map([[next.id, atLength(a, b, metres)]])),
          inEnglish("step.edge_length"),
          0.001,
        ),
    };
    return { key: id, at: this.board.view.toPx(between(a, b)), fields: [field] };
  }

  /** @param {string} id @returns {Found} */
  ofFold(id) {
    const fold = this.board.fold(id);
    if (!fold) return null;
    const fields = [...this.ofEnd(fold, "start"), ...this.ofEnd(fold, "end")];
    return fields.length ? { key: id, at: this.board.view.toPx(fold.end.point), fields } : null;
  }

  /**
   * How far along its edge an end is; of an end at a corner or on a crease there is nothing to say.
   * @param {Fold} fold
   * @param {"start"|"end"} end
   * @returns {Field[]}
   */
  ofEnd(fold, end) {
    const { on } = fold[end];
    if (on?.kind !== "edge") return [];
    const { outline } = this.board.drawing;
    const from = outline.find((corner) => corner.id === on.from)?.point;
    const to = outline.find((corner) => corner.id === on.to)?.point;
    if (!from || !to) return [];
    const whole = distance(from, to);
    /** @type {Put} */
    const put = (metres, drawing) =>
      moveFold(drawing, fold.id, {
        [end]: { point: fold[end].point, on: { ...on, fraction: Math.min(metres / whole, 1) } },
      });
    return [
      {
        label: say(`numbers.${end}`),
        name: say(`numbers.${end}_along`),
        value: number(on.fraction * whole),
        put: (text) => this.move(text, put, inEnglish("step.move_fold"), 0),
      },
    ];
  }

  /** @returns {Found} */
  ofPlacement() {
    const { drawing, view } = this.board;
    if (!drawing.outline.length) return null;
    const middle = middleOf(drawing);
    const { placement } = drawing;
    const centre = toOuter(placement, middle);
    /** @param {0|1} axis @returns {Field} */
    const place = (axis) => ({
      label: [say("numbers.ahead"), say("numbers.left")][axis],
      name: [say("numbers.ahead_of_middle"), say("numbers.left_of_middle")][axis],
      value: number(centre[axis]),
      put: (text) =>
        this.move(
          text,
          (metres, changed) => {
            changed.placement = laid(withPart(centre, axis, metres), middle, placement.yaw_rad);
          },
          inEnglish("step.place_garment"),
        ),
    });
    /** @type {Field} */
    const turn = {
      label: say("numbers.turn"),
      name: say("numbers.turn_name"),
      value: numeral(placement.yaw_rad / DEGREE, 1, 0),
      put: (text) => {
        const degrees = evaluated(text.replace("\u00B0", "").trim().replaceAll(",", "."));
        if (degrees === null) return say("numbers.no_degrees", { text });
        this.board.store.edit(
          inEnglish("step.turn_garment"),
          (changed) => void (changed.placement = laid(centre, middle, degrees * DEGREE)),
        );
        return "";
      },
    };
    return { key: "place", at: [view.width, 0], fields: [place(0), place(1), turn] };
  }

  /**
   * Make a change of a length that was written, or tell what is wrong with it.
   * @param {string} text
   * @param {Put} change
   * @param {string} label the name of the step
   * @param {number} [least] (m)
   * @returns {string}
   */
  move(text, change, label, least = undefined) {
    const problem = problemOf(text, least);
    const metres = parsed(text);
    if (!problem && metres !== null) this.board.store.edit(label, (drawing) => change(metres, drawing));
    return problem;
  }
}

/**
 * A point with one of its coordinates replaced.
 * @param {Point} point
 * @param {0|1} axis
 * @param {number} value
 * @returns {Point}
 */
const withPart = ([x, y], axis, value) => (axis === 0 ? [value, y] : [x, value]);
