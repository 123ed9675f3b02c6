/** The tool `Photo`: a picture under the board, moved by dragging, scaled by two points whose distance is known. */

import { say } from "../../language/say.js";
import { distance, minus, plus, times } from "../geometry.js";
import { path } from "../sheet.js";
import { Tool } from "./tool.js";

/** @import { Point } from "pleat" */
/** @import { Pointer } from "../pointer.js" */
/** @import { Items } from "../sheet.js" */

export class PhotoTool extends Tool {
  /** @param {import("../board.js").Board} board */
  constructor(board) {
    super(board, "photo", "default");
    /** Two points of the picture whose distance is asked for. @type {Point[]} */
    this.points = [];
    /** @type {{from: Point, at: Point}|null} where it was pressed, and where the photo was then */
    this.held = null;
    /** @type {Point|null} where the second point would be */
    this.next = null;
    /** @type {number|null} the distance that was typed (m) */
    this.typed = null;
  }

  reset() {
    this.points = [];
    this.held = null;
  }

  get hint() {
    if (!this.board.photo.shown) return say("hint.photo_choose");
    return this.points.length === 1 ? say("hint.photo_second") : say("hint.photo_scale");
  }

  enter() {
    this.reset();
    if (!this.board.photo.shown) this.board.photo.choose();
  }

  get isBusy() {
    return this.points.length === 2;
  }

  /** The photo lies on the board alone. */
  takes() {
    return false;
  }

  /** @param {Pointer} pointer */
  hover(pointer) {
    this.cursor = this.board.photo.shown ? "crosshair" : "default";
    this.board.hover = null;
    if (this.points.length === 1) this.next = pointer.at;
  }

  /** @param {Pointer} pointer */
  press(pointer) {
    const { shown } = this.board.photo;
    this.held = shown ? { from: pointer.at, at: /** @type {Point} */ ([shown.x, shown.y]) } : null;
    if (!shown) this.board.photo.choose();
  }

  /** @param {Pointer} pointer */
  drag(pointer) {
    if (!this.held) return;
    const [x, y] = plus(this.held.at, minus(pointer.at, this.held.from));
    this.board.photo.change({ x, y });
  }

  /** @param {Pointer} pointer @param {boolean} hasMoved */
  release(pointer, hasMoved) {
    if (!this.held || hasMoved) {
      this.held = null;
      return;
    }
    this.held = null;
    this.points = this.points.length === 2 ? [pointer.at] : [...this.points, pointer.at];
    if (this.points.length === 2) this.board.openTyped("");
  }

  /** The distance of the two points, as it really is. @param {number|null} metres */
  type(metres) {
    this.typed = metres;
  }

  /** Scale about the first point. */
  finish() {
    const [from, to] = this.points;
    const { shown } = this.board.photo;
    if (shown && to && this.typed) {
      const factor = this.typed / distance(from, to);
      const [x, y] = plus(from, times(minus([shown.x, shown.y], from), factor));
      this.board.photo.change({ x, y, scale: shown.scale * factor });
    }
    this.board.closeTyped();
    this.reset();
  }

  /** @returns {[Point, Point]|null} */
  get stretch() {
    const [from, to] = this.points;
    return to ? [from, to] : null;
  }

  leave() {
    this.next = null;
  }

  cancel() {
    const wasBusy = this.points.length > 0;
    this.reset();
    return wasBusy;
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    if (event.key !== "Delete" && event.key !== "Backspace") return false;
    this.board.photo.remove();
    this.reset();
    return true;
  }

  /** @returns {Items} */
  items() {
    const { view } = this.board;
    const all = this.points.length === 1 && this.next ? [...this.points, this.next] : this.points;
    const points = all.map((point) => view.toPx(point));
    return [
      points.length > 1 && { key: "tape", tag: "path", class: "tape", d: path(points, false) },
      ...points.map(([cx, cy], n) => ({ key: `t${n}`, tag: "circle", class: "tape-end", cx, cy, r: 3.5 })),
    ];
  }
}
