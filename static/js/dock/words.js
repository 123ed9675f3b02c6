/** Plans and folds in words. Folds are counted from 1 for people; programs count them from 0. */

import { length } from "../messages/lengths.js";
import { place } from "../messages/names.js";
import { armLetter } from "../messages/arms.js";

/** @import { Primitive } from "pleat" */

export const KINDS = { fold: "Fold", drag: "Drag", move: "Drive" };
export const COLOURS = { blue: "Blue", red: "Red" };
export const MOVED = { blue: "all layers", red: "last flap" };

const BACKED_OFF_M = 0.001;

/** @param {number} value seconds */
export const seconds = (value) => `${value.toFixed(1)} s`;

/** @param {string} text */
export const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);

/**
 * What a fold is called.
 * @param {{name?: string}|undefined} fold
 * @param {number} index
 */
export const foldName = (fold, index) => fold?.name || `fold ${index + 1}`;

/**
 * What a primitive does.
 * @param {Primitive} primitive
 * @param {{name?: string}[]} folds the garment's
 */
export function what(primitive, folds) {
  if (primitive.kind === "fold") return foldName(folds[primitive.fold], primitive.fold);
  if (primitive.kind === "drag") return `${length(primitive.distance_m)} towards the robot`;
  return `${place(primitive.from)} to ${place(primitive.to)}`;
}

/**
 * The same where space is scarce.
 * @param {Primitive} primitive
 * @param {{name?: string}[]} folds the garment's
 */
export function briefly(primitive, folds) {
  if (primitive.kind === "drag") return `Drag ${length(primitive.distance_m)}`;
  return primitive.kind === "move" ? `Drive to ${place(primitive.to)}` : what(primitive, folds);
}

/**
 * The same with what kind of thing it is.
 * @param {Primitive} primitive
 * @param {{name?: string}[]} folds the garment's
 */
export const whole = (primitive, folds) => `${KINDS[primitive.kind]}: ${what(primitive, folds)}`;

/**
 * By which hands, as in `L + R`.
 * @param {Primitive} primitive
 */
export const hands = (primitive) =>
  primitive.grips
    .map((grip) => armLetter(grip.arm))
    .sort()
    .join(" + ");

/**
 * Where the base ends up.
 * @param {Primitive} primitive
 */
export function where(primitive) {
  const { station, back_off_m: backOff } = primitive.base;
  return `${place(station)}${backOff > BACKED_OFF_M ? `, ${length(backOff)} back` : ""}`;
}
