/**
 * The tool `Draw outline`: point after point, closed at the first; takes the place of the outline before. An outline that
 * is not closed stays when another tool is chosen, and goes on when this one is chosen again.
 */

import { say, translated } from "../../language/say.js";
import { replaceOutline } from "../outline_edits.js";
import { distance } from "../geometry.js";
import { lengthLabel } from "../draw_handles.js";
import { CORNER_TAKEN, DRAW_OUTLINE, LEAST_CORNERS, TOO_FEW_CORNERS, TOO_MANY_CORNERS } from "../rules.js";
import { path } from "../sheet.js";
import { atLength } from "../snap.js";
import { nextCorner } from "../stroke.js";
import { Tool } from "./tool.js";

/** @import { Point } from "pleat" */
/** @import { Pointer } from "../pointer.js" */
/** @import { Items } from "../sheet.js" */

/** Why no corner is put there. */
const REFUSALS = { taken: translated(CORNER_TAKEN), full: translated(TOO_MANY_CORNERS) };

export class OutlineTool extends Tool {
  /** @param {import("../board.js").Board} board */
  constructor(board) {
    super(board, "outline", "crosshair");
    /** @type {Point[]} */
    this.points = [];
    /** Where the next point would be. @type {Point|null} */
    this.next = null;
    this.isAtEdge = false;
    /** Whether the pointer has left the board: a typed length still goes towards where it was last. */
    this.isAway = false;
    /** A length that was typed (m). @type {number|null} */
    this.typed = null;
    board.store.addEventListener("opened", () => this.cancel());
  }

  get hint() {
    if (!this.points.length) return say("hint.outline_first");
    return this.points.length < LEAST_CORNERS ? say("hint.outline_next") : say("hint.outline_close");
  }

  get isBusy() {
    return this.points.length > 0;
  }

  enter() {
    this.board.store.select(null);
    this.board.store.showStep(0);
  }

  /** The board widens as a line is led to its edge: below a mouse the cloth moves on. @param {Pointer} pointer */
  roomFor(pointer) {
    const { view, framing } = this.board;
    const wasAtEdge = this.isAtEdge;
    this.isAtEdge = framing.isAtEdge(pointer.px);
    if (!this.isAtEdge || wasAtEdge || !this.isBusy || pointer.isTouch) return pointer;
    framing.widen();
    return pointer.isKeyboard ? pointer : { ...pointer, at: view.toM(pointer.px) };
  }

  /** @param {Pointer} pointer */
  hover(pointer) {
    this.isAway = false;
    const last = this.points.at(-1) ?? null;
    const close = this.points.length >= LEAST_CORNERS ? this.points[0] : null;
    this.board.hover = null;
    const { at } = this.board.snapTo(this.roomFor(pointer), {
      rings: [],
      points: [],
      close,
      from: last,
      guides: this.points,
    });
    this.next = last && this.typed !== null ? atLength(last, at, this.typed) : at;
  }

  /** @param {Pointer} pointer */
  press(pointer) {
    this.hover(pointer);
  }

  /** @param {Pointer} pointer */
  drag(pointer) {
    this.hover(pointer);
  }

  /** @param {Pointer} pointer */
  release(pointer) {
    this.hover(pointer);
    this.put();
    if (pointer.isTouch) this.leave();
  }

  leave() {
    this.isAway = true;
    this.board.snapped = null;
  }

  interrupt() {
    this.leave();
  }

  /** The next point becomes a corner; the first one again closes the outline. */
  put() {
    const { next, points } = this;
    this.board.closeTyped();
    if (!next) return;
    const becomes = nextCorner(points, next);
    if (becomes === "close") this.close();
    else if (becomes === "put") {
      points.push(next);
      this.board.framing.reveal(points);
    } else this.board.store.refuse(REFUSALS[becomes]);
  }

  async close() {
    const { points } = this;
    if (points.length < LEAST_CORNERS) {
      this.board.store.refuse(translated(TOO_FEW_CORNERS));
      return;
    }
    this.points = [];
    this.next = null;
    this.board.choose("select");
    this.board.showDraft((drawing) => replaceOutline(drawing, points));
    const { framing } = this.board;
    framing.fit();
    const seen = framing.where();
    this.board.draw();
    await this.board.store.edit(DRAW_OUTLINE, (drawing) => replaceOutline(drawing, points));
    this.board.dropDraft();
    if (framing.where() === seen) framing.fit(); // to the outline as the server has it
  }

  cancel() {
    const wasBusy = this.isBusy;
    this.points = [];
    this.next = null;
    this.board.snapped = null;
    return wasBusy;
  }

  get lastPart() {
    return this.isBusy ? say("part.corner", { number: this.points.length }) : "";
  }

  takeBack() {
    this.points.pop();
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    if (event.key === "Backspace" && this.isBusy) {
      this.takeBack();
      return true;
    }
    if (event.key !== "Enter") return false;
    if (!this.isBusy) this.board.keyboard.begin(event);
    if (this.board.isByKeyboard) this.put();
    else if (this.isBusy) this.close();
    return true;
  }

  finish() {
    this.put();
  }

  /** @param {number|null} metres */
  type(metres) {
    const last = this.points.at(-1);
    this.typed = metres;
    if (last && this.next && metres !== null) this.next = atLength(last, this.next, metres);
  }

  /** The way to where it would go on, for a length to be typed. @returns {[Point, Point]|null} */
  get stretch() {
    const last = this.points.at(-1);
    return last && this.next ? [last, this.next] : null;
  }

  /** @returns {Items} */
  items() {
    const { view } = this.board;
    const points = this.points.map((point) => view.toPx(point));
    const isLed = this.typed !== null || (!this.isAway && this.board.tool === this);
    const next = isLed && this.next ? view.toPx(this.next) : null;
    const last = points.at(-1);
    const stretch = next && this.stretch;
    return [
      points.length > 1 && {
        key: "fill",
        tag: "path",
        class: "sketch-fill",
        d: path(next ? [...points, next] : points),
      },
      points.length > 0 && { key: "sketch", tag: "path", class: "sketch", d: path(points, false) },
      last && next && { key: "rubber", tag: "path", class: "sketch is-rubber", d: path([last, next], false) },
      ...points.map(([cx, cy], n) => ({
        key: `p${n}`,
        tag: "circle",
        class: `handle corner${n === 0 ? " is-first" : ""}`,
        cx,
        cy,
        r: n === 0 && points.length >= LEAST_CORNERS ? 6 : 4,
      })),
      next && { key: "next", tag: "circle", class: "next-point", cx: next[0], cy: next[1], r: 3 },
      stretch && last && lengthLabel("length", last, next, distance(stretch[0], stretch[1])),
    ];
  }
}
