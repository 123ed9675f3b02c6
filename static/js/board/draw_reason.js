/**
 * The picture of why there is no plan: a cross where the hand should be, an arrow as long as what is missing, and beyond
 * the edge of that hand's reach the board is hatched. The reach is that at the height where the hand should be, turned as
 * it would have to be there: the server finds it. The robot may have dragged the cloth by then, and the board shows it
 * where it starts: all is drawn as far back as it was dragged, and a dashed arrow says whereto and how far that was.
 */

import { say } from "../language/say.js";
import { dimension } from "./draw_dimension.js";
import { crossAt } from "./draw_findings.js";
import { minus, plus, times, toInner } from "./geometry.js";
import { path } from "./sheet.js";
import { length } from "../messages/lengths.js";
import { draggedBy, shortBy, toldReason } from "../messages/reasons.js";
import { armLetter } from "../messages/arms.js";
import { moved } from "../messages/directions.js";
import { word } from "../messages/names.js";

/** @import { Point, Point3, Reason } from "pleat" */
/** @import { Board } from "./board.js" */
/** @import { Items } from "./sheet.js" */
/** @import { View } from "./view.js" */

const CROSS_PX = 8;
/** Higher up than this is said in words (m). */
const ON_TABLE_M = 0.05;
/** A direction with less of it along the table than this is not shown on the board. */
const LEVEL = 0.5;
/** How far words are below the hatching, and half as far as below the cross; how wide a letter is at most (px). */
const BELOW_PX = 14;
const LETTER_PX = 7.5;

/** What of a hand ends there: on the table, and over it. */
const WHOSE = /** @type {const} */ ({
  comfort: ["reason.out_of_hands_comfort", "reason.out_of_comfort_at_height"],
  reach: ["reason.out_of_hands_reach", "reason.out_of_reach_at_height"],
});

/** @typedef {Reason & {point: Point3}} Placed */

/**
 * The reason that the status tells, if it has a place, as long as it is one for what is drawn: another one's numbers
 * would contradict it.
 * @param {import("../store.js").Store} store
 * @returns {Placed|null}
 */
export function reasonWithPlace({ plan: message }) {
  const { plan, status } = message ?? {};
  if (!plan || plan.is_stale || status === "solved" || status === "planning") return null;
  const reason = toldReason(plan.reasons);
  return reason && reason.point !== null ? /** @type {Placed} */ (reason) : null;
}

/** @param {Board} board @returns {Items} */
export function drawReason(board) {
  const reason = board.draft ? null : reasonWithPlace(board.store);
  if (!reason) return [];
  /** @param {Point} point of the table frame */
  const toPx = (point) => board.view.toPx(toInner(board.drawing.placement, minus(point, reason.offset_m ?? [0, 0])));
  const from = toPx(flat(reason.point));
  /** @type {Items} */
  const items = [
    ...beyondReach(board, reason),
    crossAt("reason", from, CROSS_PX),
    ...shortfall(board.view, reason, from, toPx),
    ...dragged(board, reason, from),
  ];
  if (reason.arm)
    items.push({
      key: "arm",
      tag: "text",
      class: "reason-arm",
      x: from[0],
      y: from[1] - 13,
      text: armLetter(reason.arm),
    });
  return items;
}

/**
 * What of a disc round the cross is out of reach, where that begins, and whose reach it is.
 * @param {Board} board
 * @param {Reason} reason
 * @returns {Items}
 */
function beyondReach({ overlays, state, view }, { cause }) {
  const { shortfall: found, version } = overlays.found ?? {};
  if (!found || version !== state?.version) return [];
  /** @param {Point[]} points @param {boolean} isClosed */
  const px = (points, isClosed) =>
    path(
      points.map((point) => view.toPx(point)),
      isClosed,
    );
  const rings = found.beyond.flatMap(({ outer, holes }) => [outer, ...holes]);
  const [x, y] = view.toPx(flat(found.point));
  const isHigh = found.point[2] >= ON_TABLE_M;
  const text = say(WHOSE[cause === "comfort_only" ? "comfort" : "reach"][isHigh ? 1 : 0], {
    hand: word("hand", found.arm),
  });
  return [
    { key: "beyond", tag: "path", class: "beyond", d: rings.map((ring) => px(ring, true)).join("") },
    ...found.edge.map((line, n) => ({ key: `edge${n}`, tag: "path", class: "beyond-edge", d: px(line, false) })),
    {
      key: "beyond:text",
      tag: "text",
      class: "beyond-text",
      x: inside(x, text, view),
      y: Math.max(Math.min(y + found.radius_m * view.scale, view.height - 4 * BELOW_PX), y + 2 * BELOW_PX) + BELOW_PX,
      text,
    },
  ];
}

/**
 * How much is missing: along the table as an arrow, upwards or downwards in words alone; they stay on the board.
 * @param {View} view
 * @param {Placed} reason
 * @param {Point} from px
 * @param {(point: Point) => Point} toPx
 * @returns {Items}
 */
function shortfall(view, { point, towards, short_by_m: short, is_at_least }, from, toPx) {
  if (!towards || !short) return [];
  const by = shortBy({ short_by_m: short, is_at_least });
  const up = point[2] >= ON_TABLE_M ? say("reason.up", { length: length(point[2]) }) : "";
  if (Math.hypot(towards[0], towards[1]) < LEVEL) {
    const text = say(towards[2] < 0 ? "reason.too_high" : "reason.too_low", { by, up });
    return [{ key: "missing", tag: "text", class: "reason-text", ...below(from, text, view) }];
  }
  const tip = toPx(plus(flat(point), times(flat(towards), short)));
  const [arrow, words] = dimension("missing", from, tip, say("reason.short", { by, up }));
  return [arrow, isOn(tip, view) ? words : { ...words, ...below(from, words.text, view) }];
}

/**
 * How far the cloth had been dragged from where it lies by the time that is shown, as an arrow.
 * @param {Board} board
 * @param {Placed} reason
 * @param {Point} from px
 * @returns {Items}
 */
function dragged({ drawing, view }, reason, from) {
  const way = moved(reason.offset_m ?? [0, 0]);
  if (!way) return [];
  const tip = view.toPx(toInner(drawing.placement, flat(reason.point)));
  const told = draggedBy(reason);
  const [arrow, words] = dimension("dragged", from, tip, told && say("reason.dragged", { way: told }));
  const where = isOn(tip, view) ? {} : below(from, words.text, view, 3);
  const [shaft, ...head] = String(arrow.d).split(/(?=M)/);
  return [
    { ...arrow, class: "drag-arrow", d: shaft },
    { ...arrow, key: "dragged:head", class: "drag-head", d: head.join("") },
    { ...words, ...where, class: "drag-text" },
  ];
}

/** A point as it is seen from above. @param {Point3} point @returns {Point} */
const flat = ([x, y]) => [x, y];

/** Words below a place, so many lines. @param {Point} at @param {string} text @param {View} view */
const below = ([x, y], text, view, lines = 2) => {
  return { text, "text-anchor": "middle", x: inside(x, text, view), y: y + lines * BELOW_PX };
};
/** @param {Point} at @param {View} view */
const isOn = ([x, y], { width, height }) => x >= 0 && x <= width && y >= 0 && y <= height;

/**
 * The middle of words, so that all of them are on the board.
 * @param {number} x
 * @param {string} text
 * @param {View} view
 */
function inside(x, text, { width }) {
  const half = (text.length * LETTER_PX) / 2;
  return Math.max(Math.min(x, width - half), half);
}
