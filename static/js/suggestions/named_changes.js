/**
 * The changes that reasons name as enough, as in `13.5 cm would do`: the server has planned with each, so that they are
 * offered at once, and each says the amount that its reason says.
 */

/** @import { DocumentState, PlanMessage, Reason, Says } from "pleat" */
/** @import { Suggestion } from "../dock/suggestion_search.js" */

/** @typedef {{kind: Suggestion["kind"], says: Says, size: number}} Part what is changed, in words as data, and by how much */

/** Kinds of parts that nobody can carry out. */
const ASSUMED = new Set(["friction", "grip_radius", "comfort_radius", "together"]);

/** Amounts are told up to these, as reasons tell them (a coefficient, m). */
const FRICTION = 0.01;
const RADIUS_M = 0.001;

/**
 * @param {PlanMessage|null} message
 * @param {DocumentState|null} state
 * @returns {Suggestion[]} the least of each kind, in the order of the reasons
 */
export function namedChanges(message, state) {
  const plan = message?.plan;
  if (!plan || plan.is_stale || !state || message.version !== state.version) return [];
  /** @type {Map<string, Suggestion>} */
  const found = new Map();
  for (const { change, gives } of plan.reasons) {
    const parts = gives === "plan" && change ? partsOf(change, state) : [];
    if (!change || !parts.length) continue;
    const [{ kind, says, size }] = parts.length > 1 ? [together(parts)] : parts;
    const known = found.get(kind);
    if (known && known.size <= size) continue;
    const rest = { is_assumption: ASSUMED.has(kind), message: "", cost_s: null, plan_id: null };
    found.set(kind, { kind, says, size, change, ...rest });
  }
  return [...found.values()];
}

/** @param {Part[]} parts @returns {Part} */
function together(parts) {
  const says = { code: "assume_together", parts: parts.map((part) => part.says) };
  return { kind: "together", says, size: parts.reduce((sum, { size }) => sum + size, 0) };
}

/**
 * What a change changes; empty where it changes anything that has no words.
 * @param {NonNullable<Reason["change"]>} change
 * @param {DocumentState} state
 */
function partsOf({ placement, scene, comfort_radius_m: comfort, garment, ...others }, { drawing, garment: drawn }) {
  /** @type {Part[]} */
  const parts = [];
  if (Object.keys(others).length) return [];
  if (placement) {
    const by = [placement.x_m - drawing.placement.x_m, placement.y_m - drawing.placement.y_m];
    parts.push({ kind: "placement", says: { code: "place", quarters: 0, by }, size: Math.hypot(...by) });
  }
  if (scene) {
    if (!isSameBut(scene, drawing.scene, "friction")) return [];
    const [friction, now] = [upTo(scene.friction ?? 0, FRICTION), drawing.scene.friction];
    parts.push({ kind: "friction", says: { code: "assume_friction", friction, now }, size: friction - now });
  }
  if (typeof comfort === "number") {
    const now = drawing.comfort_radius_m;
    parts.push({ kind: "comfort_radius", says: { code: "assume_comfort", comfort_m: comfort, now_m: now }, size: now - comfort });
  }
  if (garment) {
    const folds = garment.folds ?? [];
    const isAlike = folds.every((fold, index) => isSameBut(fold, drawn?.folds[index] ?? {}, "grip_radius_m"));
    const wider = folds.flatMap((fold, index) => (fold.grip_radius_m !== drawn?.folds[index]?.grip_radius_m ? index : []));
    if (!isAlike || !wider.length) return [];
    const radius = upTo(Math.max(...wider.map((index) => folds[index].grip_radius_m ?? 0)), RADIUS_M);
    const now = Math.min(...wider.map((index) => drawn?.folds[index]?.grip_radius_m ?? 0));
    const says = { code: "assume_grip_radius", grip_radius_m: radius, folds: wider };
    parts.push({ kind: "grip_radius", says, size: radius - now });
  }
  return parts;
}

/** @param {object} one @param {object} other @param {string} name of what may differ */
function isSameBut(one, other, name) {
  const [first, second] = [one, other].map((value) => JSON.stringify({ ...value, [name]: 0 }));
  return first === second;
}

/** @param {number} amount @param {number} step */
const upTo = (amount, step) => Math.ceil(amount / step - 1e-6) * step;
