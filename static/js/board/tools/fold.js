/**
 * The tool `Draw fold`: from edge to edge of the cloth as it lies then, or a point of the cloth grabbed and dropped
 * where it shall land. The page shows what it thinks at once; the server's word takes its place.
 */

import { say } from "../../language/say.js";
import { CreaseQuestion } from "../crease.js";
import { insertFold } from "../edits.js";
import { freshId } from "../ids.js";
import { DRAW_FOLD } from "../rules.js";
import { atLength } from "../snap.js";
import { ghostOf, nameOf } from "../stroke.js";
import { beginsOnEdge, isBeside, isGrabbed, isShort, isToGrab, laidFrom, lineAlong, strokeItems, whyNoCloth } from "./fold_stroke.js";
import { Tool } from "./tool.js";

/** @import { Change } from "../../edit_queue.js" */
/** @import { Pointer } from "../pointer.js" */
/** @import { Items } from "../sheet.js" */
/** @import { Stroke } from "./fold_stroke.js" */
/** @import { Crease, Point } from "pleat" */

const BESIDE = say("hint.stroke_misses");

/**
 * How far the fold is drawn:
 * - idle: nothing is begun;
 * - pulling: its first end is pressed, and the pointer still down;
 * - leading: its first end was clicked, and the second follows the pointer until the next click.
 * A press leads from "idle" to "pulling", a release in place from there to "leading"; a release elsewhere, or the next
 * one, ends the stroke. `isRefused` says that no fold comes of the stroke as it was asked about last.
 * @typedef {{name: "idle"} | {name: "pulling"|"leading", stroke: Stroke, isRefused: boolean}} State
 */

/** @type {State} */
const IDLE = { name: "idle" };

export class FoldTool extends Tool {
  /** @param {import("../board.js").Board} board */
  constructor(board) {
    super(board, "fold", "crosshair");
    this.question = new CreaseQuestion(board);
    /** @type {State} */
    this.state = IDLE;
    /** @type {number|null} a length that was typed (m) */
    this.typed = null;
    this.maker = new FoldMaker(board, this.question, {
      named: (id) => (this.last = id),
      after: (isFault) => this.rest(isFault),
    });
  }

  /** The stroke that is being drawn. */
  get stroke() {
    return this.state.name === "idle" ? null : this.state.stroke;
  }

  get isRefused() {
    return this.state.name !== "idle" && this.state.isRefused;
  }

  get hint() {
    if (this.stroke) return this.stroke.isGrab ? say("hint.drop") : say("hint.to_edge");
    return this.board.paint.grabs ? say("hint.grab") : say("hint.fold");
  }

  get isBusy() {
    return this.state.name !== "idle";
  }

  /** Begin nothing, or end what is begun without a fold. */
  drop() {
    this.state = IDLE;
    this.question.forget();
    this.board.ghost = null;
  }

  enter() {
    const { board } = this;
    board.store.select(null);
    board.store.showStep(board.store.moments - 1);
    this.last = "";
    const { stroke } = this;
    if (stroke && (stroke.step !== board.step || stroke.version !== board.state?.version)) this.drop();
  }

  /** @param {Pointer} pointer */
  hover(pointer) {
    this.board.hover = null;
    const { isGrab = false, from = null, laid = [] } = this.stroke ?? {};
    const { rings } = this.board;
    const snapped = this.board.snapTo(pointer, { rings, points: [], onlyCloth: !isGrab, from, laid });
    if (this.stroke) this.lead(snapped.at);
    const canGrab = !this.stroke && isGrabbed(this.board, snapped, pointer);
    this.cursor = this.isRefused ? "not-allowed" : canGrab ? "grab" : "crosshair";
    return snapped;
  }

  /** @param {Pointer} pointer */
  press(pointer) {
    const snapped = this.hover(pointer);
    const { board } = this;
    if (this.state.name !== "idle" || !board.state) return;
    if (!board.rings.length) {
      board.store.refuse(whyNoCloth(board));
      return;
    }
    const isGrab = isGrabbed(board, snapped, pointer);
    const isEarly = this.maker.unmade > 0 && !isToGrab(board, pointer);
    const { isTouch } = pointer;
    const laid = laidFrom(board, snapped, { isGrab, isTouch });
    const { step, state } = board;
    const { version } = state;
    const stroke = { isGrab, isEarly, isTouch, from: snapped.at, to: snapped.at, laid, step, version };
    this.state = { name: "pulling", stroke, isRefused: false };
  }

  /** @param {Pointer} pointer */
  drag(pointer) {
    this.hover(pointer);
  }

  /** @param {Pointer} pointer @param {boolean} hasMoved */
  release(pointer, hasMoved) {
    if (this.state.name === "idle") return;
    this.hover(pointer);
    if (hasMoved || this.state.name === "leading") this.finish();
    else this.state.name = "leading";
  }

  /** @param {Point} at */
  lead(at) {
    const { stroke } = this;
    if (!stroke) return;
    stroke.to = this.typed !== null ? atLength(stroke.from, at, this.typed) : at;
    this.ask();
  }

