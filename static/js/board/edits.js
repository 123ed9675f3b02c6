/** Changes to the folds of a drawing. Each alters the drawing it is given, which is a copy. */

import { ringOf } from "./curves.js";
import { between, boxOf } from "./geometry.js";
import { freshId } from "./ids.js";
import { overAxis } from "./mirror.js";
import { nameFlipped } from "./stroke.js";

/** @import { Drawing, Fold, FoldEnd, FoldKind, Point } from "pleat" */

/** @typedef {Pick<Fold, "id"|"name"|"kind"|"start"|"end"> & Partial<Fold>} NewFold */

/** @param {Drawing} drawing @param {number} index in the order @param {NewFold} fold */
export function insertFold(drawing, index, fold) {
  drawing.folds.splice(index, 0, { grip_radius_m: null, twin: null, ...fold });
}

/** @param {Drawing} drawing @param {string[]} ids */
export function removeFolds(drawing, ids) {
  drawing.folds = drawing.folds.filter((fold) => !ids.includes(fold.id));
  for (const fold of drawing.folds) if (fold.twin !== null && ids.includes(fold.twin)) fold.twin = null;
}

/**
 * Give a fold other ends, and its twin the mirrored ones.
 * @param {Drawing} drawing
 * @param {string} id
 * @param {{start?: FoldEnd, end?: FoldEnd}} ends
 */
export function moveFold(drawing, id, ends) {
  const fold = drawing.folds.find((other) => other.id === id);
  if (!fold) return;
  Object.assign(fold, ends);
  const twin = drawing.folds.find((other) => other.id === fold.twin);
  if (!twin) return;
  if (ends.start) twin.end = { point: overAxis(drawing, ends.start.point), on: null };
  if (ends.end) twin.start = { point: overAxis(drawing, ends.end.point), on: null };
}

/** The other side moves. @param {Drawing} drawing @param {string[]} ids */
export function flipFolds(drawing, ids) {
  for (const fold of drawing.folds.filter(({ id }) => ids.includes(id))) {
    fold.name = nameFlipped(fold, drawing.folds.filter((other) => other !== fold));
    [fold.start, fold.end] = [fold.end, fold.start];
  }
}

/** @param {Drawing} drawing @param {string[]} ids @param {FoldKind} kind */
export function paintFolds(drawing, ids, kind) {
  for (const fold of drawing.folds) if (ids.includes(fold.id)) fold.kind = kind;
}

/**
 * A twin on the other side for each fold, next to it in the order and linked.
 * @param {Drawing} drawing
 * @param {string[]} ids
 */
export function mirrorFolds(drawing, ids) {
  for (const id of ids) {
    const index = drawing.folds.findIndex((fold) => fold.id === id);
    const fold = drawing.folds[index];
    if (!fold || fold.twin) continue;
    const twin = freshId("f", drawing.folds);
    fold.twin = twin;
    insertFold(drawing, index + 1, {
      ...fold,
      id: twin,
      name: otherSide(fold.name),
      start: { point: overAxis(drawing, fold.end.point), on: null },
      end: { point: overAxis(drawing, fold.start.point), on: null },
      twin: id,
    });
  }
}

/** The middle of the garment's box; it is turned about that. @param {Drawing} drawing @returns {Point} */
export function middleOf(drawing) {
  const box = boxOf(ringOf(drawing));
  return box ? between(box.low, box.high) : [0, 0];
}

/** @param {string} name */
function otherSide(name) {
  /** @type {Record<string, string>} */
  const swap = { left: "right", right: "left", Left: "Right", Right: "Left" };
  return name.replace(/\b(left|right)\b/i, (word) => swap[word] ?? word);
}
