/** A card: a change that gives a plan, with a picture of the folded cloth, and what the plan then takes. */

import { ringOf } from "../board/curves.js";
import { button, element } from "../dom.js";
import { offer, suggestionWords } from "../dock/suggestion_button.js";
import { seconds } from "../dock/words.js";
import { HELP } from "../messages/changes.js";
import { picture } from "../dialogs/picture.js";
import { foldedPicture } from "./folded_picture.js";

/** @import { Suggestion } from "../dock/suggestion_search.js" */

/** The kinds of help, in the order of their places. */
export const GROUPS = /** @type {const} */ (["place", "fold", "assume"]);

/** @type {Record<string, typeof GROUPS[number]>} */
const GROUP_OF = {
  placement: "place",
  size: "place",
  station: "assume",
  robot: "assume",
  friction: "assume",
  grip_radius: "assume",
  comfort_radius: "assume",
  together: "assume",
};

/** Kinds that take the place of an assumption, and are none. */
const ABOUT_ROBOT = new Set(["station", "robot"]);

/** @param {Suggestion} one */
export const groupOf = ({ kind }) => GROUP_OF[kind] ?? "fold";

/** @param {import("../store.js").Store} store @param {Suggestion} suggestion */
export function card(store, suggestion) {
  const { change, cost_s: cost, plan_id: plan } = suggestion;
  const shown = element("span", "card-picture");
  if (plan) foldedPicture(plan).then((drawn) => drawn && shown.replaceChildren(drawn));
  else if (change.drawing) shown.append(pictureOf(change.drawing));
  const what = element("span", "suggestion-what", suggestionWords(store, suggestion));
  const parts = cost === null ? [what] : [what, element("span", "suggestion-cost", seconds(cost))];
  const made = button("card", () => {}, shown, element("span", "card-words", ...parts));
  made.dataset.kind = suggestion.kind;
  made.dataset.group = groupOf(suggestion);
  made.dataset.title = ABOUT_ROBOT.has(suggestion.kind) ? HELP.robot : HELP[groupOf(suggestion)];
  made.setAttribute("aria-description", made.dataset.title);
  offer(store, suggestion, made);
  return made;
}

/** @param {import("pleat").Drawing} drawing */
const pictureOf = ({ outline, folds }) =>
  picture(
    ringOf({ outline }),
    folds.map(({ kind, start, end }) => ({ kind, start: start.point, end: end.point })),
  );
