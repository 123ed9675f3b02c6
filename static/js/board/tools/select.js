/** The tool `Select`: takes corners, edges, folds and their ends; drags them, nudges them, removes them. */

import { inEnglish, say } from "../../language/say.js";
import { endsOnto } from "../edge_onto_edge.js";
import { freshId, insertCorner, moveCorners, moveFold, removeCorners, removeFolds } from "../edits.js";
import { Gesture } from "../gesture.js";
import { chordAlong, distance, minus, nearestOnRings, plus } from "../geometry.js";
import { hit } from "../hit.js";
import { cornersWithin, marquee } from "../marquee.js";
import { MOVE_CORNER } from "../rules.js";
import { Tool } from "./tool.js";

/** @import { Drawing, Point } from "pleat" */
/** @import { Change } from "../../edit_queue.js" */
/** @import { Hit } from "../hit.js" */
/** @import { Pointer } from "../pointer.js" */
/** @import { Targets } from "../snap.js" */
/** @import { Frame } from "../marquee.js" */

const CURSORS = { vertex: "grab", end: "grab", middle: "copy", fold: "move", edge: "move", cloth: "default" };
const LABELS = {
  vertex: MOVE_CORNER,
  edge: inEnglish("step.move_edge"),
  middle: inEnglish("step.add_vertex"),
  end: inEnglish("step.move_fold"),
  fold: inEnglish("step.move_fold"),
};
/** What a press on each kind selects; on cloth and beside it, nothing. */
const SELECTED = /** @type {const} */ ({ vertex: "vertex", end: "fold", fold: "fold", edge: "edge", middle: "edge" });
const LEAST_CORNERS = 3;

