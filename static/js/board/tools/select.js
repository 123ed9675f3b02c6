/** The tool `Select`: takes corners, edges, folds and their ends; drags them, nudges them, removes them. */

import { inEnglish, say } from "../../language/say.js";
import { isViewOnly } from "../../view_only.js";
import { edgeFrom, edgePoints } from "../curves.js";
import { removeFolds } from "../edits.js";
import { minus, nearestOnLine, plus } from "../geometry.js";
import { Gesture } from "../gesture.js";
import { hit } from "../hit.js";
import { freshId } from "../ids.js";
import { insertCorner, moveCorners, removeCorners, straightenEdges } from "../outline_edits.js";
import { MOVE_CORNER } from "../rules.js";
import { Drags, endsOfEdge, movedFold } from "./drags.js";
import { Tool } from "./tool.js";

/** @import { Change } from "../../edit_queue.js" */
/** @import { Hit } from "../hit.js" */
/** @import { Pointer } from "../pointer.js" */
/** @import { Dragged, Press } from "./drags.js" */
/** @import { Point } from "pleat" */

const CURSORS = { vertex: "grab", end: "grab", middle: "grab", fold: "move", edge: "move", cloth: "default" };
const LABELS = {
  vertex: MOVE_CORNER,
  edge: inEnglish("step.move_edge"),
  middle: inEnglish("step.bend_edge"),
  end: inEnglish("step.move_fold"),
  fold: inEnglish("step.move_fold"),
};
/** What a press on each kind selects; on cloth and beside it, nothing. */
const SELECTED = /** @type {const} */ ({ vertex: "vertex", end: "fold", fold: "fold", edge: "edge", middle: "edge" });
const LEAST_CORNERS = 3;

/**
 * What the hand is doing:
 * - idle: nothing is pressed;
 * - pressed: the pointer is down and has not moved;
 * - framing: it pulls a frame open round corners, from beside the cloth;
 * - panning: a finger moves the paper;
 * - dragging: it moves what was pressed, as one gesture.
 * A press leads from any state to "pressed", a move from there to one of the last three, release and cancel to "idle".
 * @typedef {{name: "idle"}
 *   | {name: "pressed", press: Press}
 *   | {name: "framing", frame: Frame}
 *   | {name: "panning", px: Point}
 *   | {name: "dragging", gesture: Gesture, dragged: Dragged}} State
 */

/** @type {State} */
const IDLE = { name: "idle" };

export class SelectTool extends Tool {
  /** @param {import("../board.js").Board} board */
  constructor(board) {
    super(board, "select", "default");
    /** @type {State} */
    this.state = IDLE;
    this.drags = new Drags(board);
  }

  get hint() {
    if (isViewOnly) return "";
    if (!this.board.isSpread) return say("hint.folded");
    if (!this.board.drawing.folds.length) return say("hint.first_fold");
    return say("hint.select");
  }

  /** @param {Pointer} pointer */
  takes(pointer) {
    const found = hit(this.board, pointer);
    return found !== null && found.kind !== "cloth";
  }

  /** @param {Pointer} pointer */
  hover(pointer) {
    const found = hit(this.board, pointer);
    this.board.hover = found;
    this.cursor = CURSORS[found?.kind ?? "cloth"];
  }

  leave() {
    this.board.hover = null;
  }

  /** @param {Pointer} pointer */
  press(pointer) {
    const found = hit(this.board, pointer);
    this.state = { name: "pressed", press: { hit: found, at: pointer.at, px: pointer.px, alt: pointer.alt } };
    this.take(found, pointer.shift);
  }

  /** @param {Hit|null} found @param {boolean} isMore whether it is added to what is selected, or taken out again */
  take(found, isMore) {
    const { store } = this.board;
    if (!found || found.kind === "cloth") {
      if (!isMore) store.select(null);
      return;
    }
    const kind = SELECTED[found.kind];
    const others = store.selection?.kind === kind ? store.selection.ids : [];
    const isIn = others.includes(found.id);
    if (isMore) store.select({ kind, ids: isIn ? others.filter((id) => id !== found.id) : [...others, found.id] });
    else if (!isIn || found.kind !== "vertex") store.select({ kind, ids: [found.id] });
  }

  /** @param {Pointer} pointer */
  drag(pointer) {
    if (this.state.name === "pressed") this.state = this.begun(this.state, pointer);
    const { state } = this;
    if (state.name === "dragging") state.gesture.show(state.dragged(pointer));
    else if (state.name === "framing") state.frame = [state.frame[0], pointer.px];
    else if (state.name === "panning") {
      this.board.view.pan(minus(pointer.px, state.px));
      state.px = pointer.px;
    }
  }

  /**
   * What a press becomes when the pointer moves. What was pressed may be gone by then: that is dragged nowhere.
   * @param {State & {name: "pressed"}} pressed
   * @param {Pointer} pointer
   * @returns {State}
   */
  begun(pressed, pointer) {
    const { hit: found, px, alt } = pressed.press;
    if (!found || found.kind === "cloth")
      return pointer.isTouch ? { name: "panning", px } : { name: "framing", frame: [px, px] };
    const dragged = this.drags.of(found, pressed.press);
    if (!dragged) return pressed;
    const label = alt && found.kind === "middle" ? inEnglish("step.add_vertex") : LABELS[found.kind];
    return { name: "dragging", gesture: new Gesture(this.board, label), dragged };
  }

