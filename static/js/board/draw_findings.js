/** What the planner found: what must be held and where hands grip, what is wrong, how far the hands fall short. */

import { left, minus, plus, times, toInner, unit as direction } from "./geometry.js";
import { dimension } from "./draw_dimension.js";
import { path } from "./sheet.js";
import { length } from "./units.js";

const CROSS_PX = 6;
/** Higher up than this is said in words (m). */
const ON_TABLE_M = 0.05;
/** A direction with less of it along the table than this is not shown on the board. */
const LEVEL = 0.5;

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
  items.push(...shortfall(board.view, placement, reason, from));
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

/** How much is missing: along the table as an arrow, upwards or downwards in words alone. */
function shortfall(view, placement, { point, towards, short_by_m: short }, from) {
  if (!towards || !short) return [];
  const high = point[2] >= ON_TABLE_M ? `, ${length(point[2])} up` : "";
  if (Math.hypot(towards[0], towards[1]) < LEVEL) {
    const text = `${length(short)} too ${towards[2] < 0 ? "high" : "low"}${high}`;
    return [{ key: "missing", tag: "text", class: "reason-text", x: from[0] + 16, y: from[1] + 4, text }];
  }
  const [x, y] = plus(point, times(towards, short));
  return dimension("missing", from, view.toPx(toInner(placement, [x, y])), `${length(short)} short${high}`);
}
