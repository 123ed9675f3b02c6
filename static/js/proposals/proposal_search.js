/** A search for ways to fold a garment to a size: a job that lasts as long as somebody waits for it. */

import { fetched } from "../dialogs/documents.js";
import { capital } from "../dock/words.js";
import { jobEvents, Search } from "../event_stream.js";

/** @import { Garment, GarmentFold, RobotEntry } from "pleat" */

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
 * @property {number} number equal for one and what stands in for it; 0 of one that is not planned yet or does not fit
 * @property {string} [plan_id] none before it is planned
 */
/** @typedef {{robot: string, scene?: object, placement?: object|null, start_station?: string}} Asked the body of the request, as JSON */

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
    /** @type {Proposal[]} that do not fit but can be done, the nearest first */
    this.near = [];
    /** The title of another robot that can do one where this one can do nothing. */
    this.other = "";
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
        if (event === "found" && data.number) this.take(data);
        else if (event === "found") (data.status === UNTRIED ? this.untried : this.near).push(data);
        else this.progress = data.progress;
        this.isDone = event === "end" && data.status === "done";
        if (event === "end" && !this.isDone) this.fault = capital(data.message || data.status);
        this.tell();
      }
      if (this.isUnable && !this.near.length) this.other = await able(asked, signal);
    });
  }

  /** Whether the robot can do none of the ways that were tried. */
  get isUnable() {
    return this.isDone && this.found.length > 0 && this.found.every(({ cost_s: cost }) => cost === null);
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
    const tried = [...this.near, ...this.found];
    const looks = new Set(tried.map(looksOf));
    const left = this.isDone ? [] : this.untried.filter((one) => !looks.has(looksOf(one)));
    return [...tried, ...left.slice(0, Math.max(CARDS_MAX - tried.length, 0))];
  }

  forget() {
    super.forget();
    this.found = [];
    this.untried = [];
    this.near = [];
    this.other = "";
    this.progress = 0;
    this.isDone = false;
  }
}

/**
 * The title of the first other robot that can do one, at the table and the place that suit it, those with more arms
 * first; empty where there is none.
 * @param {Asked} asked @param {AbortSignal} signal
 */
async function able({ scene, placement, start_station: start, ...asked }, signal) {
  const robots = /** @type {RobotEntry[]} */ (await fetched("../api/robots"));
  robots.sort((one, other) => other.arms.length - one.arms.length);
  for (const { name, title } of robots.filter(({ name }) => name !== asked.robot)) {
    const wanted = { ...asked, robot: name, count: 1, untried: 0 };
    for await (const { event, data } of jobEvents("../api/proposals", wanted, signal))
      if (event === "found" && data.cost_s !== null) return title;
  }
  return "";
}

/** @param {Proposal} proposal */
const looksOf = ({ folds, layers, size_m: sides }) => [folds.length, layers, ...sides.map((side) => side.toFixed(2))].join();
