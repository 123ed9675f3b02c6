/** How a garment was read from a file, what is wrong with the file, and why there is none to be saved. */

import { length, listed } from "./lengths.js";
import { called } from "./names.js";

/** @import { Named } from "./names.js" */
/** @import { Catalogue, Told } from "./in_words.js" */

/** @param {[number, number]} sides */
const size = ([wide, tall]) => `${length(wide)} by ${length(tall)}`;

/**
 * The words of files.
 * @param {(told: Told, folds: Named[]) => string} inWords what messages within messages say
 * @returns {Catalogue}
 */
export const files = (inWords) => ({
  curves_replaced: ({ corners, off_m: off }) =>
    `the outline has ${corners} corners; curves were replaced by straight edges that are at most ${length(off)} off`,
  corners_left_out: ({ corners, off_m: off }) =>
    `the outline has ${corners} corners; others were left out, so that its edges are at most ${length(off)} off`,
  unit_taken: ({ unit_m: one, is_said: isSaid, size: sides }) =>
    `one unit of the drawing was taken as ${length(one)}${isSaid ? ", as you said" : ""}: ${size(sides)}`,
  lines_cut: ({ lines }, folds) => {
    /** @param {{fold: number, by_m: number}} line */
    const one = ({ fold, by_m: by }) => `${called(folds, fold)} by ${length(by)}`;
    const told = lines.map(one);
    return `fold lines were made to end at the edge of the cloth: ${listed(told)}`;
  },
  line_does_not_fit: ({ fold, ...told }, folds) =>
    `the line ${called(folds, fold)} does not fit: ${inWords({ says: told.says, message: told.message }, folds)}`,
  not_finished: ({ says, message }, folds) => `the drawing is not finished: ${inWords({ says, message }, folds)}`,
  no_plan: ({ says, message, fold }, folds) =>
    `there is no plan: ${fold === null ? "" : `${called(folds, fold)}: `}${inWords({ says, message }, folds)}`,
  garment_of_plan: ({ folds_done: done }) =>
    `the file is a plan${done ? ` after ${done} of its folds` : ""}: its garment was taken, where it lies at the ` +
    "plan\u2019s start, and is planned anew with this document\u2019s table, stations and costs",
  short_lines: ({ shorter_m: shorter, lines }) => `fold lines shorter than ${length(shorter)} were left out: ${lines}`,
  unit_unlikely: ({ unit_m: one, longest_m: longest }) =>
    `the unit that it names, ${length(one)}, would make the garment ${length(longest)} long`,
  unit_out_of_range: ({ unit_m: one }) => `one unit of the drawing would be ${length(one)}; give another scale`,
  drawing_too_large: ({ what, size: sides, most_m: most }) =>
    `${what} is ${size(sides)}, more than ${length(most)}; say what its units are, or give a scale`,
});
