/**
 * The picture of why there is no plan: a cross where the hand should be, an arrow as long as what is missing, and beyond
 * the edge of that hand's reach the board is hatched. The reach is that at the height where the hand should be, turned as
 * it would have to be there: the server finds it, and tells of nothing where it does not know.
 */

import { dimension } from "./draw_dimension.js";
import { crossAt } from "./draw_findings.js";
import { plus, times, toInner } from "./geometry.js";
import { path } from "./sheet.js";
import { length } from "./units.js";

const CROSS_PX = 8;
/** Higher up than this is said in words (m). */
const ON_TABLE_M = 0.05;
/** A direction with less of it along the table than this is not shown on the board. */
const LEVEL = 0.5;
/** How far words are below the hatching and beside the cross, and how wide a letter is at most on average (px). */
const BELOW_PX = 14;
const BESIDE_PX = 16;
const LETTER_PX = 7;

/** The first reason that has a place, as long as it is one for what is drawn. @param {import("../store.js").Store} store */
export function reasonWithPlace({ plan: message }) {
  const { plan, status } = message ?? {};
  if (!plan || plan.is_stale || status === "solved" || status === "planning") return null;
  return plan.reasons.find(({ point }) => point) ?? null;
}

/** @param {import("./board.js").Board} board @returns {import("./sheet.js").Item[]} */
export function drawReason(board) {
  const reason = board.draft ? null : reasonWithPlace(board.store);
  if (!reason) return [];
  const placement = board.drawing.placement;
  const from = board.view.toPx(toInner(placement, reason.point.slice(0, 2)));
  const items = [
    ...beyondReach(board, reason),
    crossAt("reason", from, CROSS_PX),
    ...shortfall(board.view, placement, reason, from),
  ];
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

/** What of a disc round the cross is out of reach, where that begins, and whose reach it is. */
function beyondReach({ overlays, state, view }, { cause }) {
  const { shortfall: found, version } = overlays.found ?? {};
  if (!found || version !== state.version) return [];
  const px = (points, isClosed) =>
    path(
      points.map((point) => view.toPx(point)),
      isClosed,
    );
  const rings = found.beyond.flatMap(({ outer, holes }) => [outer, ...holes]);
  const [x, y] = view.toPx(found.point);
  const what = cause === "comfort_only" ? "comfort" : "reach";
  const text = `out of the ${found.arm} hand\u2019s ${what}${found.point[2] >= ON_TABLE_M ? " at that height" : ""}`;
  return [
    { key: "beyond", tag: "path", class: "beyond", d: rings.map((ring) => px(ring, true)).join("") },
    ...found.edge.map((line, n) => ({ key: `edge${n}`, tag: "path", class: "beyond-edge", d: px(line, false) })),
    {
      key: "beyond:text",
      tag: "text",
      class: "beyond-text",
      x: inside(x, text, view),
      y: Math.max(Math.min(y + found.radius_m * view.scale, view.height - 4 * BELOW_PX), y) + BELOW_PX,
      text,
    },
  ];
}

/** How much is missing: along the table as an arrow, upwards or downwards in words alone. */
function shortfall(view, placement, { point, towards, short_by_m: short }, from) {
  if (!towards || !short) return [];
  const high = point[2] >= ON_TABLE_M ? `, ${length(point[2])} up` : "";
  if (Math.hypot(towards[0], towards[1]) < LEVEL) {
    const text = `${length(short)} too ${towards[2] < 0 ? "high" : "low"}${high}`;
    const item = { key: "missing", tag: "text", class: "reason-text", text };
    const isRoomy = from[0] + BESIDE_PX + text.length * LETTER_PX < view.width;
    if (isRoomy) return [{ ...item, x: from[0] + BESIDE_PX, y: from[1] + 4 }];
    return [{ ...item, "text-anchor": "middle", x: inside(from[0], text, view), y: from[1] + 2 * BELOW_PX }];
  }
  const [x, y] = plus(point, times(towards, short));
  return dimension("missing", from, view.toPx(toInner(placement, [x, y])), `${length(short)} short${high}`);
}

/** The middle of words, so that all of them are on the board. */
function inside(x, text, { width }) {
  const half = (text.length * LETTER_PX) / 2;
  return Math.max(Math.min(x, width - half), half);
}
