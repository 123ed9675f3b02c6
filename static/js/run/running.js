/**
 * The button `Run` and what is said below it: the plan performed in real time by a simulated robot, each step confirmed,
 * or all of them; the clock of the page follows. Whoever leaves the page stops the robot.
 */

import { primitiveAt } from "../dock/lane_blocks.js";
import { capital, whole } from "../dock/words.js";
import { button, element, sayable, toldAloud } from "../dom.js";
import { jobEvents } from "../event_stream.js";
import { say } from "../language/say.js";

/** @import { Plan } from "pleat" */

const INSTANT_S = 1e-3;

export class Running {
  /**
   * @param {import("../rehearsal/rehearsal.js").Rehearsal} rehearsal knows the plan that can be performed
   * @param {import("../dock/shown_plan.js").ShownPlan} shown
   * @param {(t_s: number) => void} onSeek
   */
  constructor(rehearsal, shown, onSeek) {
    this.rehearsal = rehearsal;
    this.shown = shown;
    this.onSeek = onSeek;
    /** @type {Plan|null} the plan that is run */
    this.plan = null;
    /** The step that is next, or that is going on. */
    this.step = 0;
    /** @type {AbortController|null} of what is going on */
    this.abort = null;
    /** How the run ended early, as a sentence. */
    this.fault = "";
    this.button = button("chip for-editors", () => this.begin(0), say("run.do"));
    this.button.title = say("run.hint");
    this.note = toldAloud("hint");
    this.next = button("chip", () => this.perform(this.after(this.step)));
    this.rest = button("quiet", () => this.perform(null), say("run.rest"));
    this.end = button("quiet", () => (this.abort ? this.stop() : this.close()));
    this.root = element("div", "running", this.note, this.next, this.rest, this.end);
    addEventListener("pagehide", () => this.abort?.abort());
    this.show();
  }

  /** Whether grippers are free as a step begins: a run can begin or pause there. @param {Plan} plan @param {number} step */
  static isFree(plan, step) {
    const before = plan.primitives[step - 1];
    return !(before && "holds" in before && before.holds);
  }

  /** The next step before which a run can pause; null: the plan's end. @param {number} step */
  after(step) {
    const steps = this.plan?.primitives ?? [];
    const found = steps.findIndex((_, index) => index > step && this.plan && Running.isFree(this.plan, index));
    return found < 0 ? null : found;
  }

  /** Make ready; nothing moves before the first step is confirmed. @param {number} step */
  begin(step) {
    this.close();
    this.plan = this.rehearsal.rehearsable;
    this.goTo(step);
  }

  /** @param {number} step the next one, whose beginning is shown */
  goTo(step) {
    this.step = step;
    const { primitives = [], cost_s: end } = this.plan ?? {};
    this.onSeek(primitives[step]?.start_s ?? end ?? 0);
    this.show();
  }

  /** Have the simulated robot do the steps that come. @param {number|null} until the step before which it pauses */
  async perform(until) {
    const { plan, step } = this;
    if (!plan) return;
    const { signal } = (this.abort = new AbortController());
    this.fault = "";
    this.show();
    try {
      const asked = { plan: plan.id, from_step: step, until_step: until };
      for await (const { event, data } of jobEvents("../api/runs", asked, signal)) {
        if (event === "end") this.take(data);
        else this.follow(plan, Math.max(data.progress * (plan.cost_s ?? 0), plan.primitives[step].start_s));
      }
    } catch (error) {
      if (!signal.aborted) this.fault = sayable(error);
    }
    if (signal.aborted) return; // another run may be going on by now
    this.abort = null;
    this.show();
  }

  /** @param {Plan} plan @param {number} t_s how far it is */
  follow(plan, t_s) {
    this.onSeek(t_s);
    this.step = Math.max(this.step, primitiveAt(plan, t_s + INSTANT_S));
    this.show();
  }

  /** @param {any} job at its end */
  take({ status, message, result }) {
    const why = result?.why || (status === "done" ? "" : message || status);
    this.fault = why ? `${capital(why)}.` : "";
    if (result) this.goTo(result.done);
  }

  /** Stop the robot; the run can go on with the last step that began with free grippers. */
  stop() {
    this.abort?.abort();
    this.abort = null;
    const { plan, step } = this;
    this.fault = say("run.stopped", { step: step + 1 });
    if (plan) this.goTo(plan.primitives.findLastIndex((_, index) => index <= step && Running.isFree(plan, index)));
  }

  close() {
    this.abort?.abort();
    this.plan = this.abort = null;
    this.fault = "";
    this.show();
  }

  show() {
    const ready = this.rehearsal.rehearsable;
    if (this.plan && ready?.id !== this.plan.id) return this.close();
    const { plan, step, abort } = this;
    this.button.hidden = !ready;
    this.root.hidden = !plan;
    if (!plan) return;
    const count = plan.primitives.length;
    const isDone = step >= count;
    this.next.hidden = this.rest.hidden = Boolean(abort) || isDone;
    this.next.textContent = say("run.step", { step: step + 1 });
    this.end.textContent = abort ? say("search.stop") : say("dialog.close");
    const what = isDone ? "" : whole(plan.primitives[step], this.shown.folds);
    const now = isDone ? say("run.done", { count }) : say(abort ? "run.now" : "run.next", { step: step + 1, count, what });
    const told = [this.fault, now].filter(Boolean).join(" ");
    if (this.note.textContent !== told) this.note.textContent = told;
  }
}
