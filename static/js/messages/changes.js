/** What could be changed: suggestions where there is no plan, and quick fixes of a drawing. */

import { direction, moved } from "./directions.js";
import { length, listed } from "./lengths.js";
import { called, place } from "./names.js";

/** @import { Says } from "pleat" */
/** @import { Named } from "./names.js" */

/** @typedef {{fold: number, by_m: number, towards: number[]}} Shift */

const TURNS = ["", "by 90 degrees to the left", "by 180 degrees", "by 90 degrees to the right"];

/** @type {import("./in_words.js").Catalogue} */
export const CHANGES = {
  place: ({ quarters, by }) => {
    const way = moved(by);
    if (!quarters) return `move the garment ${way}`;
    return `turn the garment ${TURNS[quarters]}${way ? ` and move it ${way}` : ""}`;
  },
  shift_fold: shiftFold,
  shift_folds: ({ shifts }, folds) => listed(shifts.map((/** @type {Shift} */ one) => shiftFold(one, folds))),
  split_fold: ({ fold, depth_m: depth }, folds) => `do ${called(folds, fold)} in two, the outer ${length(depth)} first`,
  halve_first: ({ fold }, folds) => `halve the cloth across ${called(folds, fold)} first`,
  fold_before: ({ fold, before }, folds) => `make ${called(folds, fold)} before ${called(folds, before)}`,
  fold_in_order: ({ folds: order }, folds) =>
    `fold in the order ${order.map((/** @type {number} */ index) => called(folds, index)).join(", ")}`,
  stand_also_at: ({ station, at }) => {
    const where = moved(at);
    const named = `let the robot also stand at a station \u201C${place(station)}\u201D`;
    return where ? `${named}, ${where} as seen from the table\u2019s middle` : named;
  },
  assume_comfort: ({ comfort_m: enough, now_m: now }) =>
    `assume that a comfort radius of ${length(enough)} is enough, not ${length(now)}`,
  assume_friction: ({ friction, now }) => `assume a friction coefficient of ${short(friction)}, not ${short(now)}`,
  assume_grip_radius: ({ grip_radius_m: radius, folds: wider }, folds) =>
    `assume that one grip holds the cloth within ${length(radius)} in ` +
    listed(wider.map((/** @type {number} */ index) => called(folds, index))),
  assume_together: ({ parts }, folds) =>
    parts.map((/** @type {Says} */ part) => CHANGES[part.code](part, folds)).join(" and "),
  make_blue: ({ fold }, folds) => `make ${called(folds, fold)} blue`,
  put_onto_cloth: ({ fold }, folds) => `put ${called(folds, fold)} onto the cloth`,
  put_onto_flap: ({ fold }, folds) => `put ${called(folds, fold)} onto the flap`,
  delete_fold: ({ fold }, folds) => `delete ${called(folds, fold)}`,
  merge_two: () => "merge the two corners",
  merge_near: ({ nearer_m: nearer }) => `merge corners nearer than ${length(nearer)}`,
  exchange_two: () => "exchange the two corners",
  uncross: () => "uncross the edges",
  delete_corner: () => "delete one corner",
  start_at: ({ station }) => `start at ${place(station)}`,
  take_back: ({ step }) => `take back \u201C${step}\u201D`,
};

/** @param {Shift} says @param {Named[]} folds */
function shiftFold({ fold, by_m: by, towards }, folds) {
  return `shift ${called(folds, fold)} ${length(by)} ${direction(towards)}`;
}

/** @param {number} number */
const short = (number) => String(Number(number.toPrecision(3)));

/** Kinds of help, in front of what would help. */
export const HELP = { place: "Move the cloth", fold: "Change a fold", assume: "Assume" };

/** The fold that a suggestion adds, and before which; null for none. @param {Says} says @param {Named[]} folds */
export function addedFold({ code, fold }, folds) {
  if (code === "halve_first") return { index: fold, name: "halve across" };
  const name = folds[fold]?.name;
  return code === "split_fold" ? { index: fold, name: name ? `${name}, outer part` : "outer part" } : null;
}
