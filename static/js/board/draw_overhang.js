/**
 * The picture of cloth that does not stay on the table as it lies: what is beyond the table's edge is hatched, the edge
 * under it is a double line, and an arrow says how far it has to come.
 */

import { ringOf } from "./curves.js";
import { say } from "../language/say.js";
import { dimension } from "./draw_dimension.js";
import { crossAt, double } from "./draw_findings.js";
import { between, cornersWithin, crossings, distance, edgesOf, isInside, leftPart, toInner, toOuter } from "./geometry.js";
import { path } from "./sheet.js";
import { length } from "../messages/lengths.js";

/** @import { Drawing, Plan, Point, Reason, Table } from "pleat" */
/** @import { Items } from "./sheet.js" */

const CODES = new Set(["not_a_g_state", "slips"]);
const CROSS_PX = 8;
/** Nearer to the table than this is on it (m). */
const ON_M = 1e-4;
/** Words that would not be on the board are so far below the cross (px). */
const BELOW_PX = 28;

/**
 * The reason why cloth would not stay as it lies at the start, if that is the first.
 * @param {Plan|null|undefined} plan
 */
export function restlessAtStart(plan) {
  const first = plan?.status === "infeasible" ? plan.reasons[0] : undefined;
  const isAtStart = first?.fold === null && CODES.has(first.code) && !Math.hypot(...(first.offset_m ?? [0, 0]));
  return isAtStart ? first : null;
}

/** @param {import("./board.js").Board} board @returns {Items} */
export function drawOverhang(board) {
  const { drawing, draft, isSpread, store, view } = board;
  const plan = store.plan?.plan;
  const reason = draft || !isSpread || plan?.is_stale ? null : restlessAtStart(plan);
  if (!reason || drawing.outline.length < 3) return [];
  const ring = ringOf(drawing);
  const sides = edgesOf(tableIn(drawing));
  /** @param {Point[]} points */
  const px = (points) => points.map((point) => view.toPx(point));
  const parts = sides.map(([a, b]) => leftPart(ring, b, a)).filter((part) => part.length > 2);
  return [
    ...parts.map((part, n) => ({ key: `over${n}`, tag: "path", class: "overhang", d: path(px(part)) })),
    ...sides.flatMap((side, n) => under(side, ring).flatMap((line, m) => double(`over-edge${n}:${m}`, px(line)))),
    ...howFar(view, drawing, ring, reason),
  ];
}

/** The table's corners as the garment sees them, counter-clockwise. @param {Drawing} drawing */
export const tableIn = ({ placement, scene: { table } }) =>
  cornersWithin(table.depth_m / 2, table.width_m / 2).map((corner) => toInner(placement, corner));

/**
 * Return the stretches of a side of the table that lie under cloth.
 * @param {[Point, Point]} side
 * @param {Point[]} ring
 */
function under([a, b], ring) {
  const stops = [0, ...crossings(a, b, [ring]).filter((t) => t > 0 && t < 1), 1];
  const lines = stops
    .slice(1)
    .map((t, n) => /** @type {[Point, Point]} */ ([between(a, b, stops[n]), between(a, b, t)]));
  return lines.filter(([p, q]) => isInside(between(p, q), [ring]));
}

/**
 * A cross where it is worst, and how far the cloth there is from the table.
 * @param {import("./view.js").View} view
 * @param {Drawing} drawing
 * @param {Point[]} ring the outline
 * @param {Reason} reason
 * @returns {Items}
 */
function howFar(view, drawing, ring, reason) {
  const { placement } = drawing;
  const isBeside = !isOver(ring, tableIn(drawing));
  /** @param {Point} point */
  const foot = (point) => toInner(placement, onTable(toOuter(placement, point), drawing.scene.table, isBeside));
  /** @param {Point} point */
  const away = (point) => distance(point, foot(point));
  /** @param {Point} one @param {Point} other */
  const worse = (one, other) => (away(one) > away(other) !== isBeside ? one : other);
  const at = reason.point ? toInner(placement, [reason.point[0], reason.point[1]]) : ring.reduce(worse);
  const from = view.toPx(at);
  const items = reason.point ? [] : [crossAt("over", from, CROSS_PX)];
  if (away(at) <= ON_M) return items;
  const text = say(isBeside ? "overhang.beside" : "overhang.over", { length: length(away(at)) });
  const [arrow, words] = dimension("over:by", from, view.toPx(foot(at)), text);
  const below = { x: from[0], y: from[1] + BELOW_PX, "text-anchor": "middle" };
  return [...items, arrow, isOn(view, words) ? words : { ...words, ...below }];
}

/** Whether any of the cloth is over the table. @param {Point[]} ring @param {Point[]} table */
const isOver = (ring, table) => edgesOf(table).reduce((part, [a, b]) => leftPart(part, a, b), ring).length > 2;

/**
 * The place on a table nearest to a point of its frame; unless it must be there, on the line of the edge crossed.
 * @param {Point} point
 * @param {Table} table
 * @param {boolean} isThere whether it must be on the table
 * @returns {Point}
 */
function onTable([x, y], { depth_m: deep, width_m: wide }, isThere) {
  /** @param {number} value @param {number} most */
  const within = (value, most) => Math.min(Math.max(value, -most / 2), most / 2);
  /** @type {Point} */
  const nearest = [within(x, deep), within(y, wide)];
  if (isThere) return nearest;
  return Math.abs(nearest[0] - x) > Math.abs(nearest[1] - y) ? [nearest[0], y] : [x, nearest[1]];
}

/** @param {{width: number, height: number}} board @param {{x: number, y: number}} at */
const isOn = ({ width, height }, { x, y }) => x >= 0 && x <= width && y >= 0 && y <= height;
