/**
 * Mouse, pen and fingers on the board. One pointer is the tool's; space or the middle button pans, the wheel zooms at
 * the cursor, two fingers pan and zoom and drop what the first had begun.
 */

import { isBoards } from "../keys.js";
import { isViewOnly } from "../view_only.js";
import { between, distance, minus } from "./geometry.js";

/** @import { Point } from "pleat" */

const DRAG_PX = 4;
const TOUCH_DRAG_PX = 6;
const ZOOM_PER_PX = 0.0016;
const LINE_PX = 16;
/** A pinch on a touch pad comes as a wheel with Ctrl, in small steps. */
const PINCH = 5;

/**
 * @typedef {object} Pointer
 * @property {Point} px from the board's top left
 * @property {Point} at garment frame (m)
 * @property {boolean} isTouch
 * @property {boolean} isKeyboard
 * @property {boolean} ctrl
 * @property {boolean} shift
 * @property {boolean} alt
 */

export class PointerInput {
  /** @param {import("./board.js").Board} board */
  constructor(board) {
    this.board = board;
    /** @type {Map<number, Point>} fingers on the board */
    this.fingers = new Map();
    /** @type {{id: number, px: Point, hasMoved: boolean}|null} */
    this.pressed = null;
    /** @type {{id: number, px: Point}|null} */
    this.panning = null;
    /** Where a pointer was last. @type {Point|null} */
    this.last = null;
    this.isSpaceDown = false;
    /** Whether the board was moved since the space bar was pressed. */
    this.hasPanned = false;
    this.isOver = false;
    const { svg } = board;
    svg.addEventListener("pointerdown", (event) => this.down(event));
    svg.addEventListener("pointermove", (event) => this.move(event));
    svg.addEventListener("pointerup", (event) => this.up(event));
    svg.addEventListener("pointercancel", (event) => this.cancel(event));
    svg.addEventListener("pointerenter", () => (this.isOver = true));
    svg.addEventListener("pointerleave", () => this.leave());
    svg.addEventListener("dblclick", (event) => isViewOnly || board.tool.twice(this.pointer(event)));
    svg.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
    svg.addEventListener("contextmenu", (event) => isTouch(event) && event.preventDefault());
    window.addEventListener("keydown", (event) => this.space(event, true), true);
    window.addEventListener("keyup", (event) => this.space(event, false), true);
  }

  /** @param {MouseEvent} event @returns {Pointer} */
  pointer(event) {
    const px = (this.last = this.place(event));
    const { ctrlKey, metaKey, shiftKey: shift, altKey: alt } = event;
    const at = this.board.view.toM(px);
    return { px, at, isTouch: isTouch(event), isKeyboard: false, ctrl: ctrlKey || metaKey, shift, alt };
  }

