/** The table from above with the places where the robot may stand; only while the garment is being placed. */

import { say } from "../language/say.js";
import { tableIn } from "./draw_overhang.js";
import { cornersWithin } from "./geometry.js";
import { place } from "../messages/names.js";
import { path } from "./sheet.js";

/** @import { Point, Pose } from "pleat" */
/** @import { Items } from "./sheet.js" */
/** @import { View } from "./view.js" */

/** How large the robot is drawn (m). */
export const BASE_M = 0.33;

/** @param {import("./board.js").Board} board */
export function drawTable({ view, drawing }) {
  const { table, stations } = drawing.scene;
  const [deep, wide] = [table.depth_m / 2, table.width_m / 2];
  const ring = placed(view, ...cornersWithin(deep, wide));
  const middle = placed(view, [-deep, 0], [deep, 0]);
  const across = placed(view, [0, -wide], [0, wide]);
  return [
    { key: "table", tag: "path", class: "table", d: path(ring) },
    { key: "middle", tag: "path", class: "table-middle", d: path(middle, false) + path(across, false) },
    ...Object.entries(stations).flatMap(([name, pose]) => station(view, name, pose, name === drawing.start_station)),
  ];
}

/**
 * The table's edge where the cloth lies, if that matters: there is no plan, or another place is pointed at.
 * @param {import("./board.js").Board} board
 * @param {"table is-faint"|"table-line"} look the top under the cloth, or its edge over it
 */
export function drawTableEdge({ store, view, drawing, isPlacing }, look) {
  const hasNoPlan = store.plan?.status === "infeasible" || store.plan?.status === "budget_exceeded";
  if (isPlacing || !drawing.outline.length || !(hasNoPlan || store.preview?.placement)) return [];
  const ring = tableIn(drawing).map((corner) => view.toPx(corner));
  return [{ key: "edge", tag: "path", class: look, d: path(ring) }];
}

/** @param {View} view @param {...Point} points of the table's frame */
const placed = (view, ...points) => points.map((point) => view.tableToPx(point));

/** @param {View} view @param {string} name @param {Pose} pose @param {boolean} isStart @returns {Items} */
function station(view, name, { x_m, y_m, yaw_rad }, isStart) {
  const [x, y] = view.tableToPx([x_m, y_m]);
  const nose = view.tableToPx([x_m + BASE_M * Math.cos(yaw_rad), y_m + BASE_M * Math.sin(yaw_rad)]);
  const state = isStart ? " is-start" : "";
  return [
    { key: `${name}:base`, tag: "circle", class: `station${state}`, cx: x, cy: y, r: BASE_M * view.scale },
    { key: `${name}:nose`, tag: "path", class: `station${state}`, d: `M${x} ${y}L${nose.join(" ")}` },
    {
      key: `${name}:name`,
      tag: "text",
      class: "station-name",
      x,
      y: y + BASE_M * view.scale * 0.55,
      "text-anchor": "middle",
      text: isStart ? say("place.start", { place: place(name) }) : place(name),
    },
  ];
}
