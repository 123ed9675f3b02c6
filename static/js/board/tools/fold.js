/**
 * The tool `Draw fold`: from edge to edge of the cloth as it lies then, or a point of the cloth grabbed and dropped
 * where it shall land. The page shows what it thinks at once; the server's word takes its place.
 */

import { say, translated } from "../../language/say.js";
import { CreaseQuestion } from "../crease.js";
import { foldItems } from "../draw_folds.js";
import { lengthLabel } from "../draw_handles.js";
import { dropsOnto, edgeNear, endsOnto } from "../edge_onto_edge.js";
import { insertFold } from "../edits.js";
import { freshId } from "../ids.js";
import { distance, isInside, nearestOnRings } from "../geometry.js";
import { DRAW_FOLD, FIRST_IS_RED, NO_CLOTH, REACH_PX, STROKE_MIN_M } from "../rules.js";
import { atLength } from "../snap.js";
import { ghostOf, lineOf, nameOf, reachesCloth } from "../stroke.js";
import { Tool } from "./tool.js";

/** @import { Crease, Point } from "pleat" */
/** @import { Laid } from "../edge_onto_edge.js" */
/** @import { Pointer } from "../pointer.js" */
/** @import { Items } from "../sheet.js" */
/** @import { Snapped } from "../snap.js" */
/** @import { Change } from "../../edit_queue.js" */

/** Cloth that is grabbed so near to an edge is grabbed by that edge (px). */
const BY_EDGE_PX = 20;
/** Kinds of snaps that mean the point itself, not its edge. */
const POINTS = new Set(["vertex", "fraction"]);
const BESIDE = say("hint.stroke_misses");
const UNCLOSED = say("hint.outline_open");

