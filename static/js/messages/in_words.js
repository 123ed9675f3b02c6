/**
 * Messages of the server in words. A message comes as a code and named numbers in SI units, folds and edges counted from
 * 0; here they become a sentence in the page's unit and numbering. No number is read out of a sentence.
 */

import { language } from "../language/language.js";
import { numeral } from "../language/numeral.js";
import { say, translated } from "../language/say.js";
import { CHANGES } from "./changes.js";
import { area, length, listed, onGarment, percent } from "./lengths.js";
import { called, counted, place } from "./names.js";
import { REASONS } from "./reasons.js";

/** @import { Named } from "./names.js" */
/** @import { Says } from "pleat" */

/** @typedef {{says?: Says|null, message: string}} Told a message as it comes */
/** @typedef {{[code: string]: (says: any, folds: Named[]) => string}} Catalogue */

/** What is wrong with an outline or a fold that is drawn. @type {Catalogue} */
const DRAWING = {
  outline_points: ({ points, most }) => say("message.outline_points", { points, most }),
  outline_area: ({ area_m2: has, least_m2: least }) =>
    say("message.outline_area", { area: area(has), least: area(least) }),
  outline_too_large: ({ far_m: far, most_m: most }) =>
    say("message.outline_too_large", { far: length(far), most: length(most) }),
  edge_too_short: ({ edge, from, to, length_m: has, least_m: least }) =>
    say("message.edge_too_short", {
      edge: counted(edge),
      from: counted(from),
      to: counted(to),
      length: length(has),
      least: length(least),
    }),
  edges_cross: ({ edges: [first, second], at }) =>
    say("message.edges_cross", { first: counted(first), second: counted(second), at: onGarment(at) }),
  line_too_short: ({ length_m: has, least_m: least }) =>
    say("message.line_too_short", { length: length(has), least: length(least) }),
  end_off_boundary: ({ at, off_m: off, most_m: most }) =>
    say("message.end_off_boundary", { at: onGarment(at), off: length(off), most: length(most) }),
  would_tear: ({ along_m: along }) => say("message.would_tear", { along: length(along) }),
  unknown_station: ({ station, stations }) =>
    say("message.unknown_station", { station: place(station), stations: stations.map(place).join(", ") }),
  dropped_too_near: ({ apart_m: apart, least_m: least }) =>
    say("message.dropped_too_near", { apart: length(apart), least: length(least) }),
  not_on_flap: ({ at }) => say("message.not_on_flap", { at: onGarment(at) }),
  no_cloth_there: ({ at }) => say("message.no_cloth_there", { at: onGarment(at) }),
  line_misses_cloth: () => say("message.line_misses_cloth"),
  measure_out_of_range: ({ label, value_m: value, least_m: least, most_m: most }) =>
    say("message.measure_out_of_range", {
      label: measure(label),
      value: length(value),
      least: length(least),
      most: length(most),
    }),
  measure_not_less: (says) => say("message.measure_not_less", limited(says)),
  measure_too_small: (says) => say("message.measure_too_small", limited(says)),
  folds_full: ({ most }) => say("message.folds_full", { most }),
  fewer_folds: ({ asked, legal }) => say("message.fewer_folds", { asked, legal }),
};

/** @param {Says} says */
const limited = ({ label, value_m: value, what, than_m: limit, by_m: by }) => ({
  label: measure(label),
  value: length(value),
  what: translated(what).replace("{}", length(by)),
  than: length(limit),
});

/** A measure as it is called within a sentence. @param {string} label */
const measure = (label) => (language === "en" ? label : translated(label.charAt(0).toUpperCase() + label.slice(1)));

