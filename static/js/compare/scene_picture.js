/** Table, cloth and base from above at a moment of a plan; the robot's usual side of the table is on the left. */

import { between, toOuter, turned } from "../board/geometry.js";
import { path } from "../board/sheet.js";
import { primitiveAt } from "../dock/lane_blocks.js";
import { kindOf } from "../dock/step_kinds.js";
import { svg } from "../dom.js";

/** @import { Point, Pose, StepPicture } from "pleat" */
/** @import { Compared } from "./compared_plan.js" */

const BASE_M = 0.3;
/** To how many digits of a metre points are drawn. */
const TENTHS_OF_MM = 4;
/** How much is shown round table and base (m). */
const ROUND_M = 0.08;

/** A point of the table's frame, whose y is up, in the picture. @param {Point} at @returns {Point} */
const up = ([x, y]) => [x, -y];

/** Half the depth and half the width of what a picture has to show (m). @param {Compared} compared @returns {Point} */
export function extentOf({ drawing, pictures }) {
  const { depth_m: deep, width_m: wide } = drawing?.scene.table ?? { depth_m: 0, width_m: 0 };
  const bases = pictures.map(({ base: { x_m, y_m } }) => [Math.abs(x_m), Math.abs(y_m)]);
  /** @param {0|1} axis @param {number} edge */
  const half = (axis, edge) => Math.max(edge, ...bases.map((at) => at[axis] + BASE_M)) + ROUND_M;
  return [half(0, deep / 2), half(1, wide / 2)];
}

/** @param {SVGElement} root @param {Compared} compared @param {number} t_s @param {Point} extent as of `extentOf` */
export function drawScene(root, { drawing, plan, pictures }, t_s, [x, y]) {
  root.replaceChildren();
  if (!drawing) return;
  const { depth_m: deep, width_m: wide } = drawing.scene.table;
  root.setAttribute("viewBox", `${-x} ${-y} ${2 * x} ${2 * y}`);
  const table = svg("rect", { class: "compare-table", x: -deep / 2, y: -wide / 2, width: deep, height: wide });
  root.append(table);
  const index = plan ? primitiveAt(plan, t_s) : 0;
  const [now, next] = [pictures[index], pictures[index + 1]];
  const step = plan?.primitives[index];
  if (!now || !next || !step) return;
  const share = Math.min(Math.max((t_s - step.start_s) / step.duration_s, 0), 1);
  if (kindOf(step).moves === "part") {
    root.append(cloth(now, now.placement, 1), cloth(next, next.placement, share));
  } else root.append(cloth(now, mixed(now.placement, next.placement, share), 1));
  root.append(base(mixed(now.base, next.base, share)));
}

/** @param {StepPicture} picture @param {Pose} placement @param {number} opacity */
function cloth({ layers }, placement, opacity) {
  const made = svg("g", { opacity });
  for (const { polygon, face } of layers) {
    const points = polygon.map((point) => up(toOuter(placement, point)));
    made.append(svg("path", { class: `cloth is-${face}`, d: path(points, true, TENTHS_OF_MM) }));
  }
  return made;
}

/** @param {Pose} pose */
function base(pose) {
  const [cx, cy] = up([pose.x_m, pose.y_m]);
  const [x, y] = up(toOuter(pose, [BASE_M, 0]));
  const made = svg("g", { class: "compare-base" });
  made.append(svg("circle", { cx, cy, r: BASE_M }), svg("path", { d: `M${cx} ${cy}L${x} ${y}` }));
  return made;
}

/** A pose between two. @param {Pose} one @param {Pose} other @param {number} share @returns {Pose} */
function mixed(one, other, share) {
  const [x_m, y_m] = between([one.x_m, one.y_m], [other.x_m, other.y_m], share);
  const [cos, sin] = turned([1, 0], other.yaw_rad - one.yaw_rad);
  return { x_m, y_m, yaw_rad: one.yaw_rad + share * Math.atan2(sin, cos) };
}
