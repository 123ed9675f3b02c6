/** What the planner found: what must be held and where hands grip, what is wrong, how far the hands fall short. */

import { distance, left, minus, plus, times, toInner, unit as direction } from "./geometry.js";
import { path } from "./sheet.js";
import { length } from "./units.js";

const CROSS_PX = 6;
const LEAST_ARROW_PX = 14;

/** Must-hold corners and grips of the fold that is looked at. @param {import("./board.js").Board} board */
export function drawChecks(board) {
  const checks = board.store.plan?.checks;
  const index = board.foldLookedAt;
  if (board.isPlacing || index === null || checks?.version !== board.state.version) return [];
  const found = checks.folds[index];
  if (!found) return [];
  return [
    ...found.must_hold.map((point, n) => diamond(`hold${n}`, board.view.toPx(point))),
    ...found.grips.flatMap((point, n) => grip(`grip${n}`, board.view.toPx(point))),
  ];
}

function diamond(key, [x, y]) {
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

function grip(key, [x, y]) {
  return [
    { key, tag: "circle", class: "grip", cx: x, cy: y, r: 12 },
    { key: `${key}:x`, tag: "path", class: "grip", d: `M${x - 4} ${y}h8M${x} ${y - 4}v8` },
  ];
}

/** What is wrong with the drawing, where it is. @param {import("./board.js").Board} board */
export function drawProblems({ state, view, draft }) {
  if (draft) return [];
  return state.problems.flatMap(({ points, lines }, n) => [
    ...lines.flatMap((line, m) =>
      double(
        `p${n}:l${m}`,
        line.map((point) => view.toPx(point)),
      ),
    ),
    ...points.map((point, m) => crossAt(`p${n}:${m}`, view.toPx(point))),
  ]);
}

/** Two thin lines, three pixels in all. */
function double(key, [a, b]) {
  const aside = times(left(direction(minus(b, a))), 1.6);
  const d = path([plus(a, aside), plus(b, aside)], false) + path([minus(a, aside), minus(b, aside)], false);
  return [
    { key: `${key}:under`, tag: "path", class: "problem-under", d: path([a, b], false) },
    { key, tag: "path", class: "problem-line", d },
  ];
}

function crossAt(key, [x, y], r = CROSS_PX) {
  const d = `M${x - r} ${y - r}l${2 * r} ${2 * r}M${x - r} ${y + r}l${2 * r} ${-2 * r}`;
  return { key, tag: "path", class: "problem-cross", d };
}

/**
 * The picture of the first reason that has a place: a cross, and an arrow as long as what is missing.
 * @param {import("./board.js").Board} board
 */
export function drawReason(board) {
  const { plan, status } = board.store.plan ?? {};
  if (board.draft || !plan || plan.is_stale || status === "solved" || status === "planning") return [];
  const reason = plan.reasons.find(({ point }) => point);
  if (!reason) return [];
  const placement = board.drawing.placement;
  const at = toInner(placement, reason.point.slice(0, 2));
  const from = board.view.toPx(at);
  /** @type {import("./sheet.js").Item[]} */
  const items = [crossAt("reason", from, 8)];
  const missing = reason.towards && reason.short_by_m;
  if (missing) {
    const [x, y] = plus(reason.point, times(reason.towards, reason.short_by_m));
    const tip = toInner(placement, [x, y]);
    items.push(...arrow(from, board.view.toPx(tip), `${length(reason.short_by_m)} short`));
  }
  if (reason.arm)
    items.push({
      key: "arm",
      tag: "text",
      class: "reason-arm",
      x: from[0],
      y: from[1] - 13,
      text: reason.arm[0].toUpperCase(),
    });
  return items;
}

/** A dimension: an arrow with ticks and its length. */
function arrow(a, b, text) {
  const along = direction(minus(b, a));
  const tip = distance(a, b) < LEAST_ARROW_PX ? plus(a, times(along, LEAST_ARROW_PX)) : b;
  const aside = times(left(along), 4);
  const back = minus(tip, times(along, 8));
  const d = path([a, tip], false) + path([plus(back, aside), tip, minus(back, aside)], false);
  const tick = path([plus(tip, times(left(along), 9)), minus(tip, times(left(along), 9))], false);
  const beyond = plus(tip, times(along, 10));
  const anchor = Math.abs(along[0]) < 0.5 ? "middle" : along[0] > 0 ? "start" : "end";
  return [
    { key: "missing", tag: "path", class: "reason-arrow", d: d + tick },
    {
      key: "missing:text",
      tag: "text",
      class: "reason-text",
      x: beyond[0],
      y: beyond[1] + (along[1] > 0.5 ? 12 : 4),
      "text-anchor": anchor,
      text,
    },
  ];
}
