/** What was seen in a picture, and why it may be wrong. */

import { length } from "./lengths.js";

/** @import { Catalogue } from "./in_words.js" */

/** @param {number} share */
const percent = (share) => `${Math.round(100 * share)} %`;

/** @type {Catalogue} */
export const PICTURES = {
  corners_seen: ({ corners }) => `the outline has ${corners} corners`,
  made_symmetric: ({ off_m: off }) => `the outline was made symmetric; its halves differed by ${length(off)} in the mean`,
  edges_do_not_fit: ({ share, within_m: within }) =>
    `straight edges fit only ${percent(share)} of the outline to ${length(within)}`,
  likeness_does_not_fit: ({ share, within_m: within }) =>
    `only ${percent(share)} of the outline lie within ${length(within)} of what it should be like`,
  states_alike: ({ states }) => `${states} states of the folds fit equally well`,
  cut_off: ({ share }) => `the cloth is cut off: ${percent(share)} of its outline is at the picture\u2019s border`,
  ways_disagree: ({ agreement, least }) =>
    `two ways to find the cloth agree on ${percent(agreement)} only, less than ${percent(least)}`,
  faint_edge: ({ contrast }) =>
    `the cloth hardly stands out from the table: its edge has a strength of ${contrast.toFixed(1)} of 255`,
  size_uncertain: ({ share }) =>
    `its size may be wrong by ${percent(share)}: the sheet or marker is small or seen at a slant`,
  scale_needed: () =>
    "nothing in the picture says how large the garment is: lay a sheet of A4 or Letter beside it, or type a length",
  picture_size: ({ size: [wide, tall], sides, most }) =>
    `the picture is ${wide} by ${tall} pixels; a side has ${sides[0]} to ${sides[1]}, all of it at most ${most}`,
  seen_does_not_fit: ({ share, residual_m: off }) =>
    `what was seen does not fit: ${percent(share)} of it lies on the outline, half of it within ${length(off)}`,
  too_little_seen: ({ share }) => `too little was seen: ${percent(share)} of the outline`,
  too_uncertain: ({ error_m: error }) => `it may be ${length(error)} off`,
};
