/** What was seen in a picture, and why it may be wrong. */

import { numeral } from "../language/numeral.js";
import { say } from "../language/say.js";
import { length, percent } from "./lengths.js";

/** @import { Catalogue } from "./in_words.js" */

/** @type {Catalogue} */
export const PICTURES = {
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
  too_little_seen: ({ share }) => say("message.too_little_seen", { share: percent(share) }),
  too_uncertain: ({ error_m: error }) => say("message.too_uncertain", { error: length(error) }),
};
