/** What is wrong with an outline or a fold that is drawn. */

import { language } from "../language/language.js";
import { say, translated } from "../language/say.js";
import { area, length, onGarment } from "./lengths.js";
import { counted, place } from "./names.js";

/** @import { Says } from "pleat" */

/** @type {import("./in_words.js").Catalogue} */
export const DRAWING = {
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
