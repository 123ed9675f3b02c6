/** What a pointer is on: a corner, an end of a fold, the middle of an edge, a fold, an edge, the cloth. */

import { between, distance, isInside, nearestOn } from "./geometry.js";

const HIT_PX = 12;
const TOUCH_PX = 22;
const LINE_PX = 7;

/** @typedef {"vertex"|"end"|"middle"|"fold"|"edge"|"cloth"} Kind */
/** @typedef {{kind: Kind, id: string, end?: "start"|"end", edge?: string}} Hit */

/**
 * @param {import("./board.js").Board} board
 * @param {import("./pointer.js").Pointer} pointer
 * @returns {Hit|null}
 */
export function hit(board, pointer) {
  const reach = pointer.isTouch ? TOUCH_PX : HIT_PX;
  const line = pointer.isTouch ? TOUCH_PX / 2 : LINE_PX;
  return handleAt(board, pointer.px, reach) ?? lineAt(board, pointer.px, line) ?? clothAt(board, pointer.at);
}

/** The nearest handle; of those at one place the selected one, then the corner. */
function handleAt(board, px, reach) {
  let best = null;
  for (const [found, at, bias] of handles(board)) {
    const away = distance(px, at);
    if (away <= reach && (!best || away + bias < best.rank)) best = { found, rank: away + bias };
  }
  return best?.found ?? null;
}

function* handles(board) {
  const { drawing, view, step, isSpread } = board;
  for (const [index, fold] of drawing.folds.entries()) {
    if (index < step) continue;
    const bias = board.isSelected("fold", fold.id) ? -4 : 1;
    for (const end of ["start", "end"]) yield [{ kind: "end", id: fold.id, end }, view.toPx(fold[end].point), bias];
  }
  if (!isSpread) return;
  for (const { id, point } of drawing.outline)
    yield [{ kind: "vertex", id }, view.toPx(point), board.isSelected("vertex", id) ? -5 : 0];
  for (const [a, b] of edges(drawing)) {
    if (board.isSelected("edge", a.id) || board.hover?.edge === a.id)
      yield [{ kind: "middle", id: a.id, edge: a.id }, between(view.toPx(a.point), view.toPx(b.point)), 3];
  }
}

function lineAt(board, px, reach) {
  const { drawing, view, step, isSpread } = board;
  /** @type {any} */
  let best = null;
  const consider = (found, a, b) => {
    const away = distance(px, nearestOn(px, view.toPx(a), view.toPx(b)));
    if (away <= reach && (!best || away < best.away)) best = { found, away };
  };
  for (const [index, fold] of drawing.folds.entries()) {
    if (index >= step) consider({ kind: "fold", id: fold.id }, fold.start.point, fold.end.point);
  }
  if (isSpread) for (const [a, b] of edges(drawing)) consider({ kind: "edge", id: a.id, edge: a.id }, a.point, b.point);
  return best?.found ?? null;
}

function clothAt(board, at) {
  return isInside(at, board.rings) ? { kind: "cloth", id: "" } : null;
}

function edges({ outline }) {
  return outline.length < 2 ? [] : outline.map((corner, index) => [corner, outline[(index + 1) % outline.length]]);
}
