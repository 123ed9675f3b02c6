/** What became of a rehearsal, in words. */

import { say } from "../language/say.js";

/** @import { Result, Run, Verdict } from "./rehearsal.js" */

/** A shorter slide need not be told (mm). */
const SLID_MM = 5;
/** So often the rest is planned again in a run before it is given up, as `app/rehearsal/perform.py` has it. */
const REPLANS_MAX = 3;

/** What became of a step. @param {Verdict} verdict @returns {"held"|"slid"|"lost"} */
export function fateOf({ held, slid_mm: slid }) {
  if (!held) return "lost";
  return slid < SLID_MM ? "held" : "slid";
}

/** A verdict in a word. @param {Verdict} verdict */
export function inAWord(verdict) {
  const fate = fateOf(verdict);
  return fate === "slid" ? say("rehearsal.slid", { length: verdict.slid_mm.toFixed(0) }) : say(`rehearsal.${fate}`);
}

/** The first step that was lost, counted from 1; null if none was. @param {Run} run */
export function lostAt({ steps }) {
  const lost = steps.find(({ held }) => !held);
  return lost ? (lost.of_plan ?? lost.step) + 1 : null;
}

/** How far the cloth was off on average after the worst step (mm). @param {Run} run */
export const worstOf = ({ steps }) => Math.max(0, ...steps.map(({ mean_mm: mean }) => mean));

/** @param {Result} result */
export function summary(result) {
  return result.of > 1 ? shareHeld(result) : oneRun(result.runs[0]);
}

/** How many runs held, and how many of all would. @param {Result} result */
export function shareHeld({ held, of, success_low: low, success_high: high }) {
  const told = { held, of, low: percent(low), high: percent(high) };
  return of > 1 ? say("rehearsal.held_in", told) : say("rehearsal.held_once", told);
}

/** What became of a run. @param {Run} run */
export function oneRun(run) {
  const { held, steps, regrasps, repairs, replans } = run;
  const lost = steps.find((verdict) => !verdict.held);
  if (lost) return say("rehearsal.lost_at", { step: lostAt(run) ?? 0, length: lost.mean_mm.toFixed(0) });
  const again = regrasps && say("rehearsal.regrasps", { count: regrasps });
  const laid = repairs && say("rehearsal.repairs", { count: repairs });
  const anew = replans && say("rehearsal.replans", { count: replans });
  const off = say("rehearsal.off", { length: worstOf(run).toFixed(0) });
  const told = [off, again, laid, anew].filter(Boolean).join(", ");
  return held ? say("rehearsal.all_held", { told }) : brokenOff(run);
}

/** Why a run ended early, told by what feedback decided last. @param {Run} run */
function brokenOff({ decisions, replans }) {
  const last = decisions.at(-1);
  const step = (last?.step ?? 0) + 1;
  if (last?.code === "kept_blindly") return say("rehearsal.ended_blind", { step });
  if (last?.code === "fold_failed") return say("rehearsal.ended_failed", { share: percent(last.overlap ?? 0) });
  if (last?.code !== "replanned") return say("rehearsal.broken_off");
  if (replans <= REPLANS_MAX) return say("rehearsal.ended_off", { step });
  return say("rehearsal.ended_often", { step, count: REPLANS_MAX });
}

/** A run in a word. @param {Run} run */
export function fateInAWord({ held, steps }) {
  if (held) return say("rehearsal.held");
  return steps.some((verdict) => !verdict.held) ? say("rehearsal.lost") : say("rehearsal.ended_early");
}

/** @param {number} share */
const percent = (share) => Math.round(100 * share);
