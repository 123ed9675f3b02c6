/** Why there is no plan, as one short sentence; `details` has all the numbers. */

import { say } from "../language/say.js";
import { inWords } from "../messages/in_words.js";
import { enough, length } from "../messages/lengths.js";
import { called, place, word } from "../messages/names.js";
import { draggedBy, lack, roundedUp, SMALL_M, toldReason } from "../messages/reasons.js";
import { foldName } from "./step_kinds.js";
import { capital, seconds } from "./words.js";

/** @import { DocumentState, Drawing, DrawingProblem, PlanMessage, Reason, Says } from "pleat" */
/** @import { Named } from "../messages/names.js" */

/** The fold that a reason is about, in front of what is said of it. @param {Reason} reason @param {Named[]} folds */
const of = ({ fold }, folds) => (fold === null ? "" : `${called(folds, fold)}: `);

/** Statuses for which there is no plan and nothing is being worked out. */
export const NO_PLAN = new Set(["infeasible", "budget_exceeded", "illegal", "failed"]);

/** @type {Record<string, (reason: Reason) => string>} */
const SAYS = {
  out_of_reach: outOfReach,
  too_many_grips: ({ needed_grip_radius_m: radius }) =>
    radius ? say("why.too_many_grips.unless", { radius: enough(radius) }) : say("why.too_many_grips"),
  grips_too_close: tooClose,
  red_needs_hold: ({ needed_grip_radius_m: radius }) => say(radius ? "why.red_held_too_far" : "why.red_unheld"),
  not_a_g_state: atRest,
  slips: ({ needed_friction: friction }) =>
    friction ? say("why.slips.unless", { friction: roundedUp(friction) }) : say("why.slips"),
  collision: () => say("why.collision"),
  waits_for_fold: () => say("why.waits_for_fold"),
};

/**
 * A reason without the drag before it, for which there may be no room.
 * @param {Reason} reason
 * @param {Named[]} folds
 */
export function sentence(reason, folds) {
  const here = { ...reason, says: reason.says && { ...reason.says, dragged: null } };
  const told = SAYS[reason.code]?.(reason) || inWords(here, folds).split(". ")[0];
  return `${reason.fold === null ? capital(told) : `${capital(foldName(folds[reason.fold], reason.fold))}: ${told}`}.`;
}

/** What stands in the way first, in words. @param {PlanMessage} message @param {DocumentState} state */
export function headline(message, state) {
  if (message.status === "illegal") return problemSentence(state.problems[0], state.drawing);
  if (message.status === "budget_exceeded") return say("why.searched", { ways: ways(message) });
  const first = firstReason(message);
  if (message.status === "infeasible" && first) return sentence(first, state.drawing.folds);
  return told(message);
}

/**
 * The same with all that helps where there is more room: how far a search came that did not come to an end, how far the
 * cloth had been dragged by then.
 * @param {PlanMessage} message
 * @param {DocumentState} state
 */
export function explanation(message, state) {
  if (message.status === "budget_exceeded") return told(message);
  const first = message.status === "infeasible" ? firstReason(message) : undefined;
  const way = first ? draggedBy(first) : "";
  const after = way && say("why.after_drag", { way });
  return headline(message, state).replace(/\.$/, `${after}.`);
}

/** How many ways were looked at before the search was given up. @param {PlanMessage} message */
const ways = (message) => say("why.ways", { count: message.plan?.statistics?.ways ?? 0 });

/** @param {PlanMessage} message */
const firstReason = (message) => toldReason(message.plan?.reasons ?? []);

/** What the server says, as a sentence. @param {PlanMessage} message */
const told = (message) =>
  `${outOfTime(message) || capital(message.text.replace(/^No plan:? */, "") || say("why.none_found"))}.`;

/** How far a search came that was given up, and what would take it further; empty if none was. @param {PlanMessage} message */
function outOfTime(message) {
  const least = message.plan?.statistics?.bound_s;
  if (message.status !== "budget_exceeded" || least === undefined) return "";
  if (least === null) return say("why.out_of_time", { ways: ways(message) });
  return say("why.out_of_time.bound", { ways: ways(message), least: seconds(least) });
}

/**
 * Everything that is known about why, with all the numbers.
 * @param {PlanMessage} message
 * @param {DocumentState} state
 */
export function details(message, state) {
  const { folds } = state.drawing;
  if (state.problems.some((problem) => problem.code === "outline_unfinished")) return [];
  if (message.status === "illegal") return state.problems.map((problem) => problemSentence(problem, state.drawing));
  const all = (message.plan?.reasons ?? []).filter((reason) => reason.message);
  return all.map((reason) => `${of(reason, folds)}${inWords(reason, folds)}.${untried(reason)}`).map(capital);
}

/**
 * What is said of a reason that was met, but of which nobody knows that there is a plan without it.
 * @param {{set?: number|null, code: string}} reason
 */
const untried = ({ set, code }) => (set === null && code !== "waits_for_fold" ? say("why.untried") : "");

/** @param {DrawingProblem|undefined} problem @param {Drawing} drawing */
function problemSentence(problem, drawing) {
  if (!problem) return say("why.not_finished");
  if (problem.code === "outline_unfinished") {
    if (drawing.outline.length) return say("why.three_points");
    return say("why.nothing_drawn");
  }
  const what = problem.fold === null ? subject(problem.field) : foldName(drawing.folds[problem.fold], problem.fold);
  return `${capital(what)}: ${inWords(problem, drawing.folds)}.`;
}

/** @param {string} field */
function subject(field) {
  return word("subject", field.startsWith("outline") ? "outline" : field);
}

/** How the cloth lies at the start or after a fold, in the page's unit; nothing of what comes before. @param {Reason} reason */
function atRest({ says }) {
  const what = /** @type {Says} */ (says.what);
  if (says.code === "at_start") return resting(what);
  if (says.code !== "afterwards") return "";
  const why = resting(what) || inWords({ says: what, message: "" }, []).split(". ")[0];
  return say("message.afterwards", { why, carried: "" });
}

/** How cloth lies that does not stay there, where that is soon said. @param {Says} what */
function resting({ code, edge, beyond_m: beyond, off_m: off }) {
  if (code === "hangs_loose") return say("why.hangs_loose", { length: length(beyond), edge: word("edge", edge) });
  if (code === "beside_table")
    return off < SMALL_M ? say("message.beside_table.at_edge") : say("why.beside_table", { length: length(off) });
  return code === "corner_covered" ? say("why.corner_covered") : "";
}

/** @param {Reason} reason */
function outOfReach({ says, ...reason }) {
  const { arm, station } = reason;
  const from = station ? say("why.best_from", { station: place(station) }) : "";
  const told = lack({ ...reason, ...says });
  return say("why.out_of_reach", { arm: word("arm", arm ?? "nearest"), lack: told, from });
}

/** How much too close two hands would be; nothing where only wider grips help, which the message says. @param {Reason} reason */
function tooClose({ says }) {
  const { code, apart_m: apart, needed_apart_m: needed } = /** @type {Says} */ (says);
  return code === "grips_too_close" ? say("why.grips_too_close.by", { length: length(needed - apart) }) : "";
}
