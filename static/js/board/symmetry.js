/**
 * A garment's own axis of symmetry. A garment that has been pulled out of shape still has most of it: so axes midway
 * between two corners are tried, and the one counts that carries most corners to corners; of several that do, the one
 * over which most of the outline comes to lie on the outline. An upright axis is what people mean by left and right: one
 * that is level, and more so one that slants, has to be better.
 */

import { between, boxOf, cross, distance, edgesOf, left, minus, mirrored, nearestOn, plus, times, unit } from "./geometry.js";

/** @import { Point } from "pleat" */

/** @typedef {[Point, Point]} Axis upwards, or else to the right; what is left of it is the half that is kept */

/** An outline this near to its mirror image is the same, as a part of the garment's size. */
const ALIKE = 0.01;
const CORNERS_MAX = 48;
const SAMPLES = 200;
/** So many axes that carry most corners to corners are looked at closely. */
const CLOSELY = 8;
/**
 * What upright, level and slanting axes are worth, and how many of the corners have to be alike at least, as a share.
 */
const UPRIGHT = { worth: 1, least: 0.4 };
const LEVEL = { worth: 0.9, least: 0.4 };
const SLANTING = { worth: 0.8, least: 0.8 };
/** What the outline counts beside the corners. */
const OUTLINE_WORTH = 0.1;
const STRAIGHT = 1e-3;

let known = {
  key: "",
  axis: /** @type {Axis} */ ([
    [0, 0],
    [0, 1],
  ]),
};

/**
 * The axis of an outline; upright through the middle of its box where it has none.
 * @param {Point[]} ring
 * @returns {Axis}
 */
export function axisOf(ring) {
  const key = String(ring);
  if (key !== known.key) known = { key, axis: found(ring) };
  return known.axis;
}

/** @param {Point[]} ring @returns {Axis} */
function found(ring) {
  const box = boxOf(ring);
  if (!box)
    return [
      [0, 0],
      [0, 1],
    ];
  const middle = between(box.low, box.high);
  const upright = /** @type {Axis} */ ([middle, plus(middle, [0, 1])]);
  const alike = ALIKE * Math.max(...minus(box.high, box.low));
  const corners = spread(ring, CORNERS_MAX);
  const axes = [upright, ...axesBetween(corners)];
  const rough = axes
    .map((axis) => ({ axis, kind: kindOf(axis), share: shareOfCorners(corners, axis, alike) }))
    .filter(({ kind, share }) => share >= kind.least)
    .map(({ axis, kind, share }) => ({ axis, worth: kind.worth * share }))
    .sort((one, other) => other.worth - one.worth);
  const points = along(ring, SAMPLES);
  const fine = rough
    .slice(0, CLOSELY)
    .map(({ axis, worth }) => ({ axis, worth: worth + OUTLINE_WORTH * shareOf(points, ring, axis, alike) }));
  return fine.toSorted((one, other) => other.worth - one.worth)[0]?.axis ?? upright;
}

/** The lines midway between every two corners. @param {Point[]} corners @returns {Axis[]} */
function axesBetween(corners) {
  return corners.flatMap((a, index) =>
    corners.slice(index + 1).flatMap((b) => {
      if (distance(a, b) === 0) return [];
      const middle = between(a, b);
      const way = upwards(unit(left(minus(b, a))));
      return [/** @type {Axis} */ ([middle, plus(middle, way)])];
    }),
  );
}

/** @param {Point} way @returns {Point} */
const upwards = (way) => (way[1] < -STRAIGHT || (way[1] <= STRAIGHT && way[0] < 0) ? times(way, -1) : way);

/** @param {Axis} axis */
function kindOf([a, b]) {
  const [x, y] = unit(minus(b, a));
  if (Math.abs(x) < STRAIGHT) return UPRIGHT;
  return Math.abs(y) < STRAIGHT ? LEVEL : SLANTING;
}

/**
 * How many of the corners an axis carries to corners, as a share.
 * @param {Point[]} corners
 * @param {Axis} axis
 * @param {number} alike how near is the same (m)
 */
function shareOfCorners(corners, [a, b], alike) {
  const images = corners.map((point) => mirrored(point, a, b));
  return images.filter((image) => corners.some((corner) => distance(image, corner) <= alike)).length / corners.length;
}

/**
 * How much of the outline an axis carries to the outline, as a share.
 * @param {Point[]} points
 * @param {Point[]} ring
 * @param {Axis} axis
 * @param {number} alike how near is the same (m)
 */
function shareOf(points, ring, [a, b], alike) {
  const edges = edgesOf(ring);
  const images = points.map((point) => mirrored(point, a, b));
  /** @param {Point} image */
  const isOn = (image) => edges.some(([p, q]) => distance(image, nearestOn(image, p, q)) <= alike);
  return images.filter(isOn).length / points.length;
}

/** At most so many of the corners, all along. @param {Point[]} ring @param {number} most */
function spread(ring, most) {
  const step = Math.max(ring.length / most, 1);
  return Array.from({ length: Math.min(ring.length, most) }, (_, n) => ring[Math.floor(n * step)]);
}

/**
 * Places along the outline, equally far from each other.
 * @param {Point[]} ring
 * @param {number} count
 * @returns {Point[]}
 */
function along(ring, count) {
  const edges = edgesOf(ring);
  const step = edges.reduce((sum, [a, b]) => sum + distance(a, b), 0) / count;
  /** @type {Point[]} */
  const points = [];
  let ahead = step / 2;
  for (const [a, b] of edges) {
    const length = distance(a, b);
    for (; ahead < length; ahead += step) points.push(between(a, b, ahead / length));
    ahead -= length;
  }
  return points;
}

/** How far to the left of an axis a point is (m). @param {Point} point @param {Axis} axis */
export const leftOf = (point, [a, b]) => cross(unit(minus(b, a)), minus(point, a));
