/** A suggestion as a button: pointed at, its effect is shown on board and 3D view; pressed, it is done as one step. */

import { button, element } from "../dom.js";
import { say } from "../language/say.js";
import { applyChange } from "./suggestion_change.js";
import { addedFold } from "../messages/changes.js";
import { inWords } from "../messages/in_words.js";
import { capital, seconds } from "./words.js";

/** @typedef {import("../store.js").Store} Store */
/** @typedef {import("./suggestion_search.js").Suggestion} Suggestion */

const LONGEST = 200;
/** So long is pointed at a suggestion before the 3D view shows it (ms). */
const POINTED_MS = 250;

/**
 * @param {Store} store
 * @param {Suggestion} suggestion
 * @param {string} className
 * @returns {HTMLButtonElement}
 */
export function suggestionButton(store, suggestion, className) {
  const { cost_s: cost, is_assumption: isAssumed } = suggestion;
  const parts = [element("span", "suggestion-what", suggestionWords(store, suggestion))];
  if (cost !== null) parts.push(element("span", "suggestion-cost", seconds(cost)));
  const made = button(`suggestion ${className}`, () => {}, ...parts);
  if (isAssumed) parts[0].prepend(element("span", "tag", say("suggestion.assumption")), " ");
  made.dataset.kind = suggestion.kind;
  offer(store, suggestion, made);
  return made;
}

/** @param {Store} store @param {Suggestion} suggestion */
export const suggestionWords = (store, suggestion) => capital(inWords(suggestion, store.state?.drawing.folds ?? []));

/**
 * Have a button show what a suggestion does while it is pointed at, and do it when it is pressed.
 * @param {Store} store
 * @param {Suggestion} suggestion
 * @param {HTMLElement} made
 */
export function offer(store, suggestion, made) {
  const { change, plan_id: plan } = suggestion;
  const what = suggestionWords(store, suggestion);
  let timer = 0;
  let isOnView3D = false;
  const point = () => {
    store.setPreview(change);
    clearTimeout(timer);
    if (plan && !isOnView3D) timer = setTimeout(() => store.command({ do: "preview", plan }), POINTED_MS);
    isOnView3D = Boolean(plan);
  };
  const leave = () => {
    store.setPreview(null);
    clearTimeout(timer);
    if (isOnView3D) store.command({ do: "preview", plan: null });
    isOnView3D = false;
  };
  made.addEventListener("click", () => {
    leave();
    const isStillMeant = () => !change.drawing || change.version === store.state?.version;
    const added = addedFold(suggestion.says, store.state?.drawing.folds ?? []);
    store.edit(what.slice(0, LONGEST), (drawing) => (isStillMeant() ? applyChange(drawing, change, added) : drawing));
  });
  for (const name of ["pointerenter", "focus"]) made.addEventListener(name, point);
  for (const name of ["pointerleave", "blur"]) made.addEventListener(name, leave);
}
