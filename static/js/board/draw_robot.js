/**
 * The robot from above, where the board shows the cloth: at its station where there is no plan, and where it stands at
 * the time that is shown otherwise. Where that is beyond what is seen it stands at the board's edge, pointing the way.
 */

import { say } from "../language/say.js";
import { reasonWithPlace } from "./draw_reason.js";
import { BASE_M } from "./draw_table.js";
import { toInner, toOuter } from "./geometry.js";
import { path } from "./sheet.js";
import { length } from "./units.js";
import { place } from "../messages/names.js";

/** @import { Point, Pose } from "pleat" */
/** @import { Board } from "./board.js" */
/** @import { Items } from "./sheet.js" */

/** How large it is drawn: no larger, and no smaller where it can be seen only in part (px). */
const LARGEST_PX = 34;
const SMALLEST_PX = 18;
const MARGIN_PX = 12;
const WORDS_PX = 14;
/** How wide the foot of an arm is about its axis. */
const FOOT_M = 0.075;
/** How wide a letter is at most on average (px). */
const LETTER_PX = 6.5;
/** Its parts in the base frame, in shares of the base's half width: shoulders and the arms ahead of them. */
const SHOULDERS = /** @type {Point[]} */ ([
  [0.15, 0.75],
  [0.15, -0.75],
]);
const HANDS = /** @type {Point[]} */ ([
  [1.35, 0.5],
  [1.35, -0.5],
]);
const HEAD = /** @type {Point} */ ([0.2, 0]);

/** @typedef {{pose: Pose, station: string|null, placement?: Pose}} Stand in the table's frame, and where the cloth lies then */

/** @param {Board} board @returns {Items} */
export function drawRobot(board) {
  const stand = standing(board) ?? playing(board);
  if (!stand || board.isPlacing || board.draft || !board.drawing.outline.length) return [];
  const { view } = board;
  const { pose } = stand;
  const placement = stand.placement ?? board.drawing.placement;
  /** @param {Point} point of the table's frame */
  const toPx = (point) => view.toPx(toInner(placement, point));
  const there = toPx([pose.x_m, pose.y_m]);
  const ahead = toPx([pose.x_m + Math.cos(pose.yaw_rad), pose.y_m + Math.sin(pose.yaw_rad)]);
  const turn = Math.atan2(ahead[1] - there[1], ahead[0] - there[0]);
  const at = within(there, board);
  const away_m = Math.hypot(there[0] - at[0], there[1] - at[1]) / view.scale;
  const r = Math.min(Math.max(BASE_M * view.scale, SMALLEST_PX), LARGEST_PX);
  const words = [
    stand.station ? place(stand.station) : "",
    away_m > BASE_M ? say("robot.further", { length: length(away_m) }) : "",
  ];
  const { base, mounts } = board.store.state?.robot ?? { base: "omni", mounts: [] };
  if (base === "fixed")
    return feet(
      mounts.map((mount) => toPx(toOuter(pose, mount))),
      view.scale,
    );
  return [...silhouette(at, turn, r), label(at, r, words.filter(Boolean).join(", "), board)];
}

/** Where the robot stands for what is shown; null where that matters to nobody. @param {Board} board @returns {Stand|null} */
function standing({ store, drawing }) {
  const { plan, status } = store.plan ?? {};
  const { stations } = drawing.scene;
  if (!plan || plan.is_stale) return null;
  if (status === "infeasible") {
    const reason = reasonWithPlace(store) ?? plan.reasons[0];
    const name = reason?.station ?? drawing.start_station;
    const pose = stations[name];
    return pose ? { pose: backedOff(pose, reason?.back_off_m ?? 0), station: name } : null;
  }
  return null;
}

/** Where it stands at the time that is shown: at the end of the step that goes on. @param {Board} board @returns {Stand|null} */
function playing({ played, pictures, store }) {
  const index = pictures?.current ?? null;
  if (!played || index === null) return null;
  const base = store.plan?.plan?.primitives[index]?.base ?? played.base;
  return { pose: base, station: base.station, placement: played.placement };
}

/** @param {Pose} pose @param {number} by (m) @returns {Pose} */
const backedOff = ({ x_m, y_m, yaw_rad }, by) => ({
  x_m: x_m - by * Math.cos(yaw_rad),
  y_m: y_m - by * Math.sin(yaw_rad),
  yaw_rad,
});

/** The nearest place on the board. @param {Point} px @param {Board} board @returns {Point} */
function within([x, y], { view, covered, coveredSide }) {
  return [
    Math.min(Math.max(x, MARGIN_PX), view.width - coveredSide - MARGIN_PX),
    Math.min(Math.max(y, covered + MARGIN_PX), view.height - MARGIN_PX),
  ];
}

/**
 * @param {Point} at px
 * @param {number} turn of its front on the screen (rad)
 * @param {number} r half as wide as its base (px)
 * @returns {Items}
 */
function silhouette([x, y], turn, r) {
  const [c, s] = [Math.cos(turn) * r, Math.sin(turn) * r];
  /** @param {Point} point of the base frame, its left up on the screen @returns {Point} */
  const px = ([u, v]) => [x + u * c + v * s, y + u * s - v * c];
  const corners = /** @type {Point[]} */ ([
    [-1, -1],
    [1, -1],
    [1, 1],
    [-1, 1],
  ]);
  const arms = SHOULDERS.map((shoulder, n) => path([px(shoulder), px(HANDS[n])], false)).join("");
  const [hx, hy] = px(HEAD);
  return [
    { key: "robot:arms", tag: "path", class: "robot-arms", d: arms },
    { key: "robot:base", tag: "path", class: "robot-stand", d: path(corners.map(px)) },
    { key: "robot:head", tag: "circle", class: "robot-head", cx: hx, cy: hy, r: r * 0.34 },
  ];
}

/** Where arms are bolted to their bench. @param {Point[]} places px @param {number} scale px for a metre @returns {Items} */
function feet(places, scale) {
  const r = Math.min(Math.max(FOOT_M * scale, SMALLEST_PX / 2), LARGEST_PX);
  return places.map(([cx, cy], n) => ({ key: `robot:foot:${n}`, tag: "circle", class: "robot-stand", cx, cy, r }));
}

/** @param {Point} at px @param {number} r px @param {string} text @param {Board} board */
function label([x, y], r, text, { view }) {
  const isLow = y + r + 2 * WORDS_PX > view.height;
  const isRight = x > view.width / 2;
  const half = (text.length * LETTER_PX) / 2 + 4;
  return {
    key: "robot:name",
    tag: "text",
    class: "robot-name",
    x: isLow ? x + (isRight ? -1 : 1) * (r * 1.5 + 4) : Math.max(Math.min(x, view.width - half), half),
    y: isLow ? y + 4 : y + r + WORDS_PX,
    "text-anchor": isLow ? (isRight ? "end" : "start") : "middle",
    text,
  };
}
