/** Sentences that come and go at the bottom of the work: what was refused, what was done elsewhere. */

import { byId, element } from "./dom.js";

const READING_MS = 6000;

/** @param {string} text @param {number} [shown_ms] how long it is shown (ms) */
export function notice(text, shown_ms = READING_MS) {
  const root = byId("notices");
  const same = [...root.children].find((shown) => shown.textContent === text);
  same?.remove();
  const shown = element("p", "notice", text);
  root.append(shown);
  setTimeout(() => shown.remove(), shown_ms);
}
