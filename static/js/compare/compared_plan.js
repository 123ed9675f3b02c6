/** One of two plans that are compared: how a drawing is planned, and what is known of a plan's steps. */

import { ringOf } from "../board/curves.js";
import { sentenceOf } from "../dialogs/dialog.js";
import { say } from "../language/say.js";

/** @import { Drawing, Plan, Scene, StepPicture } from "pleat" */
/** @import { Named } from "../messages/names.js" */

/** @typedef {{folds: Named[], scene: Scene}} Folded what is folded, and where */
/**
 * What there is to compare: a plan, or why there is none.
 * @typedef {object} Compared
 * @property {Folded|null} drawing null where it could not be read
 * @property {Plan|null} plan
 * @property {StepPicture[]} pictures one more than the plan has steps
 * @property {string} problem
 */

/** A plan is looked for no longer than that (s). */
const TIME_LIMIT_S = 30;

/**
 * @param {Drawing} drawing
 * @param {string|null} known the id of its plan, where it has been planned
 * @param {AbortSignal} signal
 * @returns {Promise<Compared>}
 */
export async function comparedPlan(drawing, known, signal) {
  const plan = (known && (await told(`../api/plans/${known}`, signal))) || (await planned(drawing, signal));
  if (typeof plan === "string") return { drawing, plan: null, pictures: [], problem: plan };
  return storedPlan(drawing, plan, signal);
}

/** @param {Folded} drawing @param {Plan} plan @param {AbortSignal} signal @returns {Promise<Compared>} */
export async function storedPlan(drawing, plan, signal) {
  if (plan.status !== "solved") return { drawing, plan: null, pictures: [], problem: say("compare.no_plan") };
  const pictures = (await told(`../api/plans/${plan.id}/pictures`, signal)) ?? [];
  return { drawing, plan, pictures, problem: "" };
}

/** @param {string} path @param {AbortSignal} signal */
async function told(path, signal) {
  const answer = await fetch(path, { signal });
  return answer.ok ? answer.json() : null;
}

/** @param {Drawing} drawing @param {AbortSignal} signal @returns {Promise<Plan|string>} the plan, or what is wrong with the drawing */
async function planned(drawing, signal) {
  const answer = await fetch("../api/plans", {
    method: "POST",
    headers: { "content-type": "application/json" },
    body: JSON.stringify(requestOf(drawing)),
    signal,
  });
  const body = await answer.json();
  return answer.ok ? body : sentenceOf(body);
}

/** The request for the plan of a drawing. @param {Drawing} drawing */
function requestOf(drawing) {
  const { name, title, areal_density_kg_m2, thickness_m, grip_radius_m, folds } = drawing;
  const drawn = folds.map(({ name: called, kind, start, end, grip_radius_m: own }) => ({
    name: called,
    kind,
    start: start.point,
    end: end.point,
    grip_radius_m: own ?? grip_radius_m,
  }));
  const { placement, scene, start_station, robot, comfort_radius_m } = drawing;
  return {
    garment: { name, title, outline: ringOf(drawing), areal_density_kg_m2, thickness_m, grip_radius_m, folds: drawn },
    placement,
    scene,
    start_station,
    robot,
    comfort_radius_m,
    time_limit_s: TIME_LIMIT_S,
  };
}
