/** The lower dock: folds, timeline, and what planning came to. */

import { byId, element, group } from "../dom.js";
import { say } from "../language/say.js";
import { RehearsalCard } from "../rehearsal/card.js";
import { toggle } from "./buttons.js";
import { Clock } from "./clock.js";
import { Folds } from "./folds.js";
import { Lanes } from "./lanes.js";
import { Outcome } from "./outcome.js";
import { Planning } from "./planning.js";
import { ShownPlan } from "./shown_plan.js";
import { StepMenu } from "./step_menu.js";
import { TimeSlider, Transport } from "./transport.js";

/**
 * @param {import("../store.js").Store} store
 * @param {import("../step_pictures.js").StepPictures} pictures
 * @param {import("../rehearsal/rehearsal.js").Rehearsal} rehearsal
 */
export function mountDock(store, pictures, rehearsal) {
  const root = byId("dock");
  const clock = new Clock(store);
  const shown = new ShownPlan(store);
  const slider = new TimeSlider(store, clock);
  const transport = new Transport(store, clock, slider, shown);
  const lanes = new Lanes(store, clock, slider, shown, rehearsal);
  const timeline = element("section", "dock-timeline", transport.root, lanes.root, seeWhy(store));
  timeline.setAttribute("aria-label", say("timeline.label"));
  const folds = new Folds(store, clock, shown);
  const outcome = new Outcome(store, clock, shown, pictures, rehearsal, (t_s) => slider.seek(t_s));
  new RehearsalCard(store, clock, rehearsal, outcome.rehearsing.root);
  const steps = new StepMenu(store, shown, outcome.running, () => outcome.start.takeFocus());
  steps.serve(lanes.root, ".block");
  steps.serve(outcome.list.root, ".plan-row");
  const planning = new Planning(store);
  planning.addEventListener("change", () => {
    root.classList.toggle("is-planning", planning.wait === "noticed" || planning.wait === "long");
  });
  store.addEventListener("connection", () => root.classList.toggle("is-offline", !store.isLive));
  root.replaceChildren(folds.root, timeline, outcome.root);
}

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

/** @param {import("../store.js").Store} store @returns {HTMLElement} */
function seeWhy(store) {
  const switches = SWITCHES.map(([name, text, about]) => {
    const made = toggle(text, (isOn) => store.setOverlay(name, isOn));
    made.dataset.overlay = name;
    made.classList.toggle("for-editors", name === "places"); // the server works that out for nobody else
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
  group(root, say("overlay.title"));
  return root;
}
