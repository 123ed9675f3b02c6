/** Why there is no plan, as one short sentence; `details` has all the numbers. */

import { inWords } from "../messages/in_words.js";
import { enough, length } from "../messages/lengths.js";
import { called, place } from "../messages/names.js";
import { capital, foldName } from "./words.js";

/** @import { DocumentState, Drawing, DrawingProblem, PlanMessage, Reason, Says } from "pleat" */
/** @import { Named } from "../messages/names.js" */

/** The fold that a reason is about, in front of what is said of it. @param {Reason} reason @param {Named[]} folds */
const of = ({ fold }, folds) => (fold === null ? "" : `${called(folds, fold)}: `);

/** Statuses for which there is no plan and nothing is being worked out. */
export const NO_PLAN = new Set(["infeasible", "budget_exceeded", "illegal", "failed"]);

const UP_DOWN = 0.5;
/** A shorter drag need not be told (m). */
const DRAGGED_M = 1e-3;

/** @type {Record<string, (reason: Reason) => string>} */
const SAYS = {
  out_of_reach: outOfReach,
  too_many_grips: ({ needed_grip_radius_m: radius }) =>
    `needs more hands than there are${radius ? `, unless one holds all within ${enough(radius)}` : ""}`,
  grips_too_close: ({ short_by_m: short }) => `the two hands would be ${short ? `${length(short)} ` : ""}too close`,
  red_needs_hold: ({ needed_grip_radius_m: radius }) =>
    radius ? "the hands that still hold are too far from its corners" : "no hand still holds what it moves",
  not_a_g_state: atRest,
  slips: ({ needed_friction: friction }) =>
    `the cloth would slip off the table${friction ? `, unless friction were ${Math.ceil(100 * friction) / 100}` : ""}`,
  collision: () => "the arms would touch something on every way tried",
  line_off_table: ({ short_by_m: short }) => `its line lies ${short ? `${length(short)} ` : ""}beside the table`,
  waits_for_fold: () => "waits for a fold that cannot be done",
};

/**
 * @param {Reason} reason
 * @param {Named[]} folds
 */
export function sentence(reason, folds) {
  const says = SAYS[reason.code];
  const told = says?.(reason) || inWords(reason, folds).split(". ")[0];
  return `${reason.fold === null ? capital(told) : `${capital(foldName(folds[reason.fold], reason.fold))}: ${told}`}.`;
}

/**
 * What stands in the way first, in words.
 * @param {PlanMessage} message
 * @param {DocumentState} state
 */
export function headline(message, state) {
  if (message.status === "illegal") return problemSentence(state.problems[0], state.drawing);
  if (message.status === "budget_exceeded") return `Searched ${ways(message)} and found none.`;
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
  const by_m = message.status === "infeasible" ? Math.hypot(...(firstReason(message)?.offset_m ?? [0, 0])) : 0;
  const after = by_m < DRAGGED_M ? "" : `, after the cloth was dragged ${length(by_m)}`;
  return headline(message, state).replace(/\.$/, `${after}.`);
}

/** How many ways were looked at before the search was given up. @param {PlanMessage} message */
const ways = (message) => {
  const count = message.plan?.statistics?.ways ?? 0;
  return `${count.toLocaleString("en")} ${count === 1 ? "way" : "ways"}`;
};

/** @param {PlanMessage} message */
const firstReason = (message) => (message.plan?.reasons ?? []).find((reason) => reason.message);

/** What the server says, as a sentence. @param {PlanMessage} message */
const told = (message) => `${capital(message.text.replace(/^No plan:? */, "") || "None was found")}.`;

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
const untried = ({ set, code }) =>
  set === null && code !== "waits_for_fold" ? " Met on the way; not tried whether it is the cause." : "";

/** @param {DrawingProblem|undefined} problem @param {Drawing} drawing */
function problemSentence(problem, drawing) {
  if (!problem) return "The drawing is not finished.";
  if (problem.code === "outline_unfinished") {
    if (drawing.outline.length) return "The outline needs three points or more.";
    return "Nothing is drawn yet: draw an outline (P), or begin with a template.";
  }
  const what = problem.fold === null ? subject(problem.field) : foldName(drawing.folds[problem.fold], problem.fold);
  return `${capital(what)}: ${inWords(problem, drawing.folds)}.`;
}

/** @param {string} field */
function subject(field) {
  return field.startsWith("outline") ? "outline" : field.replaceAll("_", " ");
}

/** How the cloth lies at the start, in the page's unit; nothing of what comes later. @param {Reason} reason */
function atRest({ says }) {
  if (says.code !== "at_start") return "";
  const { code, edge, beyond_m: beyond, off_m: off } = /** @type {Says} */ (says.what);
  if (code === "hangs_loose") {
    return `the cloth hangs ${length(beyond)} over the table\u2019s ${edge} edge, and nothing holds it there`;
  }
  if (code === "beside_table") return `the cloth lies ${length(off)} beside the table`;
  return code === "corner_covered" ? "the cloth hangs over two edges of the table at a corner" : "";
}

/** @param {Reason} reason */
function outOfReach(reason) {
  const { arm, station, short_by_m: short, is_at_least: isAtLeast, comfort_m: comfort } = reason;
  if (reason.cause === "comfort_only") {
    return `within reach${from(station)} only with ${length(comfort ?? 0)} of comfort (${limit(reason) || "too far"})`;
  }
  const why = [cause(reason), limit(reason)].filter(Boolean).join(", ");
  const by = short ? `${isAtLeast ? "at least " : ""}${length(short)} short` : "out of reach";
  return `the ${arm ?? "nearest"} hand is ${by}${why ? ` (${why})` : ""}${from(station)}`;
}

/** @param {string|null} station */
const from = (station) => (station ? `, at best from ${place(station)}` : "");
/** @param {Reason} reason */
const limit = ({ joint }) => (joint ? `${joint} limit` : "");

/** @param {Reason} reason */
function cause({ cause: name, towards }) {
  const up = towards && Math.abs(towards[2]) > UP_DOWN ? (towards[2] < 0 ? " up" : " down") : "";
  if (name === "too_far") return `too far${up}`;
  if (name === "too_near") return `too near${up}`;
  return name === "own_body" ? "its own body is in the way" : "";
}
