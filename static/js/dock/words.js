/** Plans and folds in words. Folds are counted from 1 for people; programs count them from 0. */

import { numeral } from "../language/numeral.js";
import { say, translated } from "../language/say.js";
import { armLetter } from "../messages/arms.js";
import { length } from "../messages/lengths.js";
import { place } from "../messages/names.js";

/** @import { Primitive } from "pleat" */

export const KINDS = { fold: say("kind.fold"), drag: say("kind.drag"), arm_drag: say("kind.arm_drag"), move: say("kind.move") };
export const COLOURS = { blue: say("colour.blue"), red: say("colour.red") };
export const MOVED = { blue: say("colour.all_layers"), red: say("colour.last_flap") };

const BACKED_OFF_M = 0.001;

/** @param {number} value seconds */
export const seconds = (value) => say("time.seconds", { number: numeral(value, 1) });

/** @param {string} text */
export const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);

/**
 * What a fold is called.
 * @param {{name?: string}|undefined} fold
 * @param {number} index
 */
export const foldName = (fold, index) => translated(fold?.name ?? "") || say("fold.numbered", { number: index + 1 });

/**
 * What a primitive does.
 * @param {Primitive} primitive
 * @param {{name?: string}[]} folds the garment's
 */
export function what(primitive, folds) {
  if (primitive.kind === "fold") return foldName(folds[primitive.fold], primitive.fold);
  if (primitive.kind === "drag") return say("step_words.towards_robot", { length: length(primitive.distance_m) });
  if (primitive.kind === "arm_drag") return say("step_words.by_arms", { length: length(primitive.distance_m) });
  return say("step_words.from_to", { from: place(primitive.from), to: place(primitive.to) });
}

/**
 * The same where space is scarce.
 * @param {Primitive} primitive
 * @param {{name?: string}[]} folds the garment's
 */
export function briefly(primitive, folds) {
  if (primitive.kind === "drag" || primitive.kind === "arm_drag")
    return say("step_words.drag", { length: length(primitive.distance_m) });
  return primitive.kind === "move"
    ? say("step_words.drive_to", { place: place(primitive.to) })
    : what(primitive, folds);
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
  const back = backOff > BACKED_OFF_M ? say("place.back", { length: length(backOff) }) : "";
  return [place(station), back].filter(Boolean).join(", ");
}
