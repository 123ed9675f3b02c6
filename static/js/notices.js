/** Sentences that come and go at the bottom of the work: what was refused, what was done elsewhere. */

import { byId, element } from "./dom.js";

const READING_MS = 6000;

/** @param {string} text */
export function notice(text) {
  const root = byId("notices");
  const same = [...root.children].find((shown) => shown.textContent === text);
  same?.remove();
  const shown = element("p", "notice", text);
  root.append(shown);
  setTimeout(() => shown.remove(), READING_MS);
}
