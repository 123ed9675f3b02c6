/** How far each fold is at a time of the plan. */

import { say } from "../language/say.js";
import { foldOf } from "./step_kinds.js";

/** @import { Plan } from "pleat" */

/** @typedef {"done"|"current"|"available"|"waiting"} FoldState */

const INSTANT_S = 1e-9;

/** What is said of a fold in each state. @type {Record<string, string>} */
export const STATE_WORDS = {
  done: say("fold_state.done"),
  current: say("fold_state.current"),
  available: say("fold_state.available"),
  waiting: say("fold_state.waiting"),
  none: "",
};

/**
 * @param {Plan|null} plan
 * @param {number} t_s
 * @param {number[]} before the folds that are done before the plan starts
 * @returns {FoldState[]} one for each fold of the plan; without a plan none
 */
export function foldStates(plan, t_s, before = []) {
  if (!plan) return [];
  const done = new Set(before);
  let current = -1;
  for (const primitive of plan.primitives) {
    const { start_s: start, duration_s: duration } = primitive;
    const fold = foldOf(primitive);
    if (fold === undefined) continue;
    if (t_s >= start + duration - INSTANT_S) done.add(fold);
    else if (t_s > start) current = fold;
  }
  return Array.from({ length: plan.dag.folds }, (_, fold) => {
    if (done.has(fold)) return "done";
    if (fold === current) return "current";
    return waitsFor(plan, fold).every((before) => done.has(before)) ? "available" : "waiting";
  });
}

/** @param {Plan|null} plan @param {number} fold @returns {number[]} the folds that come right before it */
export function waitsFor(plan, fold) {
  return edges(plan).flatMap(([from, to]) => (to === fold ? [from] : []));
}

/** @param {Plan|null} plan @param {number} fold @returns {number[]} the folds that come right after it */
export function before(plan, fold) {
  return edges(plan).flatMap(([from, to]) => (from === fold ? [to] : []));
}

/** @param {Plan|null} plan @returns {[number, number][]} */
const edges = (plan) => plan?.dag.edges ?? [];
