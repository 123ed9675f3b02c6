/** A search for ways to fold a garment to a size: a job that lasts as long as somebody waits for it. */

import { capital } from "../dock/words.js";
import { jobEvents, Search } from "../event_stream.js";

/** @import { Garment, GarmentFold } from "pleat" */

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
/** The most cards while some are not planned yet. */
const CARDS_MAX = 6;

export class ProposalSearch extends Search {
  constructor() {
    super();
    /** @type {Proposal[]} in the order of arrival */
    this.found = [];
    /** @type {Proposal[]} that are not planned yet */
    this.untried = [];
    /** Whether it has come to its end. */
    this.isDone = false;
    /** The share that is done. */
    this.progress = 0;
    addEventListener("pagehide", () => this.stop());
  }

  /** @param {Asked} asked @param {number} delay_ms how long to wait first */
  start(asked, delay_ms) {
    return this.begin(delay_ms, async (signal) => {
      for await (const { event, data } of jobEvents("../api/proposals", asked, signal)) {
        if (event === "found") data.status === UNTRIED ? this.untried.push(data) : this.take(data);
        else this.progress = data.progress;
        this.isDone = event === "end" && data.status === "done";
        if (event === "end" && !this.isDone) this.fault = capital(data.message || data.status);
        this.tell();
      }
    });
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
    const left = this.isDone ? [] : this.untried.filter((one) => !looks.has(looksOf(one)));
    return [...this.found, ...left.slice(0, Math.max(CARDS_MAX - this.found.length, 0))];
  }

  forget() {
    super.forget();
    this.found = [];
    this.untried = [];
    this.progress = 0;
    this.isDone = false;
  }
}

/** @param {Proposal} proposal */
const looksOf = ({ folds, layers, size_m: sides }) => [folds.length, layers, ...sides.map((side) => side.toFixed(2))].join();