/**
 * A stroke across the cloth.
 * @typedef {object} Stroke
 * @property {boolean} isGrab whether it takes cloth along; else it is the fold's line
 * @property {boolean} isEarly whether it began while folds before it were still being made
 * @property {boolean} isTouch
 * @property {Point} from
 * @property {Point} to
 * @property {Laid[]} laid where it would have to end to lay one edge on another
 * @property {number} step the moment of the folds at which it began
 * @property {number} version the document's at that time
 */
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
    /** Settled when all strokes so far are folds. */
    this.finished = Promise.resolve();
    /** How many strokes are done and not yet folds. */
    this.unmade = 0;
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
    const canGrab = !this.stroke && this.isGrab(snapped, pointer);
    this.cursor = this.isRefused ? "not-allowed" : canGrab ? "grab" : "crosshair";
    return snapped;
  }

  /** @param {Pointer} pointer */
  press(pointer) {
    const snapped = this.hover(pointer);
    const { board } = this;
    if (this.state.name !== "idle" || !board.state) return;
    if (!board.rings.length) {
      board.store.refuse(this.noCloth());
      return;
    }
    const isGrab = this.isGrab(snapped, pointer);
    const isEarly = this.unmade > 0 && !this.isToGrab(pointer);
    const { isTouch } = pointer;
    const laid = this.laid(isGrab, snapped, isTouch);
    const { step, state } = board;
    const { version } = state;
    const stroke = { isGrab, isEarly, isTouch, from: snapped.at, to: snapped.at, laid, step, version };
    this.state = { name: "pulling", stroke, isRefused: false };
  }

  /** Why there is nothing to draw a fold on. */
  noCloth() {
    const { paint, step, tools } = this.board;
    if (paint.kind === "red" && step === 0) return translated(FIRST_IS_RED);
    return tools.outline.isBusy ? UNCLOSED : translated(NO_CLOTH);
  }

  /**
   * Whether a stroke that begins there takes cloth along: inside it always, at its edges and corners when told to.
   * @param {Snapped} snapped
   * @param {Pointer} pointer
   */
  isGrab({ at, isOnCloth }, pointer) {
    return isOnCloth ? this.isToGrab(pointer) : isInside(at, this.board.rings);
  }

  /** @param {Pointer} pointer */
  isToGrab({ alt }) {
    return alt || this.board.paint.grabs;
  }

  /**
   * Where a stroke would have to end to lay one edge on another.
   * @param {boolean} isGrab
   * @param {Snapped} snapped
   * @param {boolean} isTouch
   * @returns {Laid[]}
   */
  laid(isGrab, { at, kind }, isTouch) {
    const { rings, view } = this.board;
    if (!isGrab) return endsOnto(at, rings);
    const reach_m = ((isTouch ? 2 : 1) * BY_EDGE_PX) / view.scale;
    const edge = kind !== undefined && POINTS.has(kind) ? null : edgeNear(at, rings, reach_m);
    return edge ? dropsOnto(at, edge, rings) : [];
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
    if (!stroke || distance(stroke.from, stroke.to) < STROKE_MIN_M) return;
    if (this.isBeside(stroke)) {
      this.question.forget();
      this.refuse(BESIDE);
      return;
    }
    if (!this.isRefused) board.ghost = ghostOf(this.line(stroke), board.rings);
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

  /** Whether a stroke is drawn beside the cloth. @param {Stroke} stroke */
  isBeside(stroke) {
    const { rings, view } = this.board;
    const near = ((stroke.isTouch ? 2 : 1) * REACH_PX.edge) / view.scale;
    return !stroke.isGrab && !reachesCloth(stroke, rings, near);
  }

  /** The fold's line; what lies to its left moves. @param {Stroke} stroke */
  line(stroke) {
    return lineOf(stroke, this.board.rings, this.board.paint.isFlipped);
  }

  /** The stroke is done; a next one may begin before the server has answered. */
  finish() {
    const { stroke, board } = this;
    if (!stroke) return;
    board.closeTyped();
    board.snapped = null;
    const isBeside = this.isBeside(stroke);
    if (isBeside || distance(stroke.from, stroke.to) < STROKE_MIN_M) {
      this.cancel();
      if (isBeside) board.store.refuse(BESIDE);
      return;
    }
    this.state = IDLE;
    this.question.forget();
    this.unmade += 1;
    this.finished = this.finished.then(() => this.complete(stroke)).catch((error) => this.fail(error));
  }

  /** A stroke was lost to a fault of the page; the next ones are none the worse. @param {unknown} error */
  fail(error) {
    this.unmade -= 1;
    if (this.state.name === "idle") this.drop();
    this.board.store.refuse(say("hint.fold_failed"));
    console.error(error);
  }

  /** Add the fold to those that are there by then. @param {Stroke} stroke */
  async complete(stroke) {
    const { board } = this;
    await board.store.settled();
    if (stroke.isEarly && stroke.isGrab) stroke.isGrab = !this.isOnEdge(stroke);
    const answer = await this.question.answer(stroke);
    if (answer.ok) await this.add(answer.told);
    else board.store.refuse(answer.told.detail);
    this.unmade -= 1;
    if (this.state.name === "idle") {
      board.say("");
      this.drop();
    }
    board.render();
  }

  /**
   * Whether a stroke that was quicker than the server begins at an edge of the cloth as it has become.
   * @param {Stroke} stroke
   */
  isOnEdge({ from, isTouch }) {
    const { rings, view } = this.board;
    const near = nearestOnRings(from, rings);
    return near !== null && distance(near, from) * view.scale <= (isTouch ? 2 : 1) * REACH_PX.edge;
  }

  /** @param {Crease} crease */
  async add({ start, end }) {
    const { board } = this;
    const index = board.step;
    const id = freshId("f", board.drawing.folds);
    const name = nameOf(start.point, end.point, board.drawing.folds);
    const fold = { id, name, kind: board.paint.kind, start, end };
    this.last = id;
    board.paint.turnOver(false);
    /** @type {Change} */
    const insert = (drawing) => insertFold(drawing, Math.min(index, drawing.folds.length), fold);
    const state = await board.store.edit(DRAW_FOLD, insert);
    if (state) board.store.showStep(index + 1);
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
    const isLong = stroke !== null && !stroke.isGrab && distance(stroke.from, stroke.to) > STROKE_MIN_M;
    return isLong ? [stroke.from, stroke.to] : null;
  }

  /** @returns {Items} */
  items() {
    const { stroke, board } = this;
    if (!stroke) return [];
    const [from, to] = [board.view.toPx(stroke.from), board.view.toPx(stroke.to)];
    const dots = [from, to].map(([cx, cy], n) => ({
      key: `end${n}`,
      tag: "circle",
      class: `handle fold-end is-${board.paint.kind}`,
      cx,
      cy,
      r: 4,
    }));
    if (distance(stroke.from, stroke.to) < STROKE_MIN_M) return dots;
    const [a, b] = this.line(stroke);
    /** @type {[Point, Point]} */
    const ends = [board.view.toPx(a), board.view.toPx(b)];
    return [
      ...foldItems({ key: "stroke", kind: board.paint.kind, ends, state: " is-selected", number: null }),
      stroke.isGrab && { key: "carry", tag: "path", class: "carry", d: `M${from.join(" ")}L${to.join(" ")}` },
      ...dots,
      !stroke.isGrab && lengthLabel("length", from, to, distance(stroke.from, stroke.to)),
    ];
  }
}
