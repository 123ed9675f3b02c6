/** The lower dock: folds, timeline, and what planning came to. */

import { byId, element } from "../dom.js";
import { say } from "../language/say.js";
import { RehearsalCard } from "../rehearsal/card.js";
import { Clock } from "./clock.js";
import { Folds } from "./folds.js";
import { Lanes } from "./lanes.js";
import { Outcome } from "./outcome.js";
import { Planning } from "./planning.js";
import { seeWhy } from "./see_why.js";
import { ShownPlan } from "./shown_plan.js";
import { StepMenu } from "./step_menu.js";
import { TimeSlider } from "./time_slider.js";
import { Transport } from "./transport.js";

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
  const steps = new StepMenu(store, shown, () => outcome.start.takeFocus());
  steps.serve(lanes.root, ".block");
  steps.serve(outcome.list.root, ".plan-row");
  const planning = new Planning(store);
  planning.addEventListener("change", () => {
    root.classList.toggle("is-planning", planning.wait === "noticed" || planning.wait === "long");
  });
  store.addEventListener("connection", () => root.classList.toggle("is-offline", !store.isLive));
  root.replaceChildren(folds.root, timeline, outcome.root);
}
