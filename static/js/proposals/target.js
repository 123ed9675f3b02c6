/** The size that a garment is to be folded to: a name, or two sides. The sizes of names are the server's. */

import { ringOf } from "../board/curves.js";
import { boxOf } from "../board/geometry.js";

/** @import { Drawing, Point } from "pleat" */

/** Sides along the board's axes (m). */
export const SIZES_M = {"shelf": [0.25, 0.3], "drawer": [0.2, 0.25], "suitcase": [0.3, 0.4]};

/** Sides as shares of the garment's. */
export const SHARES = {"halves": [0.5, 0.5], "thirds": [0.3333333333333333, 0.3333333333333333]};

/** To hang over a bar: at most so wide (m), and a share of the garment's longer side long. */
export const HUNG = {"hanger": [0.4, 0.5]};

/** The shortest and the longest side (m). */
export const SIDES_M = [0.01, 10.0];

/** How much longer than a target's side a packet's may be (m). */
export const TOLERANCE_M = 0.01;

/** The smallest that there is, and rolled up: names without a size. */
const SMALLEST = "smallest";
const ROLL = "roll";

/** @typedef {keyof typeof SIZES_M | keyof typeof HUNG | keyof typeof SHARES | typeof ROLL | typeof SMALLEST} PresetName */
/** @typedef {{like: import("pleat").Garment|string}} Like a garment that is folded as this one is to be */
/** @typedef {PresetName|Point|Like} Target two sides are along the board's axes (m) */

/** @param {Target} to @returns {to is Like} */
export const isLike = (to) => typeof to === "object" && "like" in to;

export const PRESETS = /** @type {PresetName[]} */ (
  [...[SIZES_M, HUNG, SHARES].flatMap((known) => Object.keys(known)), ROLL, SMALLEST]
);

/**
 * The sides that are meant (m); null for names without a size, and for those of another garment.
 * @param {Target} to
 * @param {Drawing} drawing
 * @returns {Point|null}
 */
export function sidesOf(to, drawing) {
  if (isLike(to)) return null;
  if (typeof to !== "string") return to;
  const [size, hung, share] = [SIZES_M, HUNG, SHARES].map((known) => /** @type {Record<string, number[]>} */ (known)[to]);
  const [wide, long] = extentOf(drawing);
  if (hung) {
    const [narrow, half] = [Math.min(hung[0], wide, long), hung[1] * Math.max(wide, long)];
    return wide <= long ? [narrow, half] : [half, narrow];
  }
  return size ? [size[0], size[1]] : share ? [share[0] * wide, share[1] * long] : null;
}

/** How wide and how long a garment is as it is drawn (m). @param {Drawing} drawing @returns {Point} */
export function extentOf(drawing) {
  const box = boxOf(ringOf(drawing));
  return box ? [box.high[0] - box.low[0], box.high[1] - box.low[1]] : [0, 0];
}

/** Whether a size is no larger than that, either way round. @param {Point} size @param {Point} sides */
export function isWithin(size, sides) {
  const [most, own] = [sides, size].map((two) => [...two].sort((a, b) => a - b));
  return own.every((side, index) => side <= most[index] + TOLERANCE_M);
}

/** What is wanted as a request names it. @param {Target} to */
export const asked = (to) => (typeof to === "string" || isLike(to) ? to : { width_m: to[0], length_m: to[1] });
