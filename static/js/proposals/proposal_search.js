/** A search for ways to fold a garment to a size: a job that lasts as long as somebody waits for it. */

import { fetched } from "../dialogs/documents.js";
import { capital } from "../dock/words.js";
import { sayable } from "../dom.js";
import { eventStream, rest } from "../event_stream.js";

/** @import { Garment, GarmentFold, Job } from "pleat" */

/**
 * A way to fold the garment; see `POST /api/proposals`.
 * @typedef {object} Proposal
 * @property {GarmentFold[]} folds
 * @property {Garment} garment with these folds
 * @property {[number, number]} size_m along the board's axes
 * @property {number} layers
 * @property {string} status of its plan
 * @property {number|null} cost_s
 * @property {boolean} is_loose whether its plan holds some cloth far from a hand
 * @property {number} number equal for one and what stands in for it
 * @property {string} [plan_id] none before it is planned
 */
/** @typedef {object} Asked the body of the request, as JSON */

const UNTRIED = "untried";

export class ProposalSearch extends EventTarget {
  constructor() {
    super();
    /** @type {Proposal[]} in the order of arrival */
    this.found = [];
    /** @type {Proposal[]} that are not planned yet */
    this.untried = [];
    this.isRunning = false;
    /** Whether it has come to its end. */
    this.isDone = false;
    /** The share that is done. */
    this.progress = 0;
    this.fault = "";
    /** @type {AbortController|null} of the search that is running */
    this.abort = null;
    addEventListener("pagehide", () => this.stop());
  }

  /**
   * Search in place of what was searched for before. Tells "change" whenever there is news.
   * @param {Asked} asked
   * @param {number} delay_ms how long to wait first
   */
  async start(asked, delay_ms) {
    this.forget();
    const { signal } = (this.abort = new AbortController());
    this.isRunning = true;
    this.tell();
    try {
      await rest(delay_ms, signal);
      await this.follow(await begun(asked, signal), signal);
    } catch (error) {
      if (!signal.aborted) this.fault = sayable(error);
    }
    if (signal.aborted) return; // another search may be running by now
    this.abort = null;
    this.isRunning = false;
    this.tell();
  }

  /** @param {string} path of the job @param {AbortSignal} signal */
  async follow(path, signal) {
    for await (const { event, data } of eventStream(`${path}/events`, null, signal)) {
      if (event === "found") data.status === UNTRIED ? this.untried.push(data) : this.take(data);
      else this.progress = data.progress;
      this.isDone = event === "end" && data.status === "done";
      if (event === "end" && !this.isDone) this.fault = capital(data.message || data.status);
      this.tell();
    }
  }

  /** A better one may come with the number of one that it stands in for. @param {Proposal} proposal */
  take(proposal) {
    const known = this.found.findIndex(({ number }) => number === proposal.number);
    this.found.splice(known < 0 ? this.found.length : known, 1, proposal);
  }

  /** Search no more; what was found stays. */
  stop() {
    this.abort?.abort();
    this.abort = null;
    this.isRunning = false;
    this.tell();
  }

  /** What was found and, until all is planned, what looks different. */
  get shown() {
    const looks = new Set(this.found.map(looksOf));
    return [...this.found, ...(this.isDone ? [] : this.untried.filter((one) => !looks.has(looksOf(one))))];
  }

  forget() {
    this.abort?.abort();
    this.found = [];
    this.untried = [];
    this.progress = 0;
    this.isRunning = this.isDone = false;
    this.fault = "";
  }

  tell() {
    this.dispatchEvent(new Event("change"));
  }
}

/** @param {Proposal} proposal */
const looksOf = ({ folds, layers, size_m: sides }) => [folds.length, layers, ...sides.map((side) => side.toFixed(2))].join();

/**
 * Begin the job; it is cancelled once nobody waits for it.
 * @param {Asked} asked
 * @param {AbortSignal} signal
 * @returns {Promise<string>} its path
 */
async function begun(asked, signal) {
  /** @type {Job} */
  const { id } = await fetched("../api/proposals", "POST", asked);
  const path = `../api/jobs/${id}`;
  const cancel = () => fetch(`${path}/cancel`, { method: "POST", keepalive: true }).catch(() => {});
  if (signal.aborted) cancel();
  signal.addEventListener("abort", cancel);
  return path;
}
