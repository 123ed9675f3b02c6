/** Changes to a drawing. Each alters the drawing it is given, which is a copy. */

import { between, boxOf, distance, mirrored, turned } from "./geometry.js";
import { nameFlipped } from "./stroke.js";
import { axisOf, leftOf } from "./symmetry.js";

/** @import { Corner, Drawing, Fold, FoldEnd, FoldKind, Point } from "pleat" */

/** How far inside the table's edge cloth is laid (m). */
const INSIDE_M = 0.05;
/** A corner this near to the axis lies on it (m). */
const ON_AXIS_M = 1e-4;

/** @typedef {Pick<Fold, "id"|"name"|"kind"|"start"|"end"> & Partial<Fold>} NewFold */

/** A name that is not taken yet. @param {string} prefix @param {{id: string}[]} taken */
export function freshId(prefix, taken) {
  const used = new Set(taken.map(({ id }) => id));
  let number = 0;
  while (used.has(`${prefix}${number}`)) number += 1;
  return `${prefix}${number}`;
}

/** @param {Drawing} drawing @param {Map<string, Point>} places where corners shall be, by id */
export function moveCorners(drawing, places) {
  for (const corner of drawing.outline) corner.point = places.get(corner.id) ?? corner.point;
}

/**
 * A corner on an edge, or where it is now if it is there already.
 * @param {Drawing} drawing
 * @param {string} before the corner that the edge starts at
 * @param {string} id
 * @param {Point} point
 */
export function insertCorner(drawing, before, id, point) {
  const known = drawing.outline.find((corner) => corner.id === id);
  if (known) known.point = point;
  if (known) return;
  const index = drawing.outline.findIndex((corner) => corner.id === before);
  if (index >= 0) drawing.outline.splice(index + 1, 0, { id, point });
}

/** @param {Drawing} drawing @param {string[]} ids */
export function removeCorners(drawing, ids) {
  drawing.outline = drawing.outline.filter((corner) => !ids.includes(corner.id));
}

/**
 * Another outline; the folds were of the old one. The new cloth lies at the table's front edge.
 * @param {Drawing} drawing
 * @param {Point[]} points
 */
export function replaceOutline(drawing, points) {
  drawing.outline = points.map((point, index) => ({ id: `v${index}`, point }));
  drawing.folds = [];
  layAtTheFrontEdge(drawing);
}

/** Lay the cloth near the table's front edge, where the arms reach best. @param {Drawing} drawing */
function layAtTheFrontEdge(drawing) {
  const { yaw_rad } = drawing.placement;
  const box = boxOf(drawing.outline.map(({ point }) => turned(point, yaw_rad)));
  if (!box) return;
  const edge = -drawing.scene.table.depth_m / 2 + INSIDE_M;
  drawing.placement = { x_m: edge - box.low[0], y_m: -(box.low[1] + box.high[1]) / 2, yaw_rad };
}

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

/**
 * Make what is right of the garment's axis the mirror image of what is left of it. Images keep the names of the corners
 * in whose place they come, so that folds stay tied to them.
 * @param {Drawing} drawing
 */
export function mirrorOutline(drawing) {
  const axis = axisOfGarment(drawing);
  /** @param {Corner} corner */
  const isLeft = ({ point }) => leftOf(point, axis) >= -ON_AXIS_M;
  const ring = drawing.outline;
  const first = ring.findIndex((corner, index) => isLeft(corner) && !isLeft(ring[(index || ring.length) - 1]));
  /** @type {Corner[]} */
  const half = [];
  for (let n = 0; first >= 0 && n < ring.length; n += 1) {
    const corner = ring[(first + n) % ring.length];
    if (!isLeft(corner)) break;
    half.push(corner);
  }
  if (half.length < 2) return;
  const images = half
    .filter(({ point }) => leftOf(point, axis) > ON_AXIS_M)
    .map(({ point }) => mirrored(point, axis[0], axis[1]))
    .reverse();
  const ids = nearestIds(images, ring.filter((corner) => !half.includes(corner)));
  const outline = [...half];
  images.forEach((point, index) => outline.push({ id: ids.get(index) ?? freshId("v", [...ring, ...outline]), point }));
  drawing.outline = outline;
}

/**
 * For each of some points a corner of its own, the nearest pairs first.
 * @param {Point[]} points
 * @param {Corner[]} corners
 * @returns {Map<number, string>} by point
 */
function nearestIds(points, corners) {
  const pairs = points.flatMap((point, index) =>
    corners.map((corner) => ({ index, id: corner.id, away: distance(point, corner.point) })),
  );
  /** @type {Map<number, string>} */
  const ids = new Map();
  for (const { index, id } of pairs.sort((one, other) => one.away - other.away))
    if (!ids.has(index) && ![...ids.values()].includes(id)) ids.set(index, id);
  return ids;
}

/** Put the partner of each corner where the corner's mirror image is. @param {Drawing} drawing @param {string[]} ids */
export function mirrorCorners(drawing, ids) {
  const places = new Map();
  for (const { id, point } of drawing.outline.filter((corner) => ids.includes(corner.id))) {
    const image = overAxis(drawing, point);
    const others = drawing.outline.filter((corner) => corner.id !== id && !ids.includes(corner.id));
    /** @param {Corner} corner */
    const away = (corner) => Math.hypot(corner.point[0] - image[0], corner.point[1] - image[1]);
    const [first, ...rest] = others;
    const partner = first && rest.reduce((best, corner) => (away(corner) < away(best) ? corner : best), first);
    if (partner) places.set(partner.id, image);
  }
  moveCorners(drawing, places);
}

/** @param {Drawing} drawing */
export const axisOfGarment = ({ outline }) => axisOf(outline.map(({ point }) => point));

/** The middle of the garment's box; it is turned about that. @param {Drawing} drawing @returns {Point} */
export function middleOf(drawing) {
  const box = boxOf(drawing.outline.map(({ point }) => point));
  return box ? between(box.low, box.high) : [0, 0];
}

/** @param {Drawing} drawing @param {Point} point @returns {Point} */
function overAxis(drawing, point) {
  const [a, b] = axisOfGarment(drawing);
  return mirrored(point, a, b);
}

/** @param {string} name */
function otherSide(name) {
  /** @type {Record<string, string>} */
  const swap = { left: "right", right: "left", Left: "Right", Right: "Left" };
  return name.replace(/\b(left|right)\b/i, (word) => swap[word] ?? word);
}
