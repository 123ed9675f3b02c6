/** What is wrong with an outline or a fold that is drawn. */

import { area, length, onGarment } from "./lengths.js";
import { counted, place } from "./names.js";

/** @import { Says } from "pleat" */

/** @type {import("./in_words.js").Catalogue} */
export const DRAWING = {
  outline_points: ({ points, most }) => `it has ${points} points; it needs 3 to ${most}`,
  outline_area: ({ area_m2: has, least_m2: least }) => `it covers ${area(has)}, less than ${area(least)}`,
  outline_too_large: ({ far_m: far, most_m: most }) => `it reaches ${length(far)} from where it begins, at most ${length(most)}`,
  edge_too_short: ({ edge, from, to, length_m: has, least_m: least }) =>
    `edge ${counted(edge)}, from point ${counted(from)} to point ${counted(to)}, is ${length(has)} long, ` +
    `less than ${length(least)}`,
  edges_cross: ({ edges: [first, second], at }) =>
    `edges ${counted(first)} and ${counted(second)} cross at ${onGarment(at)}`,
  line_too_short: ({ length_m: has, least_m: least }) => `the line is ${length(has)} long, less than ${length(least)}`,
  end_off_boundary: ({ at, off_m: off, most_m: most }) =>
    `its end at ${onGarment(at)} is ${length(off)} from the cloth\u2019s edge; ends within ${length(most)} snap to it`,
  would_tear: ({ along_m: along }) =>
    `the part that moves reaches ${length(along)} along the crease of the fold before: it would tear`,
  unknown_station: ({ station, stations }) =>
    `there is no station ${place(station)}; there are ${stations.map(place).join(", ")}`,
  dropped_too_near: ({ apart_m: apart, least_m: least }) =>
    `it is dropped ${length(apart)} from where it is grabbed, less than ${length(least)}`,
  not_on_flap: ({ at }) => `at ${onGarment(at)} is cloth that a red fold leaves where it is`,
  no_cloth_there: ({ at }) => `there is no cloth at ${onGarment(at)}`,
  line_misses_cloth: () => "it does not cross the cloth",
  measure_out_of_range: ({ label, value_m: value, least_m: least, most_m: most }) =>
    `${label} is ${length(value)}, not between ${length(least)} and ${length(most)}`,
  measure_not_less: (says) => `${measured(says)} must be less than ${than(says)}`,
  measure_too_small: (says) => `${measured(says)} must be at least ${than(says)}`,
  folds_full: ({ most }) => `there are ${most} folds already, and there may be no more`,
  fewer_folds: ({ asked, legal }) => `it comes after ${asked} folds, but only ${legal} are drawn and legal`,
};

/** @param {Says} says */
const measured = ({ label, value_m: value }) => `${label} (${length(value)})`;
/** @param {Says} says */
const than = ({ what, than_m: limit, by_m: by }) => `${what.replace("{}", length(by))} (${length(limit)})`;
