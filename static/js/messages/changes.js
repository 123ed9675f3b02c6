/** What could be changed: suggestions where there is no plan, and quick fixes of a drawing. */

import { inEnglish, say, translated } from "../language/say.js";
import { numeral, shortest } from "../language/numeral.js";
import { direction, moved } from "./directions.js";
import { length, listed, percent } from "./lengths.js";
import { called, place } from "./names.js";

/** @import { Says } from "pleat" */
/** @import { Named } from "./names.js" */

/** @typedef {{fold: number, by_m: number, towards: number[]}} Shift */

const TURNS = /** @type {const} */ (["left", "round", "right"]);

/** @type {import("./in_words.js").Catalogue} */
export const CHANGES = {
  place: ({ quarters, by }) => {
    const way = moved(by);
    if (!quarters) return say("message.place", { way });
    const turn = say(`message.place.${TURNS[quarters - 1]}`);
    return way ? say("message.place.and_move", { turn, way }) : turn;
  },
  smaller: ({ by, size_m: [width, height] }) =>
    say("message.smaller", { share: percent(by), width: length(width), height: length(height) }),
  shift_fold: shiftFold,
  shift_folds: ({ shifts }, folds) => listed(shifts.map((/** @type {Shift} */ one) => shiftFold(one, folds))),
  split_fold: ({ fold, depth_m: depth }, folds) =>
    say("message.split_fold", { fold: called(folds, fold), length: length(depth) }),
  halve_first: ({ fold }, folds) => say("message.halve_first", { fold: called(folds, fold) }),
  flip_fold: ({ fold }, folds) => say("message.flip_fold", { fold: called(folds, fold) }),
  fold_before: ({ fold, before }, folds) =>
    say("message.fold_before", { fold: called(folds, fold), before: called(folds, before) }),
  fold_in_order: ({ folds: order }, folds) =>
    say("message.fold_in_order", {
      folds: order.map((/** @type {number} */ index) => called(folds, index)).join(", "),
    }),
  stand_also_at: ({ station, at }) => {
    const way = moved(at);
    if (!way) return say("message.stand_also_at", { station: place(station) });
    return say("message.stand_also_at.where", { station: place(station), way });
  },
  other_robot: ({ title }) => say("message.other_robot", { title }),
  assume_comfort: ({ comfort_m: enough, now_m: now }) =>
    say("message.assume_comfort", { enough: length(enough), now: length(now) }),
  assume_friction: ({ friction, now }) =>
    say("message.assume_friction", { friction: short(friction), now: short(now) }),
  assume_grip_radius: ({ grip_radius_m: radius, folds: wider }, folds) =>
    say("message.assume_grip_radius", {
      radius: length(radius),
      folds: listed(wider.map((/** @type {number} */ index) => called(folds, index))),
    }),
  assume_together: ({ parts }, folds) =>
    listed(parts.map((/** @type {Says} */ part) => CHANGES[part.code](part, folds))),
  make_blue: ({ fold }, folds) => say("message.make_blue", { fold: called(folds, fold) }),
  put_onto_cloth: ({ fold }, folds) => say("message.put_onto_cloth", { fold: called(folds, fold) }),
  put_onto_flap: ({ fold }, folds) => say("message.put_onto_flap", { fold: called(folds, fold) }),
  delete_fold: ({ fold }, folds) => say("message.delete_fold", { fold: called(folds, fold) }),
  merge_two: () => say("message.merge_two"),
  merge_near: ({ nearer_m: nearer }) => say("message.merge_near", { nearer: length(nearer) }),
  exchange_two: () => say("message.exchange_two"),
  straighten: () => say("message.straighten"),
  uncross: () => say("message.uncross"),
  delete_corner: () => say("message.delete_corner"),
  start_at: ({ station }) => say("message.start_at", { station: place(station) }),
  take_back: ({ step }) => say("message.take_back", { step: translated(step) }),
};

/** @param {Shift} says @param {Named[]} folds */
function shiftFold({ fold, by_m: by, towards }, folds) {
  return say("message.shift_fold", { fold: called(folds, fold), length: length(by), way: direction(towards) });
}

/** A number of three digits. @param {number} number */
export const short = (number) => shortest(Number(number.toPrecision(3)));

/** A number with two digits behind the mark. @param {number} number */
export const hundredths = (number) => numeral(number, 2);

/** Kinds of help, in front of what would help. */
export const HELP = {
  place: say("suggestion_kind.place"),
  fold: say("suggestion_kind.fold"),
  assume: say("suggestion_kind.assume"),
  robot: say("suggestion_kind.robot"),
};

/** The fold that a suggestion adds, and before which; null for none. @param {Says} says @param {Named[]} folds */
export function addedFold({ code, fold }, folds) {
  if (code === "halve_first") return { index: fold, name: inEnglish("name.halve_across") };
  const name = folds[fold]?.name;
  const part = name ? inEnglish("name.outer_part_of", { name }) : inEnglish("name.outer_part");
  return code === "split_fold" ? { index: fold, name: part } : null;
}
