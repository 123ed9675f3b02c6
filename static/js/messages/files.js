/** How a garment was read from a file, what is wrong with the file, and why there is none to be saved. */

import { say, translated } from "../language/say.js";
import { length, listed } from "./lengths.js";
import { called } from "./names.js";

/** @import { Named } from "./names.js" */
/** @import { Catalogue, Told } from "./in_words.js" */

/** @param {[number, number]} sides */
const size = ([wide, tall]) => say("import.by", { wide: length(wide), tall: length(tall) });

/**
 * The words of files.
 * @param {(told: Told, folds: Named[]) => string} inWords what messages within messages say
 * @returns {Catalogue}
 */
export const files = (inWords) => ({
  curves_replaced: ({ corners, off_m: off }) => say("message.curves_replaced", { corners, off: length(off) }),
  seam_allowance: ({ line, width_m: width }) =>
    say(line === "cut" ? "message.seam_allowance.cut" : "message.seam_allowance.seam", { width: length(width) }),
  graded_sizes: ({ size: taken, sizes }) => say("message.graded_sizes", { size: taken, sizes: sizes.join(", ") }),
  pieces: ({ piece, pieces }) => say("message.pieces", { piece, pieces: pieces.join(", ") }),
  no_such_piece: ({ piece, pieces }) => say("message.no_such_piece", { piece, pieces: pieces.join(", ") }),
  library_missing: ({ library, install }) => say("message.library_missing", { library, install }),
  piece_unfolded: () => say("message.piece_unfolded"),
  halves_joined: () => say("message.halves_joined"),
  fold_unknown: () => say("message.fold_unknown"),
  no_sizes: () => say("message.no_sizes"),
  no_such_size: ({ size: wanted, sizes }) => say("message.no_such_size", { size: wanted, sizes: sizes.join(", ") }),
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
});
