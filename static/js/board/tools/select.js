/** The tool `Select`: takes corners, edges, folds and their ends; drags them, nudges them, removes them. */

import { endsOnto } from "../edge_onto_edge.js";
import { freshId, insertCorner, moveCorners, moveFold, removeCorners, removeFolds } from "../edits.js";
import { Gesture } from "../gesture.js";
import { chordAlong, distance, minus, nearestOnRings, plus } from "../geometry.js";
import { hit } from "../hit.js";
import { cornersWithin, marquee } from "../marquee.js";
import { Tool } from "./tool.js";

const CURSORS = { vertex: "grab", end: "grab", middle: "copy", fold: "move", edge: "move", cloth: "default" };
const LEAST_CORNERS = 3;

export class SelectTool extends Tool {
  /** @param {import("../board.js").Board} board */
  constructor(board) {
    super(board, "select", "default");
    this.drop();
  }

  get hint() {
    if (!this.board.isSpread) return "Folded so far. Press [ to go back to where corners and folds are changed.";
    if (!this.board.drawing.folds.length) return "Draw the first fold with F, or drag corners and edges.";
    return "Drag corners, edges and folds. Double-click an edge for a new corner.";
  }

  drop() {
    /** What was pressed, and where. @type {any} */
    this.held = null;
    /** @type {Gesture|null} */
    this.gesture = null;
    /** @type {[[number, number], [number, number]]|null} */
    this.frame = null;
  }

  hover(pointer) {
    const found = hit(this.board, pointer);
    this.board.hover = found;
    this.cursor = CURSORS[found?.kind ?? "cloth"];
  }

  leave() {
    this.board.hover = null;
  }

  press(pointer) {
    const found = hit(this.board, pointer);
    this.held = { hit: found, at: pointer.at, px: pointer.px, pointer };
    this.take(found, pointer.shift);
  }

  take(found, isMore) {
    const { store } = this.board;
    const kind = { vertex: "vertex", end: "fold", fold: "fold", edge: "edge", middle: "edge" }[found?.kind ?? ""];
    if (!kind) {
      if (!isMore) store.select(null);
      return;
    }
    const others = store.selection?.kind === kind ? store.selection.ids : [];
    const isIn = others.includes(found.id);
    if (isMore) store.select({ kind, ids: isIn ? others.filter((id) => id !== found.id) : [...others, found.id] });
    else if (!isIn || found.kind !== "vertex") store.select({ kind, ids: [found.id] });
  }

  drag(pointer) {
    if (!this.held) return;
    if (!this.held.hit || this.held.hit.kind === "cloth") {
      this.pull(pointer);
      return;
    }
    this.held.change ??= this[`drag_${this.held.hit.kind}`](this.held);
    this.gesture ??= new Gesture(this.board, LABELS[this.held.hit.kind]);
    this.gesture.show(this.held.change(pointer));
  }

  /** A frame round corners; a finger moves the paper instead. */
  pull(pointer) {
    if (pointer.isTouch) {
      this.board.view.pan(minus(pointer.px, this.held.px));
      this.held.px = pointer.px;
    } else {
      this.frame = [this.held.px, pointer.px];
    }
  }

  /** @returns {(pointer: any) => (drawing: any) => void} */
  drag_vertex({ hit: { id } }) {
    const { board } = this;
    const chosen = board.store.selection?.kind === "vertex" ? board.store.selection.ids : [id];
    return this.dragCorners(chosen, id);
  }

  drag_edge({ hit: { id } }) {
    const { outline } = this.board.drawing;
    const index = outline.findIndex((corner) => corner.id === id);
    return this.dragCorners([id, outline[(index + 1) % outline.length].id], null);
  }

  /** Corners that move as one; the one that is held snaps. */
  dragCorners(ids, heldId) {
    const starts = new Map(
      this.board.drawing.outline.filter(({ id }) => ids.includes(id)).map(({ id, point }) => [id, point]),
    );
    const from = heldId ? starts.get(heldId) : this.held.at;
    const grip = minus(from, this.held.at);
    return (pointer) => {
      const at = plus(pointer.at, grip);
      const snapped = this.board.snapTo({ ...pointer, at }, this.targets(ids, from));
      const by = minus(snapped.at, from);
      const places = new Map([...starts].map(([id, point]) => [id, plus(point, by)]));
      return (drawing) => moveCorners(drawing, places);
    };
  }

  targets(ids, from) {
    const others = this.board.drawing.outline.filter(({ id }) => !ids.includes(id)).map(({ point }) => point);
    return { rings: [], points: others, guides: others, from };
  }

