/**
 * Curved edges: an arc through both corners and a handle, and the points that stand for it, as in `app/drawing/curve.py`,
 * against which tests hold it. The server is not asked, so that a curve follows the hand.
 */

import { between, cross, distance, dot, left, minus, plus, times } from "./geometry.js";
import { CURVE_MAX, CURVE_TOLERANCE_M, MOST_CORNERS, SAME_CORNER_M } from "./rules.js";

/** @import { Corner, Curve, Drawing, Point } from "pleat" */

const STRAIGHT_RAD = 1e-4;
/** A curve flatter than this is a straight edge (chord lengths). */
const FLAT = 1e-4;

/** @typedef {{middle: Point, along: Point, across: Point, half: number}} Ellipse from -half to half (rad) */

/** @param {Curve} curve @param {Point} a @param {Point} b @returns {Ellipse} */
function ellipseOf(curve, a, b) {
  const chord = minus(b, a);
  const half = Math.max(2 * Math.atan(2 * Math.abs(curve.across)), STRAIGHT_RAD);
  const rise = plus(times(chord, curve.along), times(left(chord), curve.across));
  return {
    middle: between(a, b),
    along: times(chord, 1 / (2 * Math.sin(half))),
    across: times(rise, 1 / (1 - Math.cos(half))),
    half,
  };
}

/** @param {Ellipse} ellipse @param {number} turn from the handle (rad) @returns {Point} */
const at = ({ middle, along, across, half }, turn) =>
  plus(middle, plus(times(along, Math.sin(turn)), times(across, Math.cos(turn) - Math.cos(half))));

/** The ellipse's major radius. @param {Ellipse} ellipse */
function major({ along, across }) {
  const [a, b, c] = [dot(along, along), dot(across, across), dot(along, across)];
  return Math.sqrt((a + b) / 2 + Math.hypot((a - b) / 2, c));
}

/**
 * The points between two corners.
 * @param {Curve} curve
 * @param {Point} a
 * @param {Point} b
 * @param {number} tolerance (m)
 * @returns {Point[]}
 */
export function curvePoints(curve, a, b, tolerance = CURVE_TOLERANCE_M) {
  const ellipse = ellipseOf(curve, a, b);
  const count = 2 * Math.max(Math.ceil((ellipse.half * Math.sqrt(major(ellipse) / (2 * tolerance))) / 2), 1);
  /** @type {Point[]} */
  const kept = [];
  for (let n = 1; n < count; n += 1) {
    const point = at(ellipse, ellipse.half * ((2 * n) / count - 1));
    const isFar = distance(point, kept.at(-1) ?? a) >= 2 * SAME_CORNER_M && distance(point, b) >= 2 * SAME_CORNER_M;
    if (isFar) kept.push(point);
  }
  return kept;
}

/** The edges of an outline, each by the corner that it starts at. @param {Corner[]} outline @returns {[Corner, Corner][]} */
export const outlineEdges = (outline) =>
  outline.length < 2 ? [] : outline.map((corner, index) => [corner, outline[(index + 1) % outline.length]]);

/** The edge that starts at a corner. @param {Pick<Drawing, "outline">} drawing @param {string} id */
export const edgeFrom = ({ outline }, id) => outlineEdges(outline).find(([corner]) => corner.id === id);

/** A corner whose edge is curved, or not. @param {string} id @param {Point} point @param {Curve|null|undefined} curve @returns {Corner} */
export const withCurve = (id, point, curve) => (curve ? { id, point, curve } : { id, point });

/** An edge's points from corner to corner. @param {Corner} a @param {Corner} b @param {number} [tolerance] (m) */
export function edgePoints(a, b, tolerance) {
  const isCurved = a.curve && distance(a.point, b.point) > 0;
  return [a.point, ...(isCurved && a.curve ? curvePoints(a.curve, a.point, b.point, tolerance) : []), b.point];
}