/** What was seen in a picture, and why it may be wrong. @type {Catalogue} */
const PICTURES = {
  corners_seen: ({ corners }) => say("message.corners_seen", { corners }),
  made_symmetric: ({ off_m: off }) => say("message.made_symmetric", { off: length(off) }),
  edges_do_not_fit: ({ share, within_m: within }) =>
    say("message.edges_do_not_fit", { share: percent(share), within: length(within) }),
  likeness_does_not_fit: ({ share, within_m: within }) =>
    say("message.likeness_does_not_fit", { share: percent(share), within: length(within) }),
  states_alike: ({ states }) => say("message.states_alike", { states }),
  cut_off: ({ share }) => say("message.cut_off", { share: percent(share) }),
  ways_disagree: ({ agreement, least }) =>
    say("message.ways_disagree", { agreement: percent(agreement), least: percent(least) }),
  several_cloths: ({ cloths }) => say("message.several_cloths", { cloths }),
  striped_cloth: ({ pieces }) => say("message.striped_cloth", { pieces }),
  sheet_within_cloth: () => say("message.sheet_within_cloth"),
  faint_edge: ({ contrast }) => say("message.faint_edge", { contrast: numeral(contrast, 1) }),
  size_uncertain: ({ share }) => say("message.size_uncertain", { share: percent(share) }),
  scale_needed: () => say("message.scale_needed"),
  picture_size: ({ size: [wide, tall], sides: [fewest, longest], most }) => {
    const counts = Object.entries({ wide, tall, fewest, longest, most });
    return say("message.picture_size", Object.fromEntries(counts.map(([name, count]) => [name, String(count)])));
  },
  seen_does_not_fit: ({ share, residual_m: off }) =>
    say("message.seen_does_not_fit", { share: percent(share), off: length(off) }),
  looks_alike: ({ placements }) => say("message.looks_alike", { placements }),
  outline_hidden: () => say("message.outline_hidden"),
  no_cloth_seen: () => say("message.no_cloth_seen"),
  physics_missing: () => say("message.physics_missing"),
  too_little_seen: ({ share }) => say("message.too_little_seen", { share: percent(share) }),
  too_uncertain: ({ error_m: error }) => say("message.too_uncertain", { error: length(error) }),
};

/** @param {[number, number]} sides */
const size = ([wide, tall]) => say("import.by", { wide: length(wide), tall: length(tall) });

/** How a garment was read from a file, what is wrong with the file, and why there is none. @type {Catalogue} */
const FILES = {
  curves_replaced: ({ corners, off_m: off }) => say("message.curves_replaced", { corners, off: length(off) }),
  seam_allowance: ({ line, width_m: width }) =>
    say(line === "cut" ? "message.seam_allowance.cut" : "message.seam_allowance.seam", { width: length(width) }),
  graded_sizes: ({ size: taken, sizes }) => say("message.graded_sizes", { size: taken, sizes: sizes.join(", ") }),
  piece_unfolded: () => say("message.piece_unfolded"),
  halves_joined: () => say("message.halves_joined"),
  fold_unknown: () => say("message.fold_unknown"),
  no_sizes: () => say("message.no_sizes"),
  no_such_size: ({ size: wanted, sizes }) => say("message.no_such_size", { size: wanted, sizes: sizes.join(", ") }),
  pattern_specification: ({ panels }) => say("message.pattern_specification", { panels }),
  fold_file: () => say("message.fold_file"),
  robot_card_file: () => say("message.robot_card_file"),
  corners_left_out: ({ corners, off_m: off }) => say("message.corners_left_out", { corners, off: length(off) }),
  unit_taken: ({ unit_m: one, is_said: isSaid, size: sides }) =>
    say(isSaid ? "message.unit_taken.said" : "message.unit_taken", { one: length(one), size: size(sides) }),
  lines_cut: ({ lines }, folds) => {
    /** @param {{fold: number, by_m: number}} line */
    const one = ({ fold, by_m: by }) => say("message.lines_cut.one", { fold: called(folds, fold), length: length(by) });
    return say("message.lines_cut", { lines: listed(lines.map(one)) });
  },
  line_does_not_fit: ({ fold, ...told }, folds) =>
    say("message.line_does_not_fit", {
      fold: called(folds, fold),
      why: inWords({ says: told.says, message: told.message }, folds),
    }),
  not_finished: ({ says, message }, folds) => say("message.not_finished", { why: inWords({ says, message }, folds) }),
  no_plan: ({ says, message, fold }, folds) => {
    const about = fold === null ? "" : `${called(folds, fold)}: `;
    return say("message.no_plan", { why: about + inWords({ says, message }, folds) });
  },
  garment_of_plan: ({ folds_done: done }) =>
    done ? say("message.garment_of_plan.after", { count: done }) : say("message.garment_of_plan"),
  short_lines: ({ shorter_m: shorter, lines }) => say("message.short_lines", { shorter: length(shorter), lines }),
  unit_unlikely: ({ unit_m: one, longest_m: longest }) =>
    say("message.unit_unlikely", { one: length(one), longest: length(longest) }),
  unit_out_of_range: ({ unit_m: one }) => say("message.unit_out_of_range", { one: length(one) }),
  drawing_too_large: ({ what, size: sides, most_m: most }) =>
    say("message.drawing_too_large", { what: translated(what), size: size(sides), most: length(most) }),
};

/** @type {Catalogue} */
const CATALOGUE = { ...DRAWING, ...REASONS, ...CHANGES, ...PICTURES, ...FILES };

/**
 * A message without a capital in front and a full stop behind. One that has no numbers comes as its sentence alone.
 * @param {Told} told
 * @param {Named[]} folds
 */
export function inWords({ says, message }, folds) {
  const words = says ? CATALOGUE[says.code] : undefined;
  return words && says ? words(says, folds) : message;
}