  ask() {
    const { stroke, board } = this;
    if (!stroke || isShort(stroke)) return;
    if (isBeside(stroke, board)) {
      this.question.forget();
      this.refuse(BESIDE);
      return;
    }
    if (!this.isRefused) board.ghost = ghostOf(lineAlong(stroke, board), board.rings);
    if (board.store.queue.isBusy) return; // the cloth that the server knows is not yet the one that is seen
    this.question.ask(stroke, (answer) => {
      if (!answer.ok) {
        this.refuse(answer.told.detail);
        return;
      }
      if (this.state.name !== "idle") {
        board.ghost = answer.told;
        this.state.isRefused = false;
      }
      this.cursor = "crosshair";
      board.say("");
      board.render();
    });
  }

  /** No fold comes of the stroke as it is now: nothing is shown but why. @param {string} why */
  refuse(why) {
    if (this.state.name !== "idle") this.state.isRefused = true;
    this.cursor = "not-allowed";
    this.board.ghost = null;
    this.board.say(why);
    this.board.render();
  }

  /** The stroke is done; a next one may begin before the server has answered. */
  finish() {
    const { stroke, board } = this;
    if (!stroke) return;
    board.closeTyped();
    board.snapped = null;
    const misses = isBeside(stroke, board);
    if (misses || isShort(stroke)) {
      this.cancel();
      if (misses) board.store.refuse(BESIDE);
      return;
    }
    this.state = IDLE;
    this.question.forget();
    this.maker.make(stroke);
  }

  /** A stroke is a fold, or none: unless a next one is going on, nothing is said of it any more. @param {boolean} isFault */
  rest(isFault) {
    if (this.state.name !== "idle") return;
    if (!isFault) this.board.say("");
    this.drop();
  }

  cancel() {
    const wasBusy = this.isBusy;
    this.drop();
    this.board.snapped = null;
    this.board.say("");
    return wasBusy;
  }

  /** A stroke whose first end was clicked goes on when the tool is chosen again. */
  interrupt() {
    if (this.state.name !== "leading") this.cancel();
    this.question.forget();
    this.board.ghost = null;
    this.board.say("");
  }

  get lastPart() {
    return this.isBusy ? say("part.first_end") : "";
  }

  leave() {
    this.board.snapped = null;
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    if (event.key !== "Enter" || !this.board.isByKeyboard) return false;
    const pointer = this.board.keyboardPointer(event);
    if (this.state.name === "idle") this.press(pointer);
    this.release(pointer, false);
    return true;
  }

  /** @param {number|null} metres */
  type(metres) {
    this.typed = metres;
    if (this.stroke && metres !== null) this.lead(this.stroke.to);
  }

  /** @returns {[Point, Point]|null} */
  get stretch() {
    const { stroke } = this;
    return stroke && !stroke.isGrab && !isShort(stroke) ? [stroke.from, stroke.to] : null;
  }

  /** @returns {Items} */
  items() {
    return this.stroke ? strokeItems(this.stroke, this.board) : [];
  }
}

/** Makes folds of strokes, one after the other: a next one may be drawn before the server has answered. */
class FoldMaker {
  /**
   * @param {import("../board.js").Board} board
   * @param {import("../crease.js").CreaseQuestion} question
   * @param {{named: (id: string) => void, after: (isFault: boolean) => void}} tell what a fold is called before it is
   *   made; that a stroke is a fold, or none
   */
  constructor(board, question, tell) {
    this.board = board;
    this.question = question;
    this.tell = tell;
    /** Settled when all strokes so far are folds. */
    this.finished = Promise.resolve();
    /** How many strokes are done and not yet folds. */
    this.unmade = 0;
  }

  /** @param {Stroke} stroke */
  make(stroke) {
    this.unmade += 1;
    this.finished = this.finished.then(() => this.complete(stroke)).catch((error) => this.fail(error));
  }

  /** A stroke was lost to a fault of the page; the next ones are none the worse. @param {unknown} error */
  fail(error) {
    this.unmade -= 1;
    this.tell.after(true);
    this.board.store.refuse(say("hint.fold_failed"));
    console.error(error);
  }

  /** Add the fold to those that are there by then. @param {Stroke} stroke */
  async complete(stroke) {
    const { board } = this;
    await board.store.settled();
    if (stroke.isEarly && stroke.isGrab) stroke.isGrab = !beginsOnEdge(stroke, board); // it was quicker than the server
    const answer = await this.question.answer(stroke);
    if (answer.ok) await this.add(answer.told);
    else board.store.refuse(answer.told.detail);
    this.unmade -= 1;
    this.tell.after(false);
    board.render();
  }

  /** @param {Crease} crease */
  async add({ start, end }) {
    const { board } = this;
    const index = board.step;
    const id = freshId("f", board.drawing.folds);
    const name = nameOf(start.point, end.point, board.drawing.folds);
    const fold = { id, name, kind: board.paint.kind, start, end };
    this.tell.named(id);
    board.paint.turnOver(false);
    /** @type {Change} */
    const insert = (drawing) => insertFold(drawing, Math.min(index, drawing.folds.length), fold);
    const state = await board.store.edit(DRAW_FOLD, insert);
    if (state) board.store.showStep(index + 1);
  }
}
