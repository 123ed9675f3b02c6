/**
 * What a garment is called that somebody has just drawn: what its outline looks like. It has no name where that is not
 * sure: a wrong one is worse than none. Up on the board is up on the garment.
 */

import { inEnglish } from "../language/say.js";
import { boxOf, cross, edgesOf, minus } from "./geometry.js";

/** @import { Point } from "pleat" */

/** From so many times as long as wide it is a scarf; from so many corners, none of them inwards, it is round. */
const LONG = 4;
const ROUND = 10;
/** How far a rectangle or a disc may be from one: the share of its box that it fills, and the ratio of its sides. */
const OFF = 0.05;
/** How near to its place a corner or a width is (shares of the garment). */
const NEAR = 0.1;
/** How deep a crotch is at least, and a neck at most (shares of the garment's length). */
const DEEP = 0.35;
/** How high the armpits of a T-shirt are at least, and how long its sleeves are at most (shares of length and body). */
const ARMPIT = 0.58;
const SLEEVE = 0.6;

/** A title in English, as titles are stored; empty where it looks like nothing known. @param {Point[]} ring */
export function guessedTitle(ring) {
  const box = boxOf(ring);
  if (!box) return "";
  const [wide, long] = minus(box.high, box.low);
  /** @type {Point[]} from 0 to 1 along each axis */
  const shares = ring.map(([x, y]) => [(x - box.low[0]) / wide, (y - box.low[1]) / long]);
  const area = edgesOf(shares).reduce((sum, [p, q]) => sum + cross(p, q) / 2, 0);
  const inward = shares.flatMap((corner, index) => {
    const [before, after] = [shares.at(index - 1) ?? corner, shares[(index + 1) % shares.length]];
    const isInward = area * cross(minus(corner, before), minus(after, corner)) < 0;
    return isInward ? [{ corner, isOverBoth: corner[1] > Math.max(before[1], after[1]) }] : [];
  });
  if (!inward.length) return convex(Math.abs(area), ring.length, Math.max(wide, long) / Math.min(wide, long));
  const isCentral = (/** @type {Point} */ [x]) => Math.abs(x - 0.5) < NEAR;
  if (inward.length === 1 && isCentral(inward[0].corner)) {
    const [{ corner, isOverBoth }] = inward;
    if (isOverBoth) return corner[1] > DEEP ? inEnglish("name.trousers") : "";
    const isNarrow = shares.every(([x, y]) => y < 1 - NEAR || Math.abs(x - 0.5) < 0.5 - NEAR / 2); // at the straps
    return corner[1] >= 1 - DEEP && isNarrow ? inEnglish("name.vest") : "";
  }
  const [one, other, neck] = inward.map(({ corner }) => corner).sort((a, b) => a[1] - b[1]);
  const isCut = neck && !(isCentral(neck) && neck[1] > 1 - DEEP);
  return inward.length < 4 && !isCut && other && isShirt(one, other, shares) ? inEnglish("name.t_shirt") : "";
}

/** @param {number} filled share of its box @param {number} corners @param {number} ratio of its sides */
function convex(filled, corners, ratio) {
  if (filled > 1 - OFF) return inEnglish(ratio > LONG ? "name.scarf" : "name.towel");
  const isRound = corners >= ROUND && Math.abs(filled - Math.PI / 4) < OFF && ratio < 1 + OFF;
  return isRound ? inEnglish("name.round") : "";
}

/** Whether two corners are armpits: level, mirrored, short sleeves over them, a straight body below. @param {Point} one @param {Point} other @param {Point[]} shares */
function isShirt(one, other, shares) {
  const [left, right] = [one, other].sort((a, b) => a[0] - b[0]);
  const body = right[0] - left[0];
  const isMirrored = Math.abs(left[0] + right[0] - 1) < NEAR && Math.abs(left[1] - right[1]) < NEAR;
  const low = Math.min(left[1], right[1]);
  const isStraight = shares.every(([x, y]) => y > low - NEAR || (x > left[0] - NEAR && x < right[0] + NEAR));
  return isMirrored && isStraight && low > ARMPIT && body > 0 && left[0] <= SLEEVE * body;
}
