/**
 * The tool `Draw fold`: from edge to edge of the cloth as it lies then, or a point of the cloth grabbed and dropped
 * where it shall land. The page shows what it thinks at once; the server's word takes its place.
 */

import { CreaseQuestion } from "../crease.js";
import { foldItems } from "../draw_folds.js";
import { lengthLabel } from "../draw_handles.js";
import { dropsOnto, edgeNear, endsOnto } from "../edge_onto_edge.js";
import { freshId, insertFold } from "../edits.js";
import { distance, isInside, nearestOnRings } from "../geometry.js";
import { atLength, REACH_PX } from "../snap.js";
import { ghostOf, lineOf, nameOf, reachesCloth } from "../stroke.js";
import { Tool } from "./tool.js";

const LEAST_M = 0.002;
/** Cloth that is grabbed so near to an edge is grabbed by that edge (px). */
const BY_EDGE_PX = 20;
/** Kinds of snaps that mean the point itself, not its edge. */
const POINTS = new Set(["vertex", "fraction"]);
const BESIDE = "No fold there: the stroke does not touch the cloth.";
const UNCLOSED = "The outline is not closed yet: go on with Draw outline (P).";
const NO_FLAP = "The first fold cannot be red: red takes the flap of the fold before it.";

export class FoldTool extends Tool {
  /** @param {import("../board.js").Board} board */
  constructor(board) {
    super(board, "fold", "crosshair");
    this.question = new CreaseQuestion(board);
    this.typed = null;
    /** Settled when all strokes so far are folds; how many there were, and how many are. */
    this.finished = Promise.resolve();
    this.begun = 0;
    this.done = 0;
    this.drop();
  }

  get hint() {
    if (this.stroke)
      return this.stroke.isGrab
        ? "Drop it where it shall land."
        : "To another edge; what is left of the arrow moves. Flip: X";
    return this.board.paint.grabs
      ? "Grab the cloth and drop it where it shall land."
      : "Drag from edge to edge, or grab the cloth and drop it where it shall land.";
  }

  get isBusy() {
    return this.stroke !== null;
  }

  drop() {
    /** @type {any} from where to where, and whether it is a grab */
    this.stroke = null;
    /** Whether the server has refused the stroke as it was last. */
    this.isRefused = false;
    this.question.forget();
    this.board.ghost = null;
  }

  enter() {
    const { board } = this;
    board.store.select(null);
    board.store.showStep(board.store.moments - 1);
    this.last = "";
    if (this.stroke && (this.stroke.step !== board.step || this.stroke.version !== board.state.version)) this.drop();
  }

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

  press(pointer) {
    const snapped = this.hover(pointer);
    if (this.stroke) return;
    if (!this.board.rings.length) {
      this.board.store.refuse(this.noCloth());
      return;
    }
    const isGrab = this.isGrab(snapped, pointer);
    const isEarly = this.begun > this.done && !this.isToGrab(pointer);
    const { isTouch } = pointer;
    const laid = this.laid(isGrab, snapped, isTouch);
    this.isRefused = false;
    const { step, state } = this.board;
    const { version } = state;
    this.stroke = { isGrab, isEarly, isTouch, from: snapped.at, to: snapped.at, isArmed: false, laid, step, version };
  }

  /** Why there is nothing to draw a fold on. */
  noCloth() {
    const { paint, step, tools } = this.board;
    if (paint.kind === "red" && step === 0) return NO_FLAP;
    return tools.outline.isBusy ? UNCLOSED : "There is no cloth yet: draw an outline first.";
  }

  /** Whether a stroke that begins there takes cloth along: inside it always, at its edges and corners when told to. */
  isGrab({ at, isOnCloth }, pointer) {
    return isOnCloth ? this.isToGrab(pointer) : isInside(at, this.board.rings);
  }

  isToGrab({ alt }) {
    return alt || this.board.paint.grabs;
  }

  /** Where a stroke would have to end to lay one edge on another. */
  laid(isGrab, { at, kind }, isTouch) {
    const { rings, view } = this.board;
    if (!isGrab) return endsOnto(at, rings);
    const edge = POINTS.has(kind) ? null : edgeNear(at, rings, ((isTouch ? 2 : 1) * BY_EDGE_PX) / view.scale);
    return edge ? dropsOnto(at, edge, rings) : [];
  }

  drag(pointer) {
    this.hover(pointer);
  }

  release(pointer, hasMoved) {
    if (!this.stroke) return;
    this.hover(pointer);
    if (hasMoved || this.stroke.isArmed) this.finish();
    else this.stroke.isArmed = true;
  }

  lead(at) {
    const { from } = this.stroke;
    this.stroke.to = this.typed !== null ? atLength(from, at, this.typed) : at;
    this.ask();
  }