  drag_middle({ hit: { id } }) {
    const made = freshId("v", this.board.drawing.outline);
    return (pointer) => {
      const { at } = this.board.snapTo(pointer, this.targets([made], null));
      return (drawing) => insertCorner(drawing, id, made, at);
    };
  }

  drag_end({ hit: { id, end } }) {
    const rings = this.board.ringsOf(id);
    const other = this.board.fold(id)[end === "start" ? "end" : "start"].point;
    const targets = { rings, points: [], onlyCloth: true, from: other, laid: endsOnto(other, rings) };
    return (pointer) => {
      const { at } = this.board.snapTo(pointer, targets);
      const point = nearestOnRings(at, rings) ?? at;
      return (drawing) => moveFold(drawing, id, { [end]: { point, on: null } });
    };
  }

  drag_fold({ hit: { id }, at }) {
    const rings = this.board.ringsOf(id);
    const { start, end } = this.board.fold(id);
    return (pointer) => {
      const by = minus(pointer.at, at);
      return movedFold(id, plus(start.point, by), plus(end.point, by), rings);
    };
  }

  release(pointer) {
    const { frame, gesture } = this;
    if (frame) this.board.store.select(cornersWithin(this.board, frame));
    this.drop();
    gesture?.commit();
    this.board.snapped = null;
    this.hover(pointer);
  }

  twice(pointer) {
    const found = hit(this.board, pointer);
    if (found?.kind !== "edge" && found?.kind !== "middle") return;
    const id = freshId("v", this.board.drawing.outline);
    this.board.store.edit("Add vertex", (drawing) =>
      insertCorner(drawing, found.id, id, onEdge(drawing, found.id, pointer.at)),
    );
    this.board.store.select({ kind: "vertex", ids: [id] });
  }

  cancel() {
    const wasBusy = Boolean(this.gesture ?? this.frame);
    this.gesture?.cancel();
    this.drop();
    this.board.snapped = null;
    return wasBusy;
  }

  /** Arrow keys and the keys that remove. @param {KeyboardEvent} event @returns {boolean} whether it was ours */
  key(event) {
    const by = this.board.nudgeOf(event);
    if (by) return this.nudge(by);
    if (event.key !== "Delete" && event.key !== "Backspace") return false;
    return this.remove();
  }

  nudge(by) {
    const { store } = this.board;
    const { kind, ids } = store.selection ?? { kind: "garment", ids: [] };
    const coalesce = `nudge-${kind}-${ids.join("-")}`.slice(0, 64);
    if (kind === "vertex" || kind === "edge") {
      const moved = kind === "vertex" ? ids : ids.flatMap((id) => endsOfEdge(this.board.drawing, id));
      const change = (drawing) =>
        moveCorners(
          drawing,
          new Map(drawing.outline.filter(({ id }) => moved.includes(id)).map(({ id, point }) => [id, plus(point, by)])),
        );
      store.edit(kind === "vertex" ? "Move vertex" : "Move edge", change, { coalesce });
    } else if (kind === "fold") {
      const [id] = ids;
      const rings = this.board.ringsOf(id);
      store.edit(
        "Move fold",
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
      store.edit(ids.length > 1 ? "Delete folds" : "Delete fold", (changed) => removeFolds(changed, ids));
    else if (kind !== "vertex") return false;
    else if (drawing.outline.length - ids.length < LEAST_CORNERS)
      store.refuse("An outline has at least three corners.");
    else store.edit(ids.length > 1 ? "Delete vertices" : "Delete vertex", (changed) => removeCorners(changed, ids));
    return true;
  }

  items() {
    return this.frame ? [marquee(this.frame)] : [];
  }
}

const LABELS = { vertex: "Move vertex", edge: "Move edge", middle: "Add vertex", end: "Move fold", fold: "Move fold" };

/** The fold along a line, its ends on the cloth's boundary where the line meets it. */
function movedFold(id, start, end, rings) {
  const chord = chordAlong(start, end, rings);
  return (drawing) => {
    if (chord && distance(chord[0], chord[1]) > 0.001)
      moveFold(drawing, id, { start: { point: chord[0], on: null }, end: { point: chord[1], on: null } });
  };
}

function endsOfEdge({ outline }, id) {
  const index = outline.findIndex((corner) => corner.id === id);
  return [id, outline[(index + 1) % outline.length].id];
}

function onEdge({ outline }, id, at) {
  const [a, b] = endsOfEdge({ outline }, id).map((end) => outline.find((corner) => corner.id === end).point);
  return nearestOnRings(at, [[a, b]]) ?? at;
}
