/** Points, segments and rings in the plane. A ring is a list of points, the first not repeated. */

/** @import { Point, Pose } from "pleat" */

/** @param {Point} a @param {Point} b @returns {Point} */
export const plus = (a, b) => [a[0] + b[0], a[1] + b[1]];

/** @param {Point} a @param {Point} b @returns {Point} */
export const minus = (a, b) => [a[0] - b[0], a[1] - b[1]];

/** @param {Point} a @param {number} k @returns {Point} */
export const times = (a, k) => [a[0] * k, a[1] * k];

/** @param {Point} a @param {Point} b */
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1];

/** Positive if b turns left of a. @param {Point} a @param {Point} b */
export const cross = (a, b) => a[0] * b[1] - a[1] * b[0];

/** @param {Point} a @param {Point} b */
export const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);

/** @param {Point} a @param {Point} b @param {number} t @returns {Point} */
export const between = (a, b, t = 0.5) => [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t];

/** The direction of a as a unit vector; of nothing, along x. @param {Point} a @returns {Point} */
export function unit(a) {
  const length = Math.hypot(...a);
  return length ? times(a, 1 / length) : [1, 0];
}

/** A quarter turn to the left. @param {Point} a @returns {Point} */
export const left = (a) => [-a[1], a[0]];

/** @param {Point} a @param {number} angle_rad @returns {Point} */
export const turned = ([x, y], angle_rad) => {
  const [cos, sin] = [Math.cos(angle_rad), Math.sin(angle_rad)];
  return [x * cos - y * sin, x * sin + y * cos];
};

/** How far along a -> b the point's foot is, kept within 0..1. @param {Point} p @param {Point} a @param {Point} b */
export function fractionAlong(p, a, b) {
  const along = minus(b, a);
  const square = dot(along, along);
  return square ? Math.min(Math.max(dot(minus(p, a), along) / square, 0), 1) : 0;
}

/** @param {Point} p @param {Point} a @param {Point} b @returns {Point} */
export const nearestOn = (p, a, b) => between(a, b, fractionAlong(p, a, b));

/** @param {Point} p mirrored over the line a -> b @param {Point} a @param {Point} b @returns {Point} */
export function mirrored(p, a, b) {
  const along = minus(b, a);
  const square = dot(along, along);
  const foot = square ? plus(a, times(along, dot(minus(p, a), along) / square)) : a;
  return minus(times(foot, 2), p);
}

/** The ring's edges. @param {Point[]} ring @returns {[Point, Point][]} */
export const edgesOf = (ring) => ring.map((point, index) => [point, ring[(index + 1) % ring.length]]);

/** How long a line from point to point is. @param {Point[]} points */
export const lengthOf = (points) =>
  points.slice(1).reduce((sum, point, index) => sum + distance(points[index], point), 0);

/** What of a ring is left of a -> b. @param {Point[]} ring @param {Point} a @param {Point} b @returns {Point[]} */
export function leftPart(ring, a, b) {
  /** @param {Point} p */
  const side = (p) => cross(minus(b, a), minus(p, a));
  return edgesOf(ring).flatMap(([p, q]) => {
    const [before, after] = [side(p), side(q)];
    const kept = before >= 0 ? [p] : [];
    if (before * after < 0) kept.push(between(p, q, before / (before - after)));
    return kept;
  });
}

/** @param {Point} p @param {Point[][]} rings even-odd */
export function isInside(p, rings) {
  let isIn = false;
  for (const [a, b] of rings.flatMap(edgesOf)) {
    if (a[1] > p[1] !== b[1] > p[1] && p[0] < a[0] + ((p[1] - a[1]) * (b[0] - a[0])) / (b[1] - a[1])) isIn = !isIn;
  }
  return isIn;
}

/** The place on the rings' edges that is nearest. @param {Point} p @param {Point[][]} rings @returns {Point|null} */
export const nearestOnRings = (p, rings) => nearestOnEdges(p, rings.flatMap(edgesOf));

/** The place on a line from point to point that is nearest. @param {Point} p @param {Point[]} points @returns {Point|null} */
export const nearestOnLine = (p, points) => nearestOnEdges(p, edgesOf(points).slice(0, -1));

/** @param {Point} p @param {[Point, Point][]} edges */
function nearestOnEdges(p, edges) {
  /** @type {Point|null} */
  let best = null;
  for (const [a, b] of edges) {
    const here = nearestOn(p, a, b);
    if (!best || distance(p, here) < distance(p, best)) best = here;
  }
  return best;
}

/**
 * Where the line through a and b meets the rings: how far along, in lengths of a -> b, in order.
 * @param {Point} a
 * @param {Point} b
 * @param {Point[][]} rings
 */
export function crossings(a, b, rings) {
  const along = minus(b, a);
  const found = [];
  for (const [p, q] of rings.flatMap(edgesOf)) {
    const [before, after] = [cross(along, minus(p, a)), cross(along, minus(q, a))];
    if (before === after || before * after > 0) continue;
    const met = between(p, q, before / (before - after));
    found.push(dot(minus(met, a), along) / dot(along, along));
  }
  return found.sort((s, t) => s - t);
}

/**
 * The chord of the rings on the line through a and b that lies about the middle of both; null without one.
 * @param {Point} a
 * @param {Point} b
 * @param {Point[][]} rings
 * @returns {[Point, Point]|null}
 */
export function chordAlong(a, b, rings) {
  const at = crossings(a, b, rings);
  /** @param {number} t */
  const point = (t) => plus(a, times(minus(b, a), t));
  /** @type {{away: number, ends: [Point, Point]}|null} */
  let best = null;
  for (let index = 0; index + 1 < at.length; index += 1) {
    const middle = (at[index] + at[index + 1]) / 2;
    if (at[index + 1] - at[index] < 1e-6 || !isInside(point(middle), rings)) continue;
    const away = Math.max(at[index] - 0.5, 0.5 - at[index + 1], 0);
    if (!best || away < best.away) best = { away, ends: [point(at[index]), point(at[index + 1])] };
  }
  return best && best.ends;
}

/** @param {Point[]} points @returns {{low: Point, high: Point}|null} */
export function boxOf(points) {
  if (!points.length) return null;
  const [xs, ys] = [points.map((p) => p[0]), points.map((p) => p[1])];
  return { low: [Math.min(...xs), Math.min(...ys)], high: [Math.max(...xs), Math.max(...ys)] };
}

/** A pose's inner point in its outer frame. @param {Pose} pose @param {Point} p */
export const toOuter = (pose, p) => plus(turned(p, pose.yaw_rad), [pose.x_m, pose.y_m]);

/** The way back. @param {Pose} pose @param {Point} p */
export const toInner = (pose, p) => turned(minus(p, [pose.x_m, pose.y_m]), -pose.yaw_rad);

/** The corners of a rectangle round the origin, counter-clockwise. @param {number} x half its width @param {number} y half its height @returns {Point[]} */
export const cornersWithin = (x, y) => [[-x, -y], [x, -y], [x, y], [-x, y]];
