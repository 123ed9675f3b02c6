/** A suggestion as a button: pointed at, its effect is shown; pressed, it is done as one step. */

import { button, element } from "../dom.js";
import { applyChange } from "./suggestion_change.js";
import { inWords } from "../messages/in_words.js";
import { capital, seconds } from "./words.js";

/**
 * @param {import("../store.js").Store} store
 * @param {import("./suggestion_search.js").Suggestion} suggestion
 * @param {string} className
 * @returns {HTMLButtonElement}
 */
export function suggestionButton(store, suggestion, className) {
  const { change, cost_s: cost, is_assumption: isAssumed } = suggestion;
  const what = capital(inWords(suggestion, store.state?.drawing.folds ?? []));
  const apply = () => {
    store.setPreview(null);
    const isStillMeant = () => !change.drawing || change.version === store.state?.version;
    store.edit(label(what), (drawing) => (isStillMeant() ? applyChange(drawing, change) : drawing));
  };
  const parts = [element("span", "suggestion-what", what)];
  if (cost !== null) parts.push(element("span", "suggestion-cost", seconds(cost)));
  const made = button(`suggestion ${className}`, apply, ...parts);
  if (isAssumed) parts[0].prepend(element("span", "tag", "assumption"), " ");
  made.dataset.kind = suggestion.kind;
  for (const name of ["pointerenter", "focus"]) made.addEventListener(name, () => store.setPreview(change));
  for (const name of ["pointerleave", "blur"]) made.addEventListener(name, () => store.setPreview(null));
  return made;
}

const LONGEST = 200;
/** @param {string} what */
const label = (what) => what.slice(0, LONGEST);
