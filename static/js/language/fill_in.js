/** The words of the page's own elements, which name them in `data-say`, `data-say-label` and `data-say-title`. */

import { say } from "./say.js";

/** @typedef {import("./say.js").Key} Key */

/** @param {ParentNode} root */
export function fillIn(root) {
  for (const found of root.querySelectorAll("[data-say], [data-say-label], [data-say-title]")) {
    const { say: text, sayLabel: label, sayTitle: title } = /** @type {HTMLElement} */ (found).dataset;
    if (text) found.textContent = say(/** @type {Key} */ (text));
    if (label) found.setAttribute("aria-label", say(/** @type {Key} */ (label)));
    if (title) found.setAttribute("title", say(/** @type {Key} */ (title)));
  }
}
