/** The tool `Measure`: a tape between any two points. It stays until the next one or Esc. */

import { say } from "../../language/say.js";
import { distance, minus } from "../geometry.js";
import { path } from "../sheet.js";
import { length } from "../units.js";
import { Tool } from "./tool.js";

/** @import { Point } from "pleat" */
/** @import { Pointer } from "../pointer.js" */
/** @import { Items } from "../sheet.js" */

export class MeasureTool extends Tool {
  /** @param {import("../board.js").Board} board */
  constructor(board) {
    super(board, "measure", "crosshair");
    /** @type {Point[]} */
    this.points = [];
    this.isArmed = false;
  }

  get hint() {
    return say("hint.measure");
  }

  /** @param {Pointer} pointer */
  at(pointer) {
    const { board } = this;
    const from = this.points[0] ?? null;
    return board.snapTo(pointer, { rings: board.rings, points: board.foldEnds, from, guides: from ? [from] : [] }).at;
  }

  /** @param {Pointer} pointer */
  hover(pointer) {
    const at = this.at(pointer);
    if (this.isArmed) this.points[1] = at;
  }

  /** @param {Pointer} pointer */
  press(pointer) {
    const at = this.at(pointer);
    if (!this.isArmed) this.points = [at, at];
  }

  /** @param {Pointer} pointer */
  drag(pointer) {
    if (this.points.length) this.points[1] = this.at(pointer);
  }

  /** @param {Pointer} pointer @param {boolean} hasMoved */
  release(pointer, hasMoved) {
    if (!this.points.length) return;
    this.points[1] = this.at(pointer);
    this.isArmed = !hasMoved && !this.isArmed;
  }

  leave() {
    this.board.snapped = null;
  }

  cancel() {
    const wasBusy = this.points.length > 0;
    this.points = [];
    this.isArmed = false;
    return wasBusy;
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    if (event.key !== "Enter" || !this.board.isByKeyboard) return false;
    const pointer = this.board.keyboardPointer(event);
    if (!this.isArmed) this.press(pointer);
    this.release(pointer, false);
    return true;
  }

  /** @returns {Items} */
  items() {
    const [from, to] = this.points;
    if (!to) return [];
    const { view } = this.board;
    const [a, b] = [view.toPx(from), view.toPx(to)];
    const [across, up] = minus(to, from);
    const text = say("tape.measured", {
      length: length(distance(from, to)),
      across: length(Math.abs(across)),
      up: length(Math.abs(up)),
    });
    const isLow = Math.max(a[1], b[1]) > view.height - 40;
    return [
      { key: "under", tag: "path", class: "tape-under", d: path([a, b], false) },
      { key: "tape", tag: "path", class: "tape", d: path([a, b], false) },
      ...[a, b].map(([cx, cy], n) => ({ key: `t${n}`, tag: "circle", class: "tape-end", cx, cy, r: 3.5 })),
      {
        key: "text",
        tag: "text",
        class: "length is-tape",
        x: (a[0] + b[0]) / 2,
        y: isLow ? Math.min(a[1], b[1]) - 12 : Math.max(a[1], b[1]) + 22,
        "text-anchor": "middle",
        text,
      },
    ];
  }
}
