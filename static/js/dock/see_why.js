/** The switches of what the board can show of the robot: reach, paths, slip limit and the like. */

import { element } from "../dom.js";
import { say } from "../language/say.js";
import { toggle } from "./buttons.js";

const SWITCHES = [
  ["reach", say("overlay.reach"), say("overlay.reach_hint")],
  ["grips", say("overlay.grips"), say("overlay.grips_hint")],
  ["paths", say("overlay.paths"), say("overlay.paths_hint")],
  ["base", say("overlay.base"), say("overlay.base_hint")],
  ["slip", say("overlay.slip"), say("overlay.slip_hint")],
  ["places", say("overlay.places"), say("overlay.places_hint")],
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
    else timer = setTimeout(() => wait.replaceChildren(say("overlay.working")), NOTICED_MS);
  });
  const name = element("span", "see-why-name", say("overlay.title"));
  const root = element("div", "see-why", name, element("span", "chips", ...switches), wait);
  root.setAttribute("role", "group");
  root.setAttribute("aria-label", say("overlay.title"));
  return root;
}
