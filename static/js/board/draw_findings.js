/** What the planner found: what must be held and where hands grip, and what is wrong. */

import { left, minus, plus, times, unit as direction } from "./geometry.js";
import { path } from "./sheet.js";

/** @import { Point } from "pleat" */
/** @import { Item } from "./sheet.js" */

const CROSS_PX = 6;

/**
 * Must-hold corners and grips of the fold that is looked at.
 * @param {import("./board.js").Board} board
 * @returns {Item[]}
 */
export function drawChecks(board) {
  const checks = board.store.plan?.checks;
  const index = board.foldLookedAt;
  if (board.isPlacing || index === null || !checks || checks.version !== board.state?.version) return [];
  const found = checks.folds[index];
  if (!found) return [];
  return [
    ...found.must_hold.map((point, n) => diamond(`hold${n}`, board.view.toPx(point))),
    ...found.grips.flatMap((point, n) => grip(`grip${n}`, board.view.toPx(point))),
  ];
}

/** @param {string} key @param {Point} at @returns {Item} */
export function diamond(key, [x, y]) {
  const r = 7;
  return {
    key,
    tag: "path",
    class: "must-hold",
    d: path([
      [x, y - r],
      [x + r, y],
      [x, y + r],
      [x - r, y],
    ]),
  };
}

/** @param {string} key @param {Point} at @returns {Item[]} */
function grip(key, [x, y]) {
  return [
    { key, tag: "circle", class: "grip", cx: x, cy: y, r: 12 },
    { key: `${key}:x`, tag: "path", class: "grip", d: `M${x - 4} ${y}h8M${x} ${y - 4}v8` },
  ];
}

/** What is wrong with the drawing, where it is. @param {import("./board.js").Board} board */
export function drawProblems({ state, view, draft }) {
  if (draft || !state) return [];
  return state.problems.flatMap(({ points, lines }, n) => [
    ...lines.flatMap(([a, b], m) => double(`p${n}:l${m}`, [view.toPx(a), view.toPx(b)])),
    ...points.map((point, m) => crossAt(`p${n}:${m}`, view.toPx(point))),
  ]);
}

/** Two thin lines, three pixels in all. @param {string} key @param {Point[]} line its two ends (px) */
export function double(key, [a, b]) {
  const aside = times(left(direction(minus(b, a))), 1.6);
  const d = path([plus(a, aside), plus(b, aside)], false) + path([minus(a, aside), minus(b, aside)], false);
  return [
    { key: `${key}:under`, tag: "path", class: "problem-under", d: path([a, b], false) },
    { key, tag: "path", class: "problem-line", d },
  ];
}

/** What cannot be. @param {string} key @param {Point} at px @param {number} r half as wide as it is (px) */
export function crossAt(key, [x, y], r = CROSS_PX) {
  const d = `M${x - r} ${y - r}l${2 * r} ${2 * r}M${x - r} ${y + r}l${2 * r} ${-2 * r}`;
  return { key, tag: "path", class: "problem-cross", d };
}
