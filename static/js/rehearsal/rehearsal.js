/**
 * The rehearsal of the plan on show: begun, followed and cancelled as a job; its runs, and the one that is looked at.
 * The job is kept in the browser's session, so that the page finds it again when it is loaded anew.
 */

import { fetched } from "../dialogs/documents.js";
import { capital } from "../dock/words.js";
import { sayable } from "../dom.js";
import { say } from "../language/say.js";

/** @import { Job, Plan, Trace } from "pleat" */

/**
 * What became of a step; see `POST /api/rehearsals`. `of_plan` is the step of the plan as it was at first that it stands
 * for, null where there is none since the rest was planned again.
 * @typedef {object} Verdict
 * @property {number} step
 * @property {number|null} of_plan
 * @property {number} mean_mm
 * @property {number} slid_mm
 * @property {boolean} held
 */
/** @typedef {{held: boolean, steps: Verdict[], regrasps: number, repairs: number, replans: number, reason: string, trace: string|null, decisions: {step: number, code: string, overlap?: number}[]}} Run */
/** @typedef {{runs: Run[], held: number, of: number, success_low: number, success_high: number}} Result */
/** @typedef {{runs: number, noise: "none"|"real"}} Asked */

const LOOK_EVERY_MS = 500;
const KEPT = "pleat-rehearsal";

export class Rehearsal extends EventTarget {
  /** @param {import("../store.js").Store} store */
  constructor(store) {
    super();
    this.store = store;
    /** @type {string|null} the plan that is rehearsed or was */
    this.plan = null;
    this.isRunning = false;
    /** @type {string|null} the path of the job that runs */
    this.job = null;
    /** The share that is done; null before it is known. @type {number|null} */
    this.progress = null;
    /** @type {Result|null} */
    this.result = null;
    /** Why there is no result; empty if there may be one. */
    this.fault = "";
    /** The run that is looked at. */
    this.chosen = 0;
    /** @type {Trace|null} what became of the cloth in it, as soon as that is known */
    this.trace = null;
    for (const name of ["document", "plan"]) store.addEventListener(name, () => this.follow());
    store.addEventListener("connection", () => store.isLive && this.trace && this.showTrace(true));
  }

  /** The plan, if it is the drawing's and the last word on it. @returns {Plan|null} */
  get rehearsable() {
    const { plan: message, state } = this.store;
    const plan = message?.plan;
    const isLast = plan?.status === "solved" && plan.is_final && message?.version === state?.version;
    return plan && isLast && plan.primitives.length ? plan : null;
  }

  /** The run that is looked at. @returns {Run|null} */
  get run() {
    return this.result?.runs[this.chosen] ?? null;
  }

  /** Whether all runs held, as far as there is a result. */
  get isHeld() {
    return this.result?.held === this.result?.of;
  }

  /** What became of each step of the plan in that run, by its number. @returns {Map<number, Verdict>} */
  get verdicts() {
    const steps = this.run?.steps ?? [];
    return new Map(steps.flatMap((verdict) => (verdict.of_plan === null ? [] : [[verdict.of_plan, verdict]])));
  }

  /** A rehearsal is about one plan only; one that was begun before the page was loaded is taken up. */
  follow() {
    const plan = this.rehearsable;
    if (this.plan !== null && plan?.id !== this.plan) this.close();
    const kept = plan && this.plan === null ? recalled(this.store.id) : null;
    if (kept && kept.plan === plan?.id) this.perform(kept.plan, async () => kept.job);
  }

  /** @param {Asked} asked */
  begin(asked) {
    const plan = this.rehearsable?.id;
    if (!plan) return;
    this.close();
    this.perform(plan, async () => {
      const begun = /** @type {Job} */ (await fetched("../api/rehearsals", "POST", { plan, feedback: true, ...asked }));
      return begun.id;
    });
  }

  /** Follow a job to its end. @param {string} plan @param {() => Promise<string>} begun the job's id */
  async perform(plan, begun) {
    this.plan = plan;
    this.isRunning = true;
    this.tell();
    const own = (this.own = {});
    try {
      const id = await begun();
      const path = `../api/jobs/${id}`;
      if (this.own !== own) {
        stop(path);
        return;
      }
      this.job = path;
      remember(this.store.id, { plan, job: id });
      const result = await this.end(path, own);
      if (result) this.take(result);
    } catch (error) {
      if (this.own !== own) return;
      this.fault = sayable(error);
      this.isRunning = false;
      this.job = null;
      remember(this.store.id, null);
      this.tell();
    }
  }

  /** @param {string} path @param {object} own @returns {Promise<Result|null>} nothing if it was cancelled */
  async end(path, own) {
    for (;;) {
      const job = await fetched(path);
      if (this.own !== own) return null;
      this.progress = job.progress;
      if (job.status === "queued" || job.status === "running") {
        this.tell();
        await new Promise((resolve) => setTimeout(resolve, LOOK_EVERY_MS));
        continue;
      }
      if (job.status !== "done") throw new Error(`${capital(job.message || say("rehearsal.ended"))}.`);
      return job.result;
    }
  }

  /** @param {Result} result */
  take(result) {
    this.isRunning = false;
    this.job = null;
    this.result = result;
    this.choose(Math.max(0, result.runs.findIndex(({ held }) => !held)));
  }

  /** Look at a run. @param {number} index */
  async choose(index) {
    this.chosen = index;
    this.trace = null;
    this.tell();
    const id = this.run?.trace;
    const own = this.own;
    const trace = id ? await fetched(`../api/rehearsals/traces/${id}`).catch(() => null) : null;
    if (this.own !== own || this.chosen !== index) return;
    this.trace = trace;
    this.showTrace(trace !== null);
    this.tell();
  }

  /** Have the 3D view show the cloth of the run that is looked at, or none. @param {boolean} isShown */
  showTrace(isShown) {
    this.store.command({ do: "show_trace", trace: isShown ? (this.run?.trace ?? null) : null });
  }

  /** Forget the result, or cancel what runs. */
  close() {
    if (this.job) stop(this.job);
    if (this.trace) this.showTrace(false);
    if (this.plan !== null) remember(this.store.id, null);
    this.own = null;
    this.plan = this.job = this.progress = this.result = this.trace = null;
    this.isRunning = false;
    this.fault = "";
    this.chosen = 0;
    this.tell();
  }

  tell() {
    this.dispatchEvent(new Event("change"));
  }
}

/** @param {string} job its path */
const stop = (job) => fetched(`${job}/cancel`, "POST").catch(() => {});

/** @param {string} id the document's @param {{plan: string, job: string}|null} kept */
function remember(id, kept) {
  if (kept) sessionStorage.setItem(`${KEPT}-${id}`, JSON.stringify(kept));
  else sessionStorage.removeItem(`${KEPT}-${id}`);
}

/** @param {string} id the document's @returns {{plan: string, job: string}|null} */
const recalled = (id) => JSON.parse(sessionStorage.getItem(`${KEPT}-${id}`) ?? "null");
