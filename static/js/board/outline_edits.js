/** Changes to the outline of a drawing. Each alters the drawing it is given, which is a copy. */

import { arcThrough, bend, curveThrough, edgeFrom, parted, ringOf, withCurve } from "./curves.js";
import { between, boxOf, distance, turned } from "./geometry.js";
import { guessedTitle } from "./guessed_title.js";
import { UNTITLED } from "./rules.js";

/** @import { Drawing, Point } from "pleat" */

/** How far inside the table's edge cloth is laid (m). */
const INSIDE_M = 0.05;
/** A notch is as wide as a neck (m), but at most this part of its edge, and this deep for its width. */
const NOTCH_M = 0.2;
const NOTCH_SHARE = 0.4;
const NOTCH_DEPTH = 0.4;

/** @param {Drawing} drawing @param {Map<string, Point>} places where corners shall be, by id */
export function moveCorners(drawing, places) {
  for (const corner of drawing.outline) corner.point = places.get(corner.id) ?? corner.point;
}

/**
 * A corner on an edge, or where it is now if it is there already. A curve is parted into two of the same form.
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
  if (index < 0) return;
  const corner = drawing.outline[index];
  const halves = parted(corner, drawing.outline[(index + 1) % drawing.outline.length], point);
  bend(corner, halves.before);
  drawing.outline.splice(index + 1, 0, withCurve(id, halves.at, halves.after));
}

/**
 * Take corners away. Between two curves an arc through the place stays, so that an arc parted by a corner is whole again.
 * @param {Drawing} drawing
 * @param {string[]} ids
 */
export function removeCorners(drawing, ids) {
  for (const id of ids) {
    const { outline } = drawing;
    const index = outline.findIndex((corner) => corner.id === id);
    if (index < 0) continue;
    const [before, gone, after] = [-1, 0, 1].map((step) => outline[(index + step + outline.length) % outline.length]);
    const isCurved = before.curve && gone.curve;
    bend(before, isCurved ? arcThrough(before.point, gone.point, after.point) : null);
    outline.splice(index, 1);
  }
}

/**
 * Bend an edge so that its middle is at a point; straighten it where that is on the chord.
 * @param {Drawing} drawing
 * @param {string} id the corner's that the edge starts at
 * @param {Point} handle
 */
export function bendEdge(drawing, id, handle) {
  const [a, b] = edgeFrom(drawing, id) ?? [];
  if (a && b) bend(a, curveThrough(a.point, b.point, handle));
}

/** @param {Drawing} drawing @param {string[]} ids of the corners at which the edges start */
export function straightenEdges(drawing, ids) {
  for (const corner of drawing.outline) if (ids.includes(corner.id)) bend(corner, null);
}

/**
 * Cut a round notch out of the middle of an edge, as for a neck.
 * @param {Drawing} drawing
 * @param {string} id the corner's that the edge starts at
 * @param {[string, string]} made the notch's corners
 * @param {boolean} isInsideLeft whether the cloth is left of the edge
 */
export function cutNotch(drawing, id, made, isInsideLeft) {
  const [a, b] = edgeFrom(drawing, id) ?? [];
  if (!a || !b) return;
  const share = Math.min(NOTCH_M / distance(a.point, b.point), NOTCH_SHARE) / 2;
  const [from, to] = [0.5 - share, 0.5 + share].map((part) => between(a.point, b.point, part));
  const curve = { along: 0, across: isInsideLeft ? NOTCH_DEPTH : -NOTCH_DEPTH };
  bend(a, null);
  drawing.outline.splice(drawing.outline.indexOf(a) + 1, 0, withCurve(made[0], from, curve), withCurve(made[1], to, null));
}

/**
 * Another outline; the folds were of the old one. The new cloth lies at the table's front edge.
 * @param {Drawing} drawing
 * @param {Point[]} points
 */
export function replaceOutline(drawing, points) {
  drawing.outline = points.map((point, index) => ({ id: `v${index}`, point }));
  drawing.folds = [];
  if (drawing.title === UNTITLED) drawing.title = guessedTitle(points) || UNTITLED;
  layAtTheFrontEdge(drawing);
}

/** Lay the cloth near the table's front edge, where the arms reach best. @param {Drawing} drawing */
function layAtTheFrontEdge(drawing) {
  const { yaw_rad } = drawing.placement;
  const box = boxOf(ringOf(drawing).map((point) => turned(point, yaw_rad)));
  if (!box) return;
  const edge = -drawing.scene.table.depth_m / 2 + INSIDE_M;
  drawing.placement = { x_m: edge - box.low[0], y_m: -(box.low[1] + box.high[1]) / 2, yaw_rad };
}
