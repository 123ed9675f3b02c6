/** The menu of a step of the plan: `Plan from here`, `Run from here`. */

import { say } from "../language/say.js";
import { Menu } from "../menu.js";
import { MenuPress } from "../menu_press.js";
import { Running } from "../run/running.js";
import { isViewOnly } from "../view_only.js";

export class StepMenu {
  /**
   * @param {import("../store.js").Store} store
   * @param {import("./shown_plan.js").ShownPlan} shown
   * @param {Running} running
   * @param {() => void} onChosen before the rest is planned
   */
  constructor(store, shown, running, onChosen) {
    this.store = store;
    this.shown = shown;
    this.running = running;
    this.onChosen = onChosen;
    this.menu = new Menu();
    /** The plan that it was opened on, and whether planning could go on from it. */
    this.about = "";
    shown.addEventListener("change", () => this.follow());
    store.addEventListener("connection", () => this.follow());
  }

  /**
   * Give the steps in a part of the page their menu.
   * @param {HTMLElement} root
   * @param {string} selector of the steps below it: `data-index` is the primitive
   */
  serve(root, selector) {
    if (!isViewOnly) new MenuPress(root, selector, (part, at) => this.open(part, at));
  }

  /** Whether the plan on show is the drawing's, so that planning can go on from a step of it. */
  get isPlanned() {
    const { isLive, plan: message, state } = this.store;
    return isLive && message?.status === "solved" && message.plan?.version === state?.version;
  }

  /** @param {HTMLElement} part @param {{x: number, y: number}} at */
  open(part, at) {
    const step = Number(part.dataset.index);
    const isLast = step + 1 === this.shown.plan?.primitives.length;
    const isOff = isLast || !this.isPlanned;
    const planned = isLast ? say("menu.nothing_left") : say("menu.what_is_left");
    const hint = this.isPlanned ? planned : say("menu.once_planned");
    const choose = () => {
      this.onChosen();
      this.store.command({ do: "plan_from", step });
    };
    const { plan } = this.shown;
    const isHeld = plan ? !Running.isFree(plan, step) : true;
    const run = {
      text: say("run.from_here"),
      hint: this.isPlanned ? say(isHeld ? "run.is_held" : "run.from_here_hint") : hint,
      isOff: isHeld || !this.isPlanned,
      choose: () => this.running.begin(step),
    };
    this.about = this.now;
    this.menu.open(
      part.getAttribute("aria-label") ?? say("menu.step"),
      [{ text: say("menu.plan_from_here"), hint, isOff, choose }, run],
      part,
      at,
    );
  }

  /** What a menu that is open is about; with another plan its steps are others. */
  get now() {
    return JSON.stringify([this.shown.plan?.id, this.isPlanned]);
  }

  follow() {
    if (this.menu.isOpen && this.now !== this.about) this.menu.close(true);
  }
}

/** Tell that a step has a menu. @param {HTMLElement} step @param {number} index of the primitive */
export function markStep(step, index) {
  step.dataset.index = String(index);
  if (!isViewOnly) step.setAttribute("aria-haspopup", "menu");
}