  ask() {
    const { stroke, board } = this;
    if (!stroke || distance(stroke.from, stroke.to) < LEAST_M) return;
    if (this.isBeside(stroke)) {
      this.question.forget();
      this.refuse(BESIDE);
      return;
    }
    if (!this.isRefused) board.ghost = ghostOf(this.line(), board.rings);
    if (board.store.queue.isBusy) return; // the cloth that the server knows is not yet the one that is seen
    this.question.ask(stroke, (answer) => {
      if (!answer.ok) {
        this.refuse(answer.told.detail);
        return;
      }
      if (this.stroke) board.ghost = answer.told;
      this.isRefused = false;
      this.cursor = "crosshair";
      board.say("");
      board.render();
    });
  }

  /** No fold comes of the stroke as it is now: nothing is shown but why. */
  refuse(why) {
    this.isRefused = true;
    this.cursor = "not-allowed";
    this.board.ghost = null;
    this.board.say(why);
    this.board.render();
  }

  /** Whether a stroke is drawn beside the cloth. */
  isBeside(stroke) {
    const { rings, view } = this.board;
    const near = ((stroke.isTouch ? 2 : 1) * REACH_PX.edge) / view.scale;
    return !stroke.isGrab && !reachesCloth(stroke, rings, near);
  }

  /** The fold's line; what lies to its left moves. */
  line() {
    return lineOf(this.stroke, this.board.rings, this.board.paint.isFlipped);
  }

  /** The stroke is done; a next one may begin before the server has answered. */
  finish() {
    const { stroke, board } = this;
    board.closeTyped();
    board.snapped = null;
    const isBeside = this.isBeside(stroke);
    if (isBeside || distance(stroke.from, stroke.to) < LEAST_M) {
      this.cancel();
      if (isBeside) board.store.refuse(BESIDE);
      return;
    }
    this.stroke = null;
    this.question.forget();
    this.begun += 1;
    this.finished = this.finished.then(() => this.complete(stroke)).catch((error) => this.fail(error));
  }

  /** A stroke was lost to a fault of the page; the next ones are none the worse. */
  fail(error) {
    this.done += 1;
    if (!this.stroke) this.drop();
    this.board.store.refuse("The fold could not be drawn. Draw it again, or reload the page.");
    console.error(error);
  }

  /** Add the fold to those that are there by then. */
  async complete(stroke) {
    const { board } = this;
    await board.store.settled();
    if (stroke.isEarly && stroke.isGrab) stroke.isGrab = !this.isOnEdge(stroke);
    const answer = await this.question.answer(stroke);
    if (answer.ok) await this.add(answer.told);
    else board.store.refuse(answer.told.detail);
    if (!this.stroke) board.say("");
    this.done += 1;
    if (!this.stroke) this.drop();
    board.render();
  }

  /** Whether a stroke that was quicker than the server begins at an edge of the cloth as it has become. */
  isOnEdge({ from, isTouch }) {
    const { rings, view } = this.board;
    const near = nearestOnRings(from, rings);
    return near !== null && distance(near, from) * view.scale <= (isTouch ? 2 : 1) * REACH_PX.edge;
  }

  async add({ start, end }) {
    const { board } = this;
    const index = board.step;
    const id = freshId("f", board.drawing.folds);
    const name = nameOf(start.point, end.point, board.drawing.folds);
    const fold = { id, name, kind: board.paint.kind, start, end };
    this.last = id;
    board.paint.turnOver(false);
    const insert = (drawing) => insertFold(drawing, Math.min(index, drawing.folds.length), fold);
    const state = await board.store.edit("Draw fold", insert);
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
    if (!this.stroke?.isArmed) this.cancel();
    this.question.forget();
    this.board.ghost = null;
    this.board.say("");
  }

  get lastPart() {
    return this.isBusy ? "the fold\u2019s first end" : "";
  }

  leave() {
    this.board.snapped = null;
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    if (event.key !== "Enter" || !this.board.isByKeyboard) return false;
    const pointer = this.board.keyboardPointer(event);
    if (!this.stroke) this.press(pointer);
    this.release(pointer, false);
    return true;
  }

  type(metres) {
    this.typed = metres;
    if (this.stroke && metres !== null) this.lead(this.stroke.to);
  }

  get stretch() {
    return this.stroke && !this.stroke.isGrab && distance(this.stroke.from, this.stroke.to) > LEAST_M
      ? [this.stroke.from, this.stroke.to]
      : null;
  }

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
    if (distance(stroke.from, stroke.to) < LEAST_M) return dots;
    const ends = this.line().map((point) => board.view.toPx(point));
    return [
      ...foldItems({ key: "stroke", kind: board.paint.kind, ends, state: " is-selected", number: null }),
      stroke.isGrab && { key: "carry", tag: "path", class: "carry", d: `M${from.join(" ")}L${to.join(" ")}` },
      ...dots,
      !stroke.isGrab && lengthLabel("length", from, to, distance(stroke.from, stroke.to)),
    ];
  }
}
