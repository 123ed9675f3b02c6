/** What a stroke across the cloth comes to, as far as the page can say: the line, what moves, and where it lands. */

import {
  between,
  chordAlong,
  cross,
  crossings,
  distance,
  edgesOf,
  isInside,
  left,
  leftPart,
  minus,
  mirrored,
  nearestOnRings,
  plus,
} from "./geometry.js";
import { LEAST_CORNERS, MOST_CORNERS, SAME_CORNER_M, SIDES } from "./rules.js";

/** @import { Fold, Point } from "pleat" */

/** Parts that differ by less than this share of the cloth are alike, and less than this is no part. */
const ALIKE = 0.01;

/**
 * The fold's line as it was drawn, over which the smaller part moves, or the crease that takes a point to where it was
 * dropped.
 * @param {{isGrab: boolean, from: Point, to: Point}} stroke
 * @param {Point[][]} rings the cloth
 * @param {boolean} isFlipped
 * @returns {[Point, Point]} what lies to its left moves
 */
export function lineOf({ isGrab, from, to }, rings, isFlipped) {
  const [a, b] = isGrab ? crease(from, to, rings) : smallerLeft(from, to, rings);
  return isFlipped ? [b, a] : [a, b];
}

/**
 * A line so directed that the smaller part of the cloth is on its left; as it was drawn where both are alike.
 * @param {Point} a
 * @param {Point} b
 * @param {Point[][]} rings
 * @returns {[Point, Point]}
 */
function smallerLeft(a, b, rings) {
  const share = areaOf(rings.map((ring) => leftPart(ring, a, b))) / areaOf(rings);
  return share > 0.5 + ALIKE && share < 1 - ALIKE ? [b, a] : [a, b];
}

/** @param {Point[][]} rings holes run the other way round */
const areaOf = (rings) => Math.abs(rings.flatMap(edgesOf).reduce((sum, [p, q]) => sum + cross(p, q) / 2, 0));

/**
 * The bisector, as far as it runs through the cloth; the point that was grabbed is on its left.
 * @param {Point} from
 * @param {Point} to
 * @param {Point[][]} rings
 * @returns {[Point, Point]}
 */
function crease(from, to, rings) {
  const middle = between(from, to);
  const along = left(minus(to, from));
  const ends = [minus(middle, along), plus(middle, along)];
  const [a, b] = chordAlong(ends[0], ends[1], rings) ?? ends;
  return cross(minus(b, a), minus(from, a)) < 0 ? [b, a] : [a, b];
}

/**
 * Whether a stroke touches the cloth, or one of its ends is as near.
 * @param {{from: Point, to: Point}} stroke
 * @param {Point[][]} rings the cloth
 * @param {number} near (m)
 */
export function reachesCloth({ from, to }, rings, near) {
  /** @param {Point} p */
  const isNear = (p) => isInside(p, rings) || distance(p, nearestOnRings(p, rings) ?? p) <= near;
  return crossings(from, to, rings).some((t) => t >= 0 && t <= 1) || isNear(from) || isNear(to);
}

/** @param {[Point, Point]} line @param {Point[][]} rings */
export function ghostOf([a, b], rings) {
  const moving = rings.map((ring) => leftPart(ring, a, b)).filter((ring) => ring.length > 2);
  return { moving, landed: moving.map((ring) => ring.map((point) => mirrored(point, a, b))) };
}

const GIVEN = new RegExp(`^(${Object.values(SIDES).join("|")})( \\d+)?$`);

/**
 * What a fold is called once its other side moves: a name that tells the side goes along, any other stays.
 * @param {Fold} fold
 * @param {Fold[]} others
 */
export function nameFlipped({ name, start, end }, others) {
  return GIVEN.test(name) ? nameOf(end.point, start.point, others) : name;
}

/**
 * What a fold is called at first: from where the cloth comes, and a number if another is called so.
 * @param {Point} start
 * @param {Point} end
 * @param {{name: string}[]} folds those that there are
 */
export function nameOf(start, end, folds) {
  const [x, y] = minus(end, start);
  const [upright, level] = [y > 0 ? SIDES.along_y : SIDES.against_y, x > 0 ? SIDES.along_x : SIDES.against_x];
  const name = Math.abs(x) > Math.abs(y) ? level : upright;
  const names = folds.map((fold) => fold.name);
  for (let number = 1; ; number += 1) {
    const numbered = number > 1 ? `${name} ${number}` : name;
    if (!names.includes(numbered)) return numbered;
  }
}

/**
 * What becomes of an unfinished outline where its next corner is put: at its first corner or, as with a double click,
 * at its last it closes.
 * @param {Point[]} points its corners so far
 * @param {Point} next
 * @returns {"put"|"close"|"taken"|"full"}
 */
export function nextCorner(points, next) {
  const ends = points.length < LEAST_CORNERS ? [] : [points[0], points[points.length - 1]];
  /** @param {Point} corner */
  const isThere = (corner) => distance(corner, next) < SAME_CORNER_M;
  if (ends.some(isThere)) return "close";
  if (points.some(isThere)) return "taken";
  return points.length < MOST_CORNERS ? "put" : "full";
}
