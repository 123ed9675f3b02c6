/**
 * Folds that lay one edge on another: over the bisector of the edges' lines, for parallel ones over the line midway.
 * Two lines have two bisectors; only one over which a part of the first edge comes to lie on the second is meant.
 */

import { chordAlong, cross, distance, dot, edgesOf, left, minus, mirrored, nearestOn, plus, times, unit } from "./geometry.js";

/** @import { Point } from "pleat" */

/** @typedef {[Point, Point]} Line */
/**
 * Where a stroke ends that makes such a fold, and the edge that is laid on.
 * @typedef {{at: Point, on: Line|null}} Laid
 */

/** What is shorter is nothing (m). */
const LEAST_M = 0.002;
/** A line this near to a point goes through it (m). */
const THROUGH_M = 1e-5;
/** Of more edges than this not every two are looked at. */
const EDGES_MAX = 60;

/**
 * The line over which an edge is laid on another, through two points; null without one.
 * @param {Line} edge
 * @param {Line} onto
 */
export function layingOnto(edge, onto) {
  const overlaps = bisectors(edge, onto).map((line) => ({ line, overlap: overlap(edge, onto, line) }));
  const [best] = overlaps.toSorted((one, other) => other.overlap - one.overlap);
  return best && best.overlap > LEAST_M ? best.line : null;
}

/** @param {Line} first @param {Line} second @returns {Line[]} */
function bisectors([a, b], [c, d]) {
  const [along, other] = [unit(minus(b, a)), unit(minus(d, c))];
  const turn = cross(along, other);
  const apart = cross(along, minus(c, a));
  if (Math.abs(turn) * Math.max(distance(a, b), distance(c, d)) < THROUGH_M) {
    const start = plus(a, times(left(along), apart / 2));
    return Math.abs(apart) < LEAST_M ? [] : [[start, plus(start, along)]];
  }
  const corner = plus(a, times(along, cross(minus(c, a), other) / turn));
  return [plus(along, other), minus(along, other)].map((way) => [corner, plus(corner, unit(way))]);
}

/**
 * How much of an edge, folded over a line, lies beside another (m).
 * @param {Line} edge
 * @param {Line} onto
 * @param {Line} fold
 */
function overlap(edge, [c, d], [p, q]) {
  const along = unit(minus(d, c));
  const [s, t] = edge.map((point) => dot(minus(mirrored(point, p, q), c), along)).sort((one, other) => one - other);
  return Math.min(t, distance(c, d)) - Math.max(s, 0);
}

/**
 * The edge nearest to a point, if it is within reach.
 * @param {Point} p
 * @param {Point[][]} rings
 * @param {number} reach_m
 */
export function edgeNear(p, rings, reach_m) {
  /** @type {{edge: Line, away: number}|null} */
  let best = null;
  for (const edge of rings.flatMap(edgesOf)) {
    const away = distance(p, nearestOn(p, edge[0], edge[1]));
    if (away <= reach_m && (!best || away < best.away)) best = { edge, away };
  }
  return best?.edge ?? null;
}

/**
 * Where a point that was grabbed beside an edge has to be dropped to lay that edge on each of the others.
 * @param {Point} from
 * @param {Line} edge
 * @param {Point[][]} rings
 * @returns {Laid[]}
 */
export function dropsOnto(from, edge, rings) {
  return rings.flatMap(edgesOf).flatMap((onto) => {
    const line = isSame(edge, onto) ? null : layingOnto(edge, onto);
    const at = line && mirrored(from, line[0], line[1]);
    return at && distance(from, at) > LEAST_M ? [{ at, on: onto }] : [];
  });
}

/**
 * Where a crease that begins at a point has to end to lay an edge on another.
 * @param {Point} from
 * @param {Point[][]} rings
 * @returns {Laid[]}
 */
export function endsOnto(from, rings) {
  const edges = rings.flatMap(edgesOf);
  if (edges.length > EDGES_MAX) return [];
  return edges.flatMap((edge, index) =>
    edges.slice(index + 1).flatMap((onto) => {
      const line = layingOnto(edge, onto);
      if (!line || !goesThrough(line, from)) return [];
      const at = chordAlong(line[0], line[1], rings)?.find((end) => distance(end, from) > LEAST_M);
      return at ? [{ at, on: null }] : [];
    }),
  );
}

/** @param {Line} one @param {Line} other */
const isSame = ([a, b], [c, d]) => a === c && b === d;

/** @param {Line} line @param {Point} point */
const goesThrough = ([p, q], point) => Math.abs(cross(unit(minus(q, p)), minus(point, p))) < THROUGH_M;
