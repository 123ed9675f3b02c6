/**
 * The choice `It is like` for a garment read from a picture: the measures of a template are fitted to the outline, and
 * its folds come along.
 */

import { element } from "../dom.js";
import { say, translated } from "../language/say.js";

/** @import { Template } from "pleat" */

/**
 * @param {string|undefined} like the template that was chosen
 * @param {(like: string|undefined) => void} onChoice
 */
export function likeness(like, onChoice) {
  const select = /** @type {HTMLSelectElement} */ (element("select", ""));
  select.append(new Option(say("likeness.nothing"), ""));
  select.addEventListener("change", () => onChoice(select.value || undefined));
  fetch("../api/templates")
    .then((answer) => (answer.ok ? answer.json() : []))
    .then((/** @type {Template[]} */ templates) => {
      select.append(...templates.map(({ name, title }) => new Option(translated(title), name)));
      select.value = like ?? "";
    })
    .catch(() => {});
  return element("label", "likeness", say("likeness.label"), select);
}
