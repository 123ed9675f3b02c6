/** The tool `Fold it for me`: a rectangle on the garment, the size that it is to be folded to, with handles to pull. */

import { say } from "../../language/say.js";
import { asked, extentOf, isLike, isWithin, sidesOf, SIDES_M } from "../../proposals/target.js";
import { lengthLabel } from "../draw_handles.js";
import { middleOf } from "../edits.js";
import { distance, minus, plus } from "../geometry.js";
import { FINGER_PX, HANDLE_PX } from "../rules.js";
import { path } from "../sheet.js";
import { Tool } from "./tool.js";

/** @import { Target } from "../../proposals/target.js" */
/** @import { Point } from "pleat" */
/** @import { Pointer } from "../pointer.js" */
/** @import { Items } from "../sheet.js" */

/** Handles by the sides that they change, each where it is from the middle (half sides). @type {Point[]} */
const HANDLES = [
  [1, 1],
  [1, 0],
  [0, 1],
];
/** @type {Point[]} */
const CORNERS = [
  [-1, -1],
  [1, -1],
  [1, 1],
  [-1, 1],
];
const CURSORS = ["nesw-resize", "ew-resize", "ns-resize"];
const KNOB_PX = 5;
/** What a size is pulled to, unless Ctrl is held (m). */
const ROUND_M = 0.005;
const STEP_M = 0.01;
/** @type {Record<string, Point>} */
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

export class ProposeTool extends Tool {
  /** @param {import("../board.js").Board} board */
  constructor(board) {
    super(board, "propose", "default");
    /** @type {Target} the size that is wanted */
    this.to = "shelf";
    /** @type {{handle: number, before: Target}|null} the handle that is pulled */
    this.pulled = null;
    /** @type {Point|null} where the paper is held that is moved (px) */
    this.paper = null;
  }

  get hint() {
    return say("hint.propose");
  }

  /** The sides that are wanted (m); null for the smallest, and for those of another garment. */
  get sides() {
    return sidesOf(this.to, this.board.drawing);
  }

  /** The size as a request names it. */
  get asked() {
    return asked(this.to);
  }

  /** @param {Target} to */
  set(to) {
    this.to = typeof to === "string" || isLike(to) ? to : [withinSides(to[0]), withinSides(to[1])];
    this.board.render();
  }

  /** What is no larger than the size as it lies is to be folded in half. */
  enter() {
    const { board, sides } = this;
    if (sides && isWithin(extentOf(board.drawing), sides)) this.to = "halves";
    board.store.select(null);
    board.store.showStep(0);
  }

  get isBusy() {
    return this.pulled !== null;
  }

  /** @param {Pointer} pointer */
  takes(pointer) {
    return this.handleAt(pointer) >= 0;
  }

  /** @param {Pointer} pointer */
  hover(pointer) {
    this.cursor = CURSORS[this.handleAt(pointer)] ?? "default";
  }

  /** @param {Pointer} pointer */
  press(pointer) {
    const handle = this.handleAt(pointer);
    this.pulled = handle < 0 ? null : { handle, before: this.to };
    this.paper = handle < 0 ? pointer.px : null;
  }

  /** @param {Pointer} pointer */
  drag(pointer) {
    const { sides, pulled } = this;
    if (this.paper) {
      this.board.view.pan(minus(pointer.px, this.paper));
      this.paper = pointer.px;
    } else if (pulled && sides) {
      const half = minus(pointer.at, middleOf(this.board.drawing));
      const round = pointer.ctrl ? 0.001 : ROUND_M;
      /** @param {0|1} axis */
      const side = (axis) =>
        HANDLES[pulled.handle][axis] ? Math.round((2 * Math.max(half[axis], 0)) / round) * round : sides[axis];
      this.set([side(0), side(1)]);
    }
  }

  release() {
    this.pulled = this.paper = null;
  }

  cancel() {
    const { pulled } = this;
    this.release();
    if (pulled) this.set(pulled.before);
    return pulled !== null;
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    const way = ARROWS[event.key];
    const { sides } = this;
    if (!way || !sides) return false;
    this.set([sides[0] + way[0] * STEP_M, sides[1] + way[1] * STEP_M]);
    return true;
  }

  /** The handle that is there; -1 for none. @param {Pointer} pointer */
  handleAt({ px, isTouch }) {
    const reach = isTouch ? FINGER_PX : HANDLE_PX;
    return this.handles().findIndex((at) => distance(at, px) <= reach);
  }

  /** Where the handles are (px). */
  handles() {
    return HANDLES.flatMap((way) => this.corner(way) ?? []);
  }

  /** A point of the rectangle (px). @param {Point} way from its middle (half sides) @returns {Point[]} none without one */
  corner([x, y]) {
    const { board, sides } = this;
    return sides ? [board.view.toPx(plus(middleOf(board.drawing), [(x * sides[0]) / 2, (y * sides[1]) / 2]))] : [];
  }

  /** @returns {Items} */
  items() {
    const { sides } = this;
    if (!sides || this.board.store.preview) return [];
    const ring = CORNERS.flatMap((way) => this.corner(way));
    return [
      { key: "target", tag: "path", class: "target", d: path(ring) },
      lengthLabel("wide", ring[1], ring[0], sides[0], false),
      lengthLabel("long", ring[0], ring[3], sides[1], false),
      ...this.handles().map(([cx, cy], n) => ({ key: `h${n}`, tag: "circle", class: "handle", cx, cy, r: KNOB_PX })),
    ];
  }
}

/** @param {number} side (m) */
const withinSides = (side) => Math.min(Math.max(side, SIDES_M[0]), SIDES_M[1]);