  /** @param {Pointer} pointer */
  release(pointer) {
    const { state } = this;
    if (state.name === "framing") this.board.store.select(cornersWithin(this.board, state.frame));
    this.state = IDLE;
    if (state.name === "dragging") state.gesture.commit();
    this.board.snapped = null;
    this.hover(pointer);
  }

  /** @param {Pointer} pointer */
  twice(pointer) {
    const found = hit(this.board, pointer);
    if (found?.kind !== "edge" && found?.kind !== "middle") return;
    const id = freshId("v", this.board.drawing.outline);
    this.board.store.edit(inEnglish("step.add_vertex"), (drawing) => {
      const edge = edgeFrom(drawing, found.id);
      if (edge) insertCorner(drawing, found.id, id, nearestOnLine(pointer.at, edgePoints(...edge)) ?? pointer.at);
    });
    this.board.store.select({ kind: "vertex", ids: [id] });
  }

  cancel() {
    const { state } = this;
    if (state.name === "dragging") state.gesture.cancel();
    this.state = IDLE;
    this.board.snapped = null;
    return state.name === "dragging" || state.name === "framing";
  }

  /** Arrow keys and the keys that remove. @param {KeyboardEvent} event @returns {boolean} whether it was ours */
  key(event) {
    const by = this.board.nudgeOf(event);
    if (by) return this.nudge(by);
    if (event.key.toLowerCase() === "c" && !event.altKey) return this.openBend();
    if (event.key !== "Delete" && event.key !== "Backspace") return false;
    return this.remove();
  }

  /** @param {Point} by */
  nudge(by) {
    const { store } = this.board;
    const { kind, ids } = store.selection ?? { kind: "garment", ids: [] };
    const coalesce = `nudge-${kind}-${ids.join("-")}`.slice(0, 64);
    if (kind === "vertex" || kind === "edge") {
      const moved = kind === "vertex" ? ids : ids.flatMap((id) => endsOfEdge(this.board.drawing, id));
      /** @type {Change} */
      const change = (drawing) =>
        moveCorners(
          drawing,
          new Map(drawing.outline.filter(({ id }) => moved.includes(id)).map(({ id, point }) => [id, plus(point, by)])),
        );
      store.edit(kind === "vertex" ? MOVE_CORNER : inEnglish("step.move_edge"), change, { coalesce });
    } else if (kind === "fold") {
      const [id] = ids;
      const rings = this.board.ringsOf(id);
      store.edit(
        inEnglish("step.move_fold"),
        (drawing) => {
          const fold = drawing.folds.find((other) => other.id === id);
          if (fold) movedFold(id, plus(fold.start.point, by), plus(fold.end.point, by), rings)(drawing);
        },
        { coalesce },
      );
    } else return false;
    return true;
  }

  /** The number that bends the selected edge, or the one that starts at the selected corner. */
  openBend() {
    const { selection } = this.board.store;
    if (!this.board.isSpread || (selection?.kind !== "vertex" && selection?.kind !== "edge")) return false;
    this.board.store.select({ kind: "edge", ids: selection.ids.slice(0, 1) });
    return this.board.numbers.focus("bulge");
  }

  remove() {
    const { store, drawing } = this.board;
    const { kind, ids } = store.selection ?? { kind: "garment", ids: [] };
    if (kind === "fold")
      store.edit(inEnglish(ids.length > 1 ? "step.delete_folds" : "step.delete_fold"), (changed) =>
        removeFolds(changed, ids),
      );
    else if (kind === "edge") return this.straighten(ids);
    else if (kind !== "vertex") return false;
    else if (drawing.outline.length - ids.length < LEAST_CORNERS) store.refuse(say("rule.too_few_corners"));
    else {
      const step = ids.length > 1 ? "step.delete_vertices" : "step.delete_vertex";
      store.edit(inEnglish(step), (changed) => removeCorners(changed, ids));
    }
    return true;
  }

  /** @param {string[]} ids @returns {boolean} whether any of the edges was curved */
  straighten(ids) {
    const { store, drawing } = this.board;
    const isAny = drawing.outline.some(({ id, curve }) => curve && ids.includes(id));
    if (isAny) store.edit(inEnglish("step.straighten_edge"), (changed) => straightenEdges(changed, ids));
    return isAny;
  }

  items() {
    return this.state.name === "framing" ? [marquee(this.state.frame)] : [];
  }
}

/** @typedef {[Point, Point]} Frame two opposite corners (px) */

/** @param {Frame} frame */
function marquee([[ax, ay], [bx, by]]) {
  return {
    key: "frame",
    tag: "rect",
    class: "marquee",
    x: Math.min(ax, bx),
    y: Math.min(ay, by),
    width: Math.abs(bx - ax),
    height: Math.abs(by - ay),
  };
}

/**
 * The corners within, or else the folds whose ends both are.
 * @param {import("../board.js").Board} board
 * @param {Frame} frame
 * @returns {import("../../store.js").Selection|null}
 */
function cornersWithin(board, [[ax, ay], [bx, by]]) {
  /** @param {Point} point */
  const isIn = (point) => {
    const [x, y] = board.view.toPx(point);
    return (x - ax) * (x - bx) <= 0 && (y - ay) * (y - by) <= 0;
  };
  const corners = board.isSpread ? board.drawing.outline.filter(({ point }) => isIn(point)) : [];
  if (corners.length) return { kind: "vertex", ids: corners.map(({ id }) => id) };
  const folds = board.drawing.folds.filter(
    ({ start, end }, index) => index >= board.step && isIn(start.point) && isIn(end.point),
  );
  return folds.length ? { kind: "fold", ids: folds.map(({ id }) => id) } : null;
}
