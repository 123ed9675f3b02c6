/** Plans and folds in words. Folds are counted from 1 for people; programs count them from 0. */

import { numeral } from "../language/numeral.js";
import { say } from "../language/say.js";
import { armLetter } from "../messages/arms.js";
import { length } from "../messages/lengths.js";
import { place } from "../messages/names.js";
import { kindOf } from "./step_kinds.js";

/** @import { FoldKind, Primitive } from "pleat" */

const BACKED_OFF_M = 0.001;

/** @param {number} value seconds */
export const seconds = (value) => say("time.seconds", { number: numeral(value, 1) });

/** @param {string} text */
export const capital = (text) => text.charAt(0).toUpperCase() + text.slice(1);

/** What moves in a kind of fold. @param {FoldKind} kind */
export const movedBy = (kind) => say(`colour.${kind}.moves`);

/** What a step does where space is scarce. @param {Primitive} step @param {{name?: string}[]} folds the garment's */
export const briefly = (step, folds) => kindOf(step).briefly(step, folds);

/**
 * What a step does, with what kind of thing it is.
 * @param {Primitive} step
 * @param {{name?: string}[]} folds the garment's
 */
export const whole = (step, folds) => `${say(`kind.${step.kind}`)}: ${kindOf(step).what(step, folds)}`;

/** By which hands, as in `L + R`. @param {Primitive} primitive */
export const hands = (primitive) =>
  primitive.grips
    .map((grip) => armLetter(grip.arm))
    .sort()
    .join(" + ");

/** Where the base ends up. @param {Primitive} primitive */
export function where(primitive) {
  const { station, back_off_m: backOff } = primitive.base;
  const back = backOff > BACKED_OFF_M ? say("place.back", { length: length(backOff) }) : "";
  return [place(station), back].filter(Boolean).join(", ");
}
