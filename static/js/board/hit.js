/** What a pointer is on: a corner, an end of a fold, the middle of an edge, a fold, an edge, the cloth. */

import { edgePoints, handleOf, outlineEdges } from "./curves.js";
import { distance, isInside, nearestOnLine } from "./geometry.js";
import { FINGER_PX, HANDLE_PX } from "./rules.js";

/** @import { Point } from "pleat" */
/** @import { Board } from "./board.js" */

const LINE_PX = 7;
const ENDS = /** @type {const} */ (["start", "end"]);

/**
 * What was hit, by its id; cloth has none, and an edge goes by the corner that it starts at.
 * @typedef {{kind: "end", id: string, end: "start"|"end", edge?: undefined}
 *   | {kind: "middle"|"edge", id: string, edge: string}
 *   | {kind: "vertex"|"fold", id: string, edge?: undefined}
 *   | {kind: "cloth", id: "", edge?: undefined}} Hit
 */
/**
 * What a handle is of, where it is, how far behind others (px).
 * @typedef {[found: Hit, at: Point, bias: number]} Handle
 */

/** @param {import("./board.js").Board} board @param {import("./pointer.js").Pointer} pointer @returns {Hit|null} */
export function hit(board, pointer) {
  const reach = pointer.isTouch ? FINGER_PX : HANDLE_PX;
  const line = pointer.isTouch ? FINGER_PX / 2 : LINE_PX;
  return handleAt(board, pointer.px, reach) ?? lineAt(board, pointer.px, line) ?? clothAt(board, pointer.at);
}

/**
 * The nearest handle; of those at one place the selected one, then the corner.
 * @param {Board} board
 * @param {Point} px
 * @param {number} reach
 * @returns {Hit|null}
 */
function handleAt(board, px, reach) {
  /** @type {{found: Hit, rank: number}|null} */
  let best = null;
  for (const [found, at, bias] of handles(board)) {
    const away = distance(px, at);
    if (away <= reach && (!best || away + bias < best.rank)) best = { found, rank: away + bias };
  }
  return best?.found ?? null;
}

/** @param {Board} board @returns {Generator<Handle>} */
function* handles(board) {
  const { drawing, view, step, isSpread } = board;
  for (const [index, fold] of drawing.folds.entries()) {
    if (index < step) continue;
    const bias = board.isSelected("fold", fold.id) ? -4 : 1;
    for (const end of ENDS) yield [{ kind: "end", id: fold.id, end }, view.toPx(fold[end].point), bias];
  }
  if (!isSpread) return;
  for (const { id, point } of drawing.outline)
    yield [{ kind: "vertex", id }, view.toPx(point), board.isSelected("vertex", id) ? -5 : 0];
  for (const [a, b] of outlineEdges(drawing.outline)) {
    if (a.curve || board.isSelected("edge", a.id) || board.hover?.edge === a.id)
      yield [{ kind: "middle", id: a.id, edge: a.id }, view.toPx(handleOf(a, b)), 3];
  }
}

/** @param {Board} board @param {Point} px @param {number} reach @returns {Hit|null} */
function lineAt(board, px, reach) {
  const { drawing, view, step, isSpread } = board;
  /** @type {{found: Hit, away: number}[]} */
  const near = [];
  /** @param {Hit} found @param {Point[]} points */
  const consider = (found, points) => {
    const on = nearestOnLine(px, points.map((point) => view.toPx(point)));
    const away = on ? distance(px, on) : Infinity;
    if (away <= reach) near.push({ found, away });
  };
  for (const [index, fold] of drawing.folds.entries()) {
    if (index >= step) consider({ kind: "fold", id: fold.id }, [fold.start.point, fold.end.point]);
  }
  if (isSpread)
    for (const [a, b] of outlineEdges(drawing.outline)) consider({ kind: "edge", id: a.id, edge: a.id }, edgePoints(a, b));
  const least = Math.min(...near.map(({ away }) => away));
  return near.find(({ away }) => away === least)?.found ?? null;
}

/** @param {Board} board @param {Point} at @returns {Hit|null} */
function clothAt(board, at) {
  return isInside(at, board.rings) ? { kind: "cloth", id: "" } : null;
}
