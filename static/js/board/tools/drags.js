/** What the tool `Select` drags: corners, edges, the middles of edges, folds and their ends. */

import { edgeFrom } from "../curves.js";
import { endsOnto } from "../edge_onto_edge.js";
import { moveFold } from "../edits.js";
import { chordAlong, distance, minus, nearestOnRings, plus } from "../geometry.js";
import { freshId } from "../ids.js";
import { bendEdge, insertCorner, moveCorners } from "../outline_edits.js";

/** @import { Drawing, Point } from "pleat" */
/** @import { Change } from "../../edit_queue.js" */
/** @import { Hit } from "../hit.js" */
/** @import { Pointer } from "../pointer.js" */
/** @import { Targets } from "../snap.js" */

/** @typedef {(pointer: Pointer) => Change} Dragged the change that brings what is dragged to a pointer */
/**
 * What was pressed, and where (garment frame in m, px); with Alt an edge's middle becomes a corner.
 * @typedef {{hit: Hit|null, at: Point, px: Point, alt: boolean}} Press
 */

/** @type {Targets} */
const NO_TARGETS = { rings: [], points: [], onlyCloth: true };

export class Drags {
  /** @param {import("../board.js").Board} board */
  constructor(board) {
    this.board = board;
  }

  /** @param {Exclude<Hit, {kind: "cloth"}>} found @param {Press} press @returns {Dragged|null} */
  of(found, press) {
    switch (found.kind) {
      case "vertex":
        return this.ofCorners(this.chosenWith(found.id), found.id, press.at);
      case "edge":
        return this.ofCorners(endsOfEdge(this.board.drawing, found.id), null, press.at);
      case "middle":
        return press.alt ? this.ofNewCorner(found.id) : this.ofBend(found.id);
      case "end":
        return this.ofEnd(found.id, found.end);
      case "fold":
        return this.ofFold(found.id, press.at);
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
  ofCorners(ids, heldId, pressedAt) {
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
  ofNewCorner(id) {
    const made = freshId("v", this.board.drawing.outline);
    return (pointer) => {
      const { at } = this.board.snapTo(pointer, this.targets([made], null));
      return (drawing) => insertCorner(drawing, id, made, at);
    };
  }

  /** An edge bent by its middle. @param {string} id @returns {Dragged|null} */
  ofBend(id) {
    const edge = edgeFrom(this.board.drawing, id);
    if (!edge) return null;
    const ends = /** @type {[Point, Point]} */ (edge.map(({ point }) => point));
    return (pointer) => {
      const { at } = this.board.snapTo(pointer, { ...NO_TARGETS, bent: ends });
      return (drawing) => bendEdge(drawing, id, at);
    };
  }

  /** @param {string} id @param {"start"|"end"} end @returns {Dragged|null} */
  ofEnd(id, end) {
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
  ofFold(id, pressedAt) {
    const rings = this.board.ringsOf(id);
    const fold = this.board.fold(id);
    if (!fold) return null;
    const { start, end } = fold;
    return (pointer) => {
      const by = minus(pointer.at, pressedAt);
      return movedFold(id, plus(start.point, by), plus(end.point, by), rings);
    };
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
export function movedFold(id, start, end, rings) {
  const chord = chordAlong(start, end, rings);
  return (drawing) => {
    if (chord && distance(chord[0], chord[1]) > 0.001)
      moveFold(drawing, id, { start: { point: chord[0], on: null }, end: { point: chord[1], on: null } });
  };
}

/** @param {Drawing} drawing @param {string} id the edge's @returns {[string, string]} */
export function endsOfEdge({ outline }, id) {
  const index = outline.findIndex((corner) => corner.id === id);
  return [id, outline[(index + 1) % outline.length].id];
}
