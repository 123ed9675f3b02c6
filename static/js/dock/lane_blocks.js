/** What base and arms do in a plan, as blocks on a lane each. */

import { say } from "../language/say.js";
import { length } from "../messages/lengths.js";
import { foldOf, holdsOn, kindOf } from "./step_kinds.js";
import { hands, seconds, where, whole } from "./words.js";

/** @import { Fold, Plan, PlanStart, Primitive } from "pleat" */

/**
 * What an arm or the base does in a primitive: `name` and, where there is room, `rest`, or where there is little a
 * fold's `number`; `about` is all of it.
 * @typedef {object} Block
 * @property {number} index of the primitive
 * @property {string} kind
 * @property {string} colour of a fold
 * @property {string} number
 * @property {string} name
 * @property {string} rest
 * @property {string} about
 * @property {number} start_s
 * @property {number} duration_s
 * @property {boolean} isHolding whether the hands hold on after it
 */

/** @typedef {{name: string, number?: string, rest?: string, kind?: string, colour?: string, base?: string}} Told */

const MOVED_M = 0.001;

/**
 * @param {Plan|null} plan
 * @param {Fold[]} folds the garment's
 * @param {PlanStart|null} start from where the plan starts; null: as drawn
 * @param {string[]} arms the robot's, by name
 * @returns {{base: Block[], arms: Record<string, Block[]>}}
 */
export function laneBlocks(plan, folds, start = null, arms = []) {
  const primitives = plan?.primitives ?? [];
  /** @param {string} name */
  const arm = (name) =>
    primitives.flatMap((primitive, index) =>
      primitive.grips.some((grip) => grip.arm === name) ? [armBlock(primitive, index, folds)] : [],
    );
  /** @param {number} index how far the base is backed off before a primitive (m) */
  const backOff = (index) => (primitives[index - 1] ?? start)?.base.back_off_m ?? 0;
  const base = primitives.flatMap((primitive, index) => baseBlock(primitive, index, backOff(index), folds) ?? []);
  return { base, arms: Object.fromEntries(arms.map((name) => [name, arm(name)])) };
}

/** @param {Primitive} primitive @param {number} index @param {Fold[]} folds @returns {Block} */
function armBlock(primitive, index, folds) {
  const name = kindOf(primitive).lane(primitive, folds);
  const fold = foldOf(primitive);
  if (fold === undefined) return block(primitive, index, folds, { name });
  return block(primitive, index, folds, { name, number: String(fold + 1), colour: folds[fold]?.kind ?? "" });
}

/**
 * What the base does meanwhile; during a fold it may back off or come nearer.
 * @param {Primitive} primitive
 * @param {number} index
 * @param {number} backOff before it (m)
 * @param {Fold[]} folds
 * @returns {Block|null}
 */
function baseBlock(primitive, index, backOff, folds) {
  const { moves, lane } = kindOf(primitive);
  if (moves === "base") return block(primitive, index, folds, { name: lane(primitive, folds) });
  const further = primitive.base.back_off_m - backOff;
  if (Math.abs(further) < MOVED_M) return null;
  const [name, rest] = [length(Math.abs(further)), say(further > 0 ? "lane.back" : "lane.ahead")];
  return block(primitive, index, folds, { name, rest, kind: "move", base: say("lane.drives", { name, rest }) });
}

/** @param {Primitive} primitive @param {number} index @param {Fold[]} folds @param {Told} told @returns {Block} */
function block(primitive, index, folds, told) {
  const { name, number = "", rest = "", kind = primitive.kind, colour = "", base = "" } = told;
  const { start_s: start, duration_s: duration } = primitive;
  const holds = holdsOn(primitive);
  const by = hands(primitive);
  const at = where(primitive);
  const how = [by && say("lane.by_hands", { hands: by }), at && say("lane.at", { place: at })];
  const parts = [whole(primitive, folds), ...how, base, holds ? say("lane.holds_on") : ""];
  const when = say("lane.from_to", { start: seconds(start), end: seconds(start + duration) });
  const about = [...parts.filter(Boolean), when].join(", ");
  const isHolding = holds && kind === primitive.kind;
  return { index, kind, colour, number, name, rest, about, start_s: start, duration_s: duration, isHolding };
}

/**
 * @param {Plan|null} plan
 * @param {number} t_s
 * @returns {number} the primitive that is going on, -1 without one; at the end the last
 */
export function primitiveAt(plan, t_s) {
  const primitives = plan?.primitives ?? [];
  return primitives.findLastIndex((primitive) => t_s >= primitive.start_s);
}