/** @typedef {(pointer: Pointer) => Change} Dragged the change that brings what is dragged to a pointer */
/** @typedef {{hit: Hit|null, at: Point, px: Point}} Press what was pressed, and where (article frame in m, px) */
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
  }

  get hint() {
    if (!this.board.isSpread) return say("hint.folded");
    if (!this.board.drawing.folds.length) return say("hint.first_fold");
    return say("hint.select");
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
    this.state = { name: "pressed", press: { hit: found, at: pointer.at, px: pointer.px } };
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
    const { hit: found, px } = pressed.press;
    if (!found || found.kind === "cloth")
      return pointer.isTouch ? { name: "panning", px } : { name: "framing", frame: [px, px] };
    const dragged = this.dragged(found, pressed.press);
    if (!dragged) return pressed;
    return { name: "dragging", gesture: new Gesture(this.board, LABELS[found.kind]), dragged };
  }

  /** @param {Exclude<Hit, {kind: "cloth"}>} found @param {Press} press @returns {Dragged|null} */
  dragged(found, press) {
    switch (found.kind) {
      case "vertex":
        return this.draggedCorners(this.chosenWith(found.id), found.id, press.at);
      case "edge":
        return this.draggedCorners(endsOfEdge(this.board.drawing, found.id), null, press.at);
      case "middle":
        return this.draggedMiddle(found.id);
      case "end":
        return this.draggedEnd(found.id, found.end);
      case "fold":
        return this.draggedFold(found.id, press.at);
    }
  }

  /** The corners that move along with one. @param {string} id */
  chosenWith(id) {
    const { selection } = this.board.store;
    return selection?.kind === "vertex" ? selection.ids : [id];
  }

  /**
   * Corners that move as one; the one that is held snaps.
   * @param {string[]} ids
   * @param {string|null} heldId
   * @param {Point} pressedAt
   * @returns {Dragged}
   */
  draggedCorners(ids, heldId, pressedAt) {
    const starts = new Map(
      this.board.drawing.outline.filter(({ id }) => ids.includes(id)).map(({ id, point }) => [id, point]),
    );
    const from = (heldId !== null && starts.get(heldId)) || pressedAt;
    const grip = minus(from, pressedAt);
    return (pointer) => {
      const at = plus(pointer.at, grip);
      const snapped = this.board.snapTo({ ...pointer, at }, this.targets(ids, from));
      const by = minus(snapped.at, from);
      const places = new Map([...starts].map(([id, point]) => [id, plus(point, by)]));
      return (drawing) => moveCorners(drawing, places);
    };
  }

  /** @param {string[]} ids @param {Point|null} from @returns {Targets} */
  targets(ids, from) {
    const others = this.board.drawing.outline.filter(({ id }) => !ids.includes(id)).map(({ point }) => point);
    return { rings: [], points: others, guides: others, from };
  }

  /** A new corner, pulled out of an edge. @param {string} id @returns {Dragged} */
  draggedMiddle(id) {
    const made = freshId("v", this.board.drawing.outline);
    return (pointer) => {
      const { at } = this.board.snapTo(pointer, this.targets([made], null));
      return (drawing) => insertCorner(drawing, id, made, at);
    };
  }

  /** @param {string} id @param {"start"|"end"} end @returns {Dragged|null} */
  draggedEnd(id, end) {
    const rings = this.board.ringsOf(id);
    const other = this.board.fold(id)?.[end === "start" ? "end" : "start"].point;
    if (!other) return null;
    const targets = { rings, points: [], onlyCloth: true, from: other, laid: endsOnto(other, rings) };
    return (pointer) => {
      const { at } = this.board.snapTo(pointer, targets);
      const point = nearestOnRings(at, rings) ?? at;
      return (drawing) => moveFold(drawing, id, { [end]: { point, on: null } });
    };
  }

  /** @param {string} id @param {Point} pressedAt @returns {Dragged|null} */
  draggedFold(id, pressedAt) {
    const rings = this.board.ringsOf(id);
    const fold = this.board.fold(id);
    if (!fold) return null;
    const { start, end } = fold;
    return (pointer) => {
      const by = minus(pointer.at, pressedAt);
      return movedFold(id, plus(start.point, by), plus(end.point, by), rings);
    };
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
    this.board.store.edit(inEnglish("step.add_vertex"), (drawing) =>
      insertCorner(drawing, found.id, id, onEdge(drawing, found.id, pointer.at)),
    );
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

  remove() {
    const { store, drawing } = this.board;
    const { kind, ids } = store.selection ?? { kind: "garment", ids: [] };
    if (kind === "fold")
      store.edit(inEnglish(ids.length > 1 ? "step.delete_folds" : "step.delete_fold"), (changed) =>
        removeFolds(changed, ids),
      );
    else if (kind !== "vertex") return false;
    else if (drawing.outline.length - ids.length < LEAST_CORNERS) store.refuse(say("rule.too_few_corners"));
    else {
      const step = ids.length > 1 ? "step.delete_vertices" : "step.delete_vertex";
      store.edit(inEnglish(step), (changed) => removeCorners(changed, ids));
    }
    return true;
  }

  items() {
    return this.state.name === "framing" ? [marquee(this.state.frame)] : [];
  }
}

/**
 * The fold along a line, its ends on the cloth's boundary where the line meets it.
 * @param {string} id
 * @param {Point} start
 * @param {Point} end
 * @param {Point[][]} rings
 * @returns {Change}
 */
function movedFold(id, start, end, rings) {
  const chord = chordAlong(start, end, rings);
  return (drawing) => {
    if (chord && distance(chord[0], chord[1]) > 0.001)
      moveFold(drawing, id, { start: { point: chord[0], on: null }, end: { point: chord[1], on: null } });
  };
}

/** @param {Drawing} drawing @param {string} id the edge's @returns {[string, string]} */
function endsOfEdge({ outline }, id) {
  const index = outline.findIndex((corner) => corner.id === id);
  return [id, outline[(index + 1) % outline.length].id];
}

/** @param {Drawing} drawing @param {string} id the edge's @param {Point} at */
function onEdge({ outline }, id, at) {
  const index = outline.findIndex((corner) => corner.id === id);
  const [a, b] = [outline[index], outline[(index + 1) % outline.length]];
  return (a && nearestOnRings(at, [[a.point, b.point]])) ?? at;
}
