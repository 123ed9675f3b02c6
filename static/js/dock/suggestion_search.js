/** A search for what would help: asks the server, and gathers its answers as they come. */

import { sayable } from "../dom.js";
import { eventStream } from "./event_stream.js";

/**
 * @typedef {object} Suggestion
 * @property {string} kind
 * @property {boolean} is_assumption
 * @property {string} message
 * @property {import("../messages/in_words.js").Says} says
 * @property {any} change fields of a plan request
 * @property {number} size
 * @property {number|null} cost_s of the plan with the change; null if that is not known
 */

const ADDRESS = "../api/suggestions";
const LIMIT_S = 10;

export class SuggestionSearch extends EventTarget {
  constructor() {
    super();
    /** @type {Suggestion[]} in the order of arrival */
    this.found = [];
    this.isRunning = false;
    /** Whether every change that could be tried was, before the time was up. */
    this.isComplete = false;
    this.fault = "";
  }

  /**
   * Search for a document's drawing, in place of what was searched for before. Tells "change" whenever there is news.
   * @param {any} state the server's `document` message
   * @param {{delay_ms?: number, limit_s?: number}} how how long to wait first, and what the search may take
   */
  async start(state, { delay_ms = 0, limit_s = LIMIT_S } = {}) {
    this.forget();
    const abort = new AbortController();
    this.abort = abort;
    this.isRunning = true;
    this.tell();
    try {
      await rest(delay_ms, abort.signal);
      const asked = { ...request(state), time_limit_s: limit_s };
      for await (const { event, data } of eventStream(ADDRESS, asked, abort.signal)) {
        if (event === "done") this.isComplete = data.complete === true;
        if (event !== "suggestion") continue;
        this.found.push(data);
        this.tell();
      }
    } catch (error) {
      if (!abort.signal.aborted) this.fault = sayable(error);
    }
    if (abort.signal.aborted) return; // another search may be running by now
    this.isRunning = false;
    this.tell();
  }

  /** Search no more, and forget what was found. */
  stop() {
    this.forget();
    this.tell();
  }

  forget() {
    this.abort?.abort();
    this.found = [];
    this.isRunning = false;
    this.isComplete = false;
    this.fault = "";
  }

  tell() {
    this.dispatchEvent(new Event("change"));
  }
}

function request({ garment, drawing }) {
  const { scene, start_station, comfort_radius_m } = drawing;
  return { garment, scene, start_station, comfort_radius_m };
}

function rest(delay_ms, signal) {
  return new Promise((resolve, reject) => {
    const timer = setTimeout(resolve, delay_ms);
    signal.addEventListener("abort", () => {
      clearTimeout(timer);
      reject(signal.reason);
    });
  });
}

/** Nearer than this two changes are one, unless the larger one's plan is cheaper by so much (m, s). */
const SAME_M = 0.01;
const WORTH_S = 1;

/** What is easily done comes first. */
const EASE = ["placement", "fold_line", "order", "station", "friction", "grip_radius", "comfort_radius"];

/**
 * The order in which suggestions are offered: of each kind the smallest change first, then those that save more; what
 * a person can do before what would have to be assumed.
 * @param {Suggestion[]} found
 * @returns {Suggestion[]}
 */
export function ranked(found) {
  const kinds = [...new Set(found.map((one) => one.kind))];
  kinds.sort((a, b) => EASE.indexOf(a) - EASE.indexOf(b));
  const groups = kinds.map((kind) => cheaperAsTheyGrow(found.filter((one) => one.kind === kind)));
  const isFirst = new Set(groups.map(([first]) => first));
  const rank = (one) => 2 * Number(one.is_assumption) + Number(!isFirst.has(one));
  return groups.flat().sort((a, b) => rank(a) - rank(b));
}

/** Smallest first; a larger change only if its plan is cheaper than those of all smaller ones, and of two alike one. */
function cheaperAsTheyGrow(group) {
  const inOrder = group.toSorted((a, b) => a.size - b.size);
  return inOrder
    .filter((one, index) => inOrder.slice(0, index).every((smaller) => one.cost_s < smaller.cost_s))
    .reduce((kept, one) => {
      const twin = kept.find((other) => isAlike(one, other));
      if (!twin) return [...kept, one];
      return twin.cost_s - one.cost_s > WORTH_S ? kept.map((other) => (other === twin ? one : other)) : kept;
    }, /** @type {Suggestion[]} */ ([]));
}

/** Whether the cloth, or the folds, would come to lie nearly the same. */
function isAlike({ kind, change: one }, { change: other }) {
  if (kind === "placement") return isNear(place(one.placement), place(other.placement));
  return kind === "fold_line" && isNear(ends(one.garment), ends(other.garment));
}

/** A turn counts as the way of what is a metre away. */
const place = ({ x_m, y_m, yaw_rad }) => [x_m, y_m, Math.cos(yaw_rad), Math.sin(yaw_rad)];
const ends = ({ folds }) => folds.flatMap(({ start, end }) => [...start, ...end]);
const isNear = (one, other) =>
  one.length === other.length && one.every((value, index) => Math.abs(value - other[index]) <= SAME_M);
