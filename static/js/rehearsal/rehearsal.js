/**
 * The rehearsal of the plan on show: begun, followed and cancelled as a job; its runs, and the one that is looked at.
 * The job is kept in the browser's session, so that the page finds it again when it is loaded anew.
 */

import { fetched, goTo, OfflineError } from "../dialogs/documents.js";
import { capital } from "../dock/words.js";
import { sayable } from "../dom.js";
import { eventStream, rest } from "../event_stream.js";
import { say } from "../language/say.js";
import { isViewOnly } from "../view_only.js";

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
const BEGUN = "pleat-rehearsals-begun";
/** Of so many jobs the browser knows which plan of which document they rehearse. */
const BEGUN_MAX = 50;
/** The list of jobs is looked through so often for one that was begun as the page was left. */
const LOOKS_MAX = 20;
/** The server's clock may be that much behind (ms). */
const CLOCKS_APART_MS = 2000;

/** @typedef {{plan: string, job: string|null, since: number}} Kept the job, null before its number is known, and when it was asked for (ms) */

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
    /** @type {AbortController|null} of what follows it */
    this.abort = null;
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
    const kept = plan && this.plan === null && !isViewOnly ? recalled(this.store.id) : null;
    if (kept && kept.plan === plan?.id) this.perform(kept, async () => kept.job ?? this.lookFor(kept.since));
  }

  /** The newest rehearsal of this garment that was asked for since then; empty if there is none. @param {number} since ms */
  async lookFor(since) {
    const about = this.store.state?.garment.title;
    for (let looks = 0; looks < LOOKS_MAX; looks += 1) {
      const { jobs } = /** @type {{jobs: Job[]}} */ (await fetched("../api/jobs?limit=20"));
      /** @param {Job} job */
      const isIt = (job) =>
        job.kind === "rehearsals" && job.about === about && Date.parse(job.created) > since - CLOCKS_APART_MS;
      const found = jobs.find(isIt);
      if (found) return found.id;
      await new Promise((resolve) => setTimeout(resolve, LOOK_EVERY_MS));
    }
    return "";
  }

  /** Whether a job is known to rehearse the plan on show. @param {string} job its id */
  isAbout(job) {
    return begunAs(job)?.plan === this.rehearsable?.id;
  }

  /** The other document in which a job was begun; empty where that is not known. @param {string} job its id */
  elsewhere(job) {
    const { document = "" } = begunAs(job) ?? {};
    return document === this.store.id ? "" : document;
  }

  /** Have the page of the document in which a job was begun show its result. @param {string} job its id */
  openThere(job) {
    const begun = begunAs(job);
    if (!begun) return;
    remember(begun.document, { plan: begun.plan, job, since: Date.now() });
    goTo(begun.document);
  }

  /** Show the result of a job that rehearsed the plan on show. @param {string} job its id */
  showAgain(job) {
    const plan = this.rehearsable?.id;
    if (!plan) return;
    this.close();
    this.perform({ plan, job, since: Date.now() }, async () => job);
  }

  /** @param {Asked} asked */
  begin(asked) {
    const plan = this.rehearsable?.id;
    if (!plan) return;
    this.close();
    this.perform({ plan, job: null, since: Date.now() }, async () => {
      const begun = /** @type {Job} */ (await fetched("../api/rehearsals", "POST", { plan, feedback: true, ...asked }));
      return begun.id;
    });
  }

  /** Follow a job to its end. @param {Kept} kept @param {() => Promise<string>} begun the job's id; empty if there is none */
  async perform(kept, begun) {
    const { plan } = kept;
    this.plan = plan;
    remember(this.store.id, kept);
    this.isRunning = true;
    this.tell();
    const { signal } = (this.abort = new AbortController());
    try {
      const id = await begun();
      const path = `../api/jobs/${id}`;
      if (signal.aborted) {
        if (id) stop(path);
        return;
      }
      if (!id) {
        this.close();
        return;
      }
      this.job = path;
      remember(this.store.id, { ...kept, job: id });
      rememberBegun({ job: id, plan, document: this.store.id });
      this.take(await this.end(path, signal));
    } catch (error) {
      if (signal.aborted) return;
      this.fault = sayable(error);
      this.isRunning = false;
      this.job = null;
      if (!(error instanceof OfflineError)) remember(this.store.id, null);
      this.tell();
    }
  }

  /**
   * Follow a job to its result. Without a server it goes on, as it does while the page is loaded anew.
   * @param {string} path
   * @param {AbortSignal} signal
   * @returns {Promise<Result>}
   */
  async end(path, signal) {
    for (;;) {
      try {
        for await (const { event, data: job } of eventStream(`${path}/events`, null, signal)) {
          if (event === "end" && job.status === "done") return job.result;
          if (event === "end") throw new Error(`${capital(job.message || say("rehearsal.ended"))}.`);
          this.progress = job.progress;
          this.tell();
        }
      } catch (error) {
        if (!(error instanceof TypeError)) throw error; // else the server cannot be reached
      }
      await rest(LOOK_EVERY_MS, signal);
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
    const { abort } = this;
    const trace = id ? await fetched(`../api/rehearsals/traces/${id}`).catch(() => null) : null;
    if (this.abort !== abort || this.chosen !== index) return;
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
    this.abort?.abort();
    this.abort = null;
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

/** @param {string} id the document's @param {Kept|null} kept */
function remember(id, kept) {
  if (kept) sessionStorage.setItem(`${KEPT}-${id}`, JSON.stringify(kept));
  else sessionStorage.removeItem(`${KEPT}-${id}`);
}

/** @param {string} id the document's @returns {Kept|null} */
const recalled = (id) => JSON.parse(sessionStorage.getItem(`${KEPT}-${id}`) ?? "null");

/** @typedef {{job: string, plan: string, document: string}} Begun a job, by its id, and what it rehearses */

/** Jobs that this browser began or followed, the newest first. @returns {Begun[]} */
const begunHere = () => JSON.parse(localStorage.getItem(BEGUN) ?? "[]");

/** What a job rehearses, where this browser knows it. @param {string} job its id */
const begunAs = (job) => begunHere().find((one) => one.job === job);

/** @param {Begun} begun */
function rememberBegun(begun) {
  const others = begunHere().filter(({ job }) => job !== begun.job);
  localStorage.setItem(BEGUN, JSON.stringify([begun, ...others].slice(0, BEGUN_MAX)));
}
