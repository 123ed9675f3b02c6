/**
 * Why hands do not suffice: every point that must be held, round each hand how far its grip holds, and a cross on every
 * point that is left. Which points the hands take is chosen here so that they hold as many as they can.
 */

import { say } from "../language/say.js";
import { crossAt, diamond } from "./draw_findings.js";
import { distance } from "./geometry.js";

/** @import { Point } from "pleat" */
/** @import { Items } from "./sheet.js" */

/** Reasons that are about what hands hold. */
const ABOUT_HANDS = new Set(["too_many_grips", "red_needs_hold"]);
const CROSS_PX = 9;
const BESIDE_PX = 14;

/** @param {import("./board.js").Board} board @returns {Items} */
export function drawHolds(board) {
  const { store, state, view, drawing } = board;
  const { plan, status } = store.plan ?? {};
  const reason = plan && !plan.is_stale && status === "infeasible" ? plan.reasons[0] : null;
  const checks = store.plan?.checks;
  if (!reason || reason.fold === null || !ABOUT_HANDS.has(reason.code)) return [];
  if (board.draft || board.isPlacing || !checks || checks.version !== state?.version) return [];
  const points = checks.folds[reason.fold]?.must_hold ?? [];
  const radius = drawing.folds[reason.fold]?.grip_radius_m ?? drawing.grip_radius_m;
  const taken = taking(points, radius, state.robot.arms.length);
  const isHeld = points.map((point) => taken.some((hand) => distance(hand, point) <= radius));
  return [
    ...taken.flatMap((hand, n) => span(`span${n}`, view.toPx(hand), radius * view.scale)),
    ...points.map((point, n) => diamond(`need${n}`, view.toPx(point))),
    ...points.flatMap((point, n) => (isHeld[n] ? [] : unheld(`left${n}`, view.toPx(point), view.width))),
  ];
}

/**
 * The points at which so many hands hold the most.
 * @param {Point[]} points
 * @param {number} radius how far round itself a grip holds (m)
 * @param {number} hands
 * @returns {Point[]}
 */
function taking(points, radius, hands) {
  let left = points;
  /** @type {Point[]} */
  const taken = [];
  while (left.length && taken.length < hands) {
    const held = left.map((hand) => left.filter((point) => distance(hand, point) <= radius));
    const most = held.reduce((best, one) => (one.length > best.length ? one : best));
    const hand = left[held.indexOf(most)];
    taken.push(hand);
    left = left.filter((point) => !most.includes(point));
  }
  return taken;
}

/** How far a grip holds. @param {string} key @param {Point} at px @param {number} r px @returns {Items} */
function span(key, [x, y], r) {
  return [
    { key, tag: "circle", class: "grip-span", cx: x, cy: y, r },
    { key: `${key}:hand`, tag: "circle", class: "grip", cx: x, cy: y, r: 12 },
  ];
}

/** A point for which no hand is left. @param {string} key @param {Point} at px @param {number} width of the board @returns {Items} */
function unheld(key, [x, y], width) {
  const isRight = x > width / 2;
  return [
    crossAt(key, [x, y], CROSS_PX),
    {
      key: `${key}:text`,
      tag: "text",
      class: "reason-text",
      x: x + (isRight ? BESIDE_PX : -BESIDE_PX),
      y: y - BESIDE_PX / 2,
      "text-anchor": isRight ? "start" : "end",
      text: say("holds.none_left"),
    },
  ];
}
