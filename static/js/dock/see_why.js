/** The switches of what the board can show of the robot: reach, paths, slip limit and the like. */

import { element } from "../dom.js";
import { toggle } from "./buttons.js";

const SWITCHES = [
  ["reach", "Reach", "Where each arm can grip at this moment, with the comfort asked for"],
  ["grips", "Grips", "What must be held, and where the hands take it"],
  ["paths", "Hand paths", "The ways of the hands"],
  ["base", "Base path", "The way of the base"],
  ["slip", "Slip limit", "How far the cloth may hang over the table's edges"],
  ["places", "Cost map", "What the plan costs wherever the garment could lie"],
];

/** What takes less time than this needs no word (ms). */
const NOTICED_MS = 200;

/**
 * @param {import("../store.js").Store} store
 * @returns {HTMLElement}
 */
export function seeWhy(store) {
  const switches = SWITCHES.map(([name, text, about]) => {
    const made = toggle(text, (isOn) => store.setOverlay(name, isOn));
    made.dataset.overlay = name;
    made.title = about;
    return made;
  });
  store.addEventListener("overlays", () => {
    for (const made of switches) {
      made.setAttribute("aria-pressed", String(store.overlays.has(made.dataset.overlay ?? "")));
    }
  });
  const wait = element("span", "see-why-wait hint");
  wait.setAttribute("aria-live", "polite");
  let timer = 0;
  store.addEventListener("pending", () => {
    for (const made of switches) {
      made.setAttribute("aria-busy", String(store.pending.includes(made.dataset.overlay ?? "")));
    }
    clearTimeout(timer);
    if (!store.pending.length) wait.textContent = "";
    else timer = setTimeout(() => wait.replaceChildren("Working it out\u2026"), NOTICED_MS);
  });
  const name = element("span", "see-why-name", "See why");
  const root = element("div", "see-why", name, element("span", "chips", ...switches), wait);
  root.setAttribute("role", "group");
  root.setAttribute("aria-label", "See why");
  return root;
}