/** The polygon that stands for an outline. @param {Pick<Drawing, "outline">} drawing @returns {Point[]} */
export function ringOf({ outline }) {
  if (!outline.some(({ curve }) => curve)) return outline.map(({ point }) => point);
  /** @param {number} tolerance @returns {Point[]} */
  const points = (tolerance) => outlineEdges(outline).flatMap(([a, b]) => edgePoints(a, b, tolerance).slice(0, -1));
  let tolerance = CURVE_TOLERANCE_M;
  let ring = points(tolerance);
  while (ring.length > MOST_CORNERS && tolerance < 1) ring = points((tolerance *= 2));
  return ring;
}

/** Where an edge is taken hold of to bend it. @param {Corner} a @param {Corner} b @returns {Point} */
export function handleOf({ point, curve }, { point: end }) {
  const chord = minus(end, point);
  const off = curve ? plus(times(chord, curve.along), times(left(chord), curve.across)) : /** @type {Point} */ ([0, 0]);
  return plus(between(point, end), off);
}

/**
 * The curve that has its handle at a point; null where that is straight.
 * @param {Point} a
 * @param {Point} b
 * @param {Point} handle
 * @returns {Curve|null}
 */
export function curveThrough(a, b, handle) {
  const chord = minus(b, a);
  const square = dot(chord, chord);
  if (!square) return null;
  const off = minus(handle, between(a, b));
  const across = within(cross(chord, off) / square);
  return Math.abs(across) < FLAT ? null : { along: within(dot(off, chord) / square), across };
}

/** @param {number} part */
const within = (part) => Math.min(Math.max(part, -CURVE_MAX), CURVE_MAX);

/**
 * The same curve for an edge the other way, for the edge's image in a mirror, for that image the other way.
 * @type {Record<"turned"|"mirrored"|"opposite", (curve: Curve|null|undefined) => Curve|null>}
 */
export const as = {
  turned: (curve) => (curve ? { along: -curve.along, across: -curve.across } : null),
  mirrored: (curve) => (curve ? { along: curve.along, across: -curve.across } : null),
  opposite: (curve) => (curve ? { along: -curve.along, across: curve.across } : null),
};

/** Give the edge that starts at a corner another curve. @param {Corner} corner @param {Curve|null} curve */
export function bend(corner, curve) {
  if (curve) corner.curve = curve;
  else delete corner.curve;
}

/**
 * Part an edge's curve at the place nearest to a point.
 * @param {Corner} a
 * @param {Corner} b
 * @param {Point} near
 * @returns {{at: Point, before: Curve|null, after: Curve|null}}
 */
export function parted(a, b, near) {
  if (!a.curve) return { at: near, before: null, after: null };
  const ellipse = ellipseOf(a.curve, a.point, b.point);
  const turn = nearestTurn(ellipse, near);
  const place = at(ellipse, turn);
  return {
    at: place,
    before: curveThrough(a.point, place, at(ellipse, (turn - ellipse.half) / 2)),
    after: curveThrough(place, b.point, at(ellipse, (turn + ellipse.half) / 2)),
  };
}

/** @param {Ellipse} ellipse @param {Point} near */
function nearestTurn(ellipse, near) {
  const count = 400;
  let best = 0;
  for (let n = 1 - count; n < count; n += 1) {
    const turn = (ellipse.half * n) / count;
    if (distance(at(ellipse, turn), near) < distance(at(ellipse, best), near)) best = turn;
  }
  return best;
}

/**
 * The arc from corner to corner that leads through a point between them; null where that is straight.
 * @param {Point} a
 * @param {Point} through
 * @param {Point} b
 * @returns {Curve|null}
 */
export function arcThrough(a, through, b) {
  const [to, on] = [minus(through, a), minus(b, through)];
  const bow = Math.atan2(cross(to, on), dot(to, on)); // half the arc's angle, left turns positive
  const across = within(-Math.tan(bow / 2) / 2);
  return Math.abs(across) < FLAT ? null : { along: 0, across };
}
