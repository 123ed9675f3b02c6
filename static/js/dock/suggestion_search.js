/** A search for what would help: asks the server, and gathers its answers as they come. */

import { eventStream, Search } from "../event_stream.js";

/** @import { Preview } from "../store.js" */
/** @import { DocumentState, GarmentFold, Pose, Says, SuggestionEvent, TryingEvent } from "pleat" */

/**
 * A change that is offered.
 * @typedef {object} Suggestion
 * @property {SuggestionEvent["kind"]|"quick_fix"} kind
 * @property {boolean} is_assumption
 * @property {string} message
 * @property {Says} says
 * @property {Preview} change
 * @property {number} size
 * @property {number|null} cost_s of the plan with the change; null if that is not known
 * @property {string|null} plan_id of that plan
 */

const ADDRESS = "../api/suggestions";
const WORK_S = 10;
/** So much time, so that mostly the work ends a search and what is shown does not depend on how busy the machine is. */
const TIME_LIMIT_S = 60;

export class SuggestionSearch extends Search {
  constructor() {
    super();
    /** @type {SuggestionEvent[]} in the order of arrival */
    this.found = [];
    /** What is being tried. @type {TryingEvent|null} */
    this.trying = null;
    /** Whether every change that could be tried was, before the work was done. */
    this.isComplete = false;
  }

  /**
   * Search for a document's drawing.
   * @param {DocumentState} state
   * @param {{delay_ms?: number, work_s?: number, known?: () => string|undefined}} how how long to wait first, the work
   *   that the search may do, and what tells the id of the answer to the drawing
   */
  start(state, { delay_ms = 0, work_s = WORK_S, known = () => undefined } = {}) {
    return this.begin(delay_ms, async (signal) => {
      const asked = { ...request(state), time_limit_s: TIME_LIMIT_S, work_limit_s: work_s };
      const id = known();
      const address = id ? `${ADDRESS}?${new URLSearchParams({ known: id })}` : ADDRESS;
      for await (const { event, data } of eventStream(address, asked, signal)) {
        if (event === "done") this.isComplete = data.complete === true;
        if (event === "trying") this.trying = data;
        if (event !== "suggestion") continue;
        this.found.push(data);
        this.tell();
      }
    });
  }

  /** Search no more, and forget what was found. */
  stop() {
    this.forget();
    this.tell();
  }

  forget() {
    super.forget();
    this.found = [];
    this.trying = null;
    this.isComplete = false;
  }
}

/** @param {DocumentState} state */
export function request({ garment, drawing }) {
  const { robot, placement, scene, start_station, comfort_radius_m } = drawing;
  return { garment, robot, placement, scene, start_station, comfort_radius_m };
}

/** Nearer than this two changes are one, unless the larger one's plan is cheaper by so much (m, s). */
const SAME_M = 0.01;
const WORTH_S = 1;

/** What is easily done, and leaves the cloth folded as it is drawn, comes first. */
const CHANGED = ["placement", "order", "split", "fold_line", "flip", "halve", "station", "robot", "size"];
const EASE = [...CHANGED, "friction", "grip_radius", "comfort_radius", "together"];

/**
 * The order in which suggestions are offered: of each kind the smallest change first, then those that save more; what
 * a person can do before what would have to be assumed.
 * @param {SuggestionEvent[]} found
 * @returns {SuggestionEvent[]}
 */
export function ranked(found) {
  const kinds = [...new Set(found.map((one) => one.kind))];
  kinds.sort((a, b) => EASE.indexOf(a) - EASE.indexOf(b));
  const groups = kinds.map((kind) => {
    const group = found.filter((one) => one.kind === kind);
    return kind === "robot" ? [quickest(group)] : cheaperAsTheyGrow(group);
  });
  const isFirst = new Set(groups.map(([first]) => first));
  /** @param {SuggestionEvent} one */
  const rank = (one) => 2 * Number(one.is_assumption) + Number(!isFirst.has(one));
  return groups.flat().sort((a, b) => rank(a) - rank(b));
}

/** @param {SuggestionEvent[]} group */
const quickest = (group) => group.reduce((best, one) => (one.cost_s < best.cost_s ? one : best));

/**
 * Smallest first; a larger change only if its plan is cheaper than those of all smaller ones, and of two alike one.
 * @param {SuggestionEvent[]} group
 */
function cheaperAsTheyGrow(group) {
  const inOrder = group.toSorted((a, b) => a.size - b.size);
  return inOrder
    .filter((one, index) => inOrder.slice(0, index).every((smaller) => one.cost_s < smaller.cost_s))
    .reduce((kept, one) => {
      const twin = kept.find((other) => isAlike(one, other));
      if (!twin) return [...kept, one];
      return twin.cost_s - one.cost_s > WORTH_S ? kept.map((other) => (other === twin ? one : other)) : kept;
    }, /** @type {SuggestionEvent[]} */ ([]));
}

/**
 * Whether the cloth, or the folds, would come to lie nearly the same.
 * @param {SuggestionEvent} one
 * @param {SuggestionEvent} other
 */
function isAlike({ kind, change: one }, { change: other }) {
  if (kind === "placement") return isNear(place(one.placement), place(other.placement));
  return kind === "fold_line" && isNear(ends(one.garment?.folds), ends(other.garment?.folds));
}

/** A turn counts as the way of what is a metre away. @param {Pose|null} pose */
const place = (pose) => (pose ? [pose.x_m, pose.y_m, Math.cos(pose.yaw_rad), Math.sin(pose.yaw_rad)] : []);
/** @param {GarmentFold[]|undefined} folds */
const ends = (folds = []) => folds.flatMap(({ start, end }) => [...start, ...end]);
/** @param {number[]} one @param {number[]} other */
const isNear = (one, other) =>
  one.length === other.length && one.every((value, index) => Math.abs(value - other[index]) <= SAME_M);
