/** The button `Rehearse`: performs the plan in simulated physics, and says of every step whether it holds there. */

import { fetched } from "../dialogs/fetched.js";
import { button, element, sayable } from "../dom.js";
import { say } from "../language/say.js";
import { capital } from "./words.js";

/** @import { Job, Plan } from "pleat" */

/**
 * What became of a step; see `POST /api/rehearsals`.
 * @typedef {object} Verdict
 * @property {number} step
 * @property {number} mean_mm
 * @property {number} slid_mm
 * @property {boolean} held
 */
/** @typedef {{held: boolean, steps: Verdict[], regrasps: number, replans: number}} Run */
/** @typedef {{runs: Run[], held: number, of: number, success_low: number, success_high: number}} Result */
/** @typedef {{runs: number, noise: "none"|"real"}} Asked */

const ONCE = /** @type {Asked} */ ({ runs: 1, noise: "none" });
const OFTEN = /** @type {Asked} */ ({ runs: 10, noise: "real" });
const LOOK_EVERY_MS = 500;
/** A shorter slide need not be told (mm). */
const SLID_MM = 5;

export class Rehearsing extends EventTarget {
  /** @param {import("../store.js").Store} store */
  constructor(store) {
    super();
    this.store = store;
    /** @type {string|null} the plan that is rehearsed or was */
    this.plan = null;
    /** @type {string|null} the path of the job that runs */
    this.job = null;
    /** What became of each step, by its number. @type {Map<number, Verdict>} */
    this.verdicts = new Map();
    this.button = button("chip", () => this.begin(ONCE), say("rehearsal.do"));
    this.button.title = say("rehearsal.hint");
    this.bar = /** @type {HTMLProgressElement} */ (element("progress", "job-progress"));
    this.bar.setAttribute("aria-label", say("rehearsal.progress"));
    this.note = element("p", "hint");
    this.note.setAttribute("role", "status");
    this.often = button("quiet", () => this.begin(OFTEN), say("rehearsal.often"));
    this.often.title = say("rehearsal.often_hint");
    this.end = button("quiet", () => this.close(), say("jobs.cancel"));
    this.root = element("div", "rehearsing", this.note, this.bar, this.often, this.end);
    this.close();
  }

  /** A rehearsal is about one plan only. @param {Plan|null} plan */
  follow(plan) {
    this.button.hidden = !plan || plan.primitives.length === 0;
    if (this.plan !== null && plan?.id !== this.plan) this.close();
  }

  /** @param {Asked} asked */
  async begin(asked) {
    const plan = this.store.plan?.plan;
    if (!plan) return;
    this.close();
    const id = (this.plan = plan.id);
    this.say(say("rehearsal.running"), true);
    try {
      const result = await this.performed(id, asked);
      if (result && this.plan === id) this.tell(result);
    } catch (error) {
      if (this.plan === id) this.say(sayable(error), false);
    }
  }

  /** @param {string} plan @param {Asked} asked @returns {Promise<Result|null>} nothing if it was cancelled */
  async performed(plan, asked) {
    const begun = /** @type {Job} */ (await fetched("../api/rehearsals", "POST", { plan, feedback: true, ...asked }));
    const path = `../api/jobs/${begun.id}`;
    if (this.plan !== plan) {
      stop(path);
      return null;
    }
    this.job = path;
    for (;;) {
      const job = await fetched(path);
      if (this.job !== path) return null;
      this.bar.value = job.progress;
      if (job.status === "queued" || job.status === "running") {
        await new Promise((resolve) => setTimeout(resolve, LOOK_EVERY_MS));
        continue;
      }
      this.job = null;
      if (job.status !== "done") throw new Error(`${capital(job.message || say("rehearsal.ended"))}.`);
      return job.result;
    }
  }

  /** @param {Result} result */
  tell({ runs, held, of, success_low: low, success_high: high }) {
    const [run] = runs;
    this.verdicts = new Map(of === 1 ? run.steps.map((verdict) => [verdict.step, verdict]) : []);
    const often = say("rehearsal.held_in", { held, of, low: percent(low), high: percent(high) });
    this.say(of === 1 ? oneRun(run) : often, false);
    this.dispatchEvent(new Event("change"));
  }

  close() {
    if (this.job) stop(this.job);
    this.plan = this.job = null;
    this.root.hidden = true;
    this.button.disabled = false;
    if (this.verdicts.size) {
      this.verdicts = new Map();
      this.dispatchEvent(new Event("change"));
    }
  }

  /** @param {string} sentence @param {boolean} isRunning */
  say(sentence, isRunning) {
    this.root.hidden = false;
    this.note.textContent = sentence;
    this.bar.hidden = !isRunning;
    if (isRunning) this.bar.removeAttribute("value");
    this.often.hidden = isRunning;
    this.button.disabled = isRunning;
    this.end.textContent = isRunning ? say("jobs.cancel") : say("dialog.close");
  }
}

/** A verdict in a word, and whether the step held. @param {Verdict} verdict */
export function inAWord({ held, slid_mm: slid }) {
  if (!held) return say("rehearsal.lost");
  return slid < SLID_MM ? say("rehearsal.held") : say("rehearsal.slid", { length: slid.toFixed(0) });
}

/** @param {Run} run */
function oneRun({ held, steps, regrasps, replans }) {
  const lost = steps.find((verdict) => !verdict.held);
  if (lost) return say("rehearsal.lost_at", { step: lost.step + 1, length: lost.mean_mm.toFixed(0) });
  const again = regrasps && say("rehearsal.regrasps", { count: regrasps });
  const anew = replans && say("rehearsal.replans", { count: replans });
  const worst = Math.max(0, ...steps.map(({ mean_mm: mean }) => mean));
  const off = say("rehearsal.off", { length: worst.toFixed(0) });
  const told = [off, again, anew].filter(Boolean).join(", ");
  return held ? say("rehearsal.all_held", { told }) : say("rehearsal.broken_off");
}

/** @param {number} share */
const percent = (share) => Math.round(100 * share);

/** @param {string} job its path */
const stop = (job) => fetched(`${job}/cancel`, "POST").catch(() => {});