  /** @param {MouseEvent} event @returns {Point} */
  place(event) {
    const box = this.board.svg.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  /** @param {PointerEvent} event */
  down(event) {
    this.board.svg.classList.add("is-pointed"); // no ring round the board for those who point
    this.board.svg.focus({ preventScroll: true });
    event.preventDefault();
    if (event.pointerType === "touch") this.fingers.set(event.pointerId, this.place(event));
    if (this.fingers.size > 1) {
      this.drop();
      return;
    }
    this.board.svg.setPointerCapture(event.pointerId);
    const isLooking = this.isSpaceDown || this.board.store.isLost || isViewOnly; // nothing is changed then
    if (event.button === 1 || (event.button === 0 && isLooking)) {
      this.panning = { id: event.pointerId, px: this.place(event) };
      this.hasPanned = true;
      this.board.svg.classList.add("is-panning");
      return;
    }
    if (event.button !== 0 || this.pressed) return;
    this.pressed = { id: event.pointerId, px: this.place(event), hasMoved: false };
    this.board.useKeyboard(false);
    this.board.tool.press(this.pointer(event));
    this.board.loupe.show(event.pointerType === "touch" ? this.pointer(event) : null);
    this.board.render();
  }

  /** @param {PointerEvent} event */
  move(event) {
    if (this.fingers.has(event.pointerId) && this.fingers.size === 2) {
      this.pinch(event);
      return;
    }
    if (this.fingers.has(event.pointerId)) this.fingers.set(event.pointerId, this.place(event));
    if (this.panning?.id === event.pointerId) {
      const px = this.place(event);
      this.board.view.pan(minus(px, this.panning.px));
      this.panning.px = px;
    } else if (this.pressed?.id === event.pointerId) {
      this.drag(event);
    } else if (!this.pressed && event.pointerType !== "touch") {
      this.board.useKeyboard(false);
      if (!isViewOnly) this.board.tool.hover(this.pointer(event));
    }
    this.board.render();
  }

  /** @param {PointerEvent} event */
  drag(event) {
    const { pressed } = this;
    if (!pressed) return;
    const pointer = this.pointer(event);
    const threshold = pointer.isTouch ? TOUCH_DRAG_PX : DRAG_PX;
    pressed.hasMoved ||= distance(pointer.px, pressed.px) >= threshold;
    this.board.loupe.show(pointer.isTouch ? pointer : null);
    if (pressed.hasMoved) this.board.tool.drag(pointer);
  }

  /** @param {PointerEvent} event */
  up(event) {
    this.fingers.delete(event.pointerId);
    if (this.panning?.id === event.pointerId) this.endPan();
    if (this.pressed?.id !== event.pointerId) return;
    const { hasMoved } = this.pressed;
    this.pressed = null;
    this.board.loupe.show(null);
    this.board.tool.release(this.pointer(event), hasMoved);
    this.board.render();
  }

  /** @param {PointerEvent} event */
  cancel(event) {
    this.fingers.delete(event.pointerId);
    if (this.panning?.id === event.pointerId) this.endPan();
    if (this.pressed?.id === event.pointerId) this.drop();
  }

  leave() {
    this.isOver = false;
    if (!this.pressed) this.board.tool.leave();
    this.board.render();
  }

  /** What the tool had begun with this pointer is not done. */
  drop() {
    if (this.pressed) this.board.tool.interrupt();
    this.pressed = null;
    this.board.loupe.show(null);
    this.board.render();
  }

  endPan() {
    this.panning = null;
    this.board.svg.classList.remove("is-panning");
  }

  /** @param {PointerEvent} event */
  pinch(event) {
    const [[, there]] = [...this.fingers].filter(([id]) => id !== event.pointerId);
    const now = this.place(event);
    const before = this.fingers.get(event.pointerId) ?? now;
    this.fingers.set(event.pointerId, now);
    const { view } = this.board;
    view.pan(minus(between(now, there), between(before, there)));
    view.zoomAt(between(now, there), Math.max(distance(now, there), 1) / Math.max(distance(before, there), 1));
    this.board.render();
  }

  /** @param {WheelEvent} event */
  wheel(event) {
    event.preventDefault();
    const px = (event.deltaMode === 1 ? LINE_PX : 1) * (event.ctrlKey ? PINCH : 1);
    if (event.shiftKey) this.board.view.pan([-(event.deltaY || event.deltaX) * px, 0]);
    else this.board.view.zoomAt(this.place(event), Math.exp(-event.deltaY * px * ZOOM_PER_PX));
    this.board.render();
  }

  /**
   * Over the board the space bar pans with the mouse, and plays if it was only pressed.
   * @param {KeyboardEvent} event
   * @param {boolean} isDown
   */
  space(event, isDown) {
    if (event.key !== " " || (isDown && (!this.isOver || !isBoards(event)))) return;
    if (isDown) {
      event.preventDefault();
      if (!event.repeat) this.hasPanned = false;
    } else if (this.isSpaceDown && !this.hasPanned) {
      this.board.togglePlay();
    }
    this.isSpaceDown = isDown;
    this.board.svg.classList.toggle("can-pan", isDown);
  }
}

/** @param {MouseEvent} event */
const isTouch = (event) => event instanceof PointerEvent && event.pointerType === "touch";
