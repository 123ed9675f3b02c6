/** Cloth in small as a plan leaves it: its layers from bottom to top, as the robot sees them. */

import { boxOf, turned } from "../board/geometry.js";
import { path } from "../board/sheet.js";
import { svg } from "../dom.js";

/** @import { Plan, Point } from "pleat" */

const SIZE = 100;
const MARGIN = 10;

/** @param {string} id of a plan @returns {Promise<SVGElement|null>} null where the plan is gone */
export async function foldedPicture(id) {
  const answer = await fetch(`../api/plans/${id}`).catch(() => null);
  if (!answer?.ok) return null;
  /** @type {Plan} */
  const plan = await answer.json();
  return layersPicture(plan.final_layers, (plan.final_placement?.yaw_rad ?? 0) + Math.PI / 2);
}

/**
 * @param {Pick<Plan, "final_layers">["final_layers"]} layers bottom to top
 * @param {number} turn of the garment frame on the picture (rad)
 */
export function layersPicture(layers, turn) {
  const rings = layers.map(({ polygon }) => polygon.map((point) => turned(point, turn)));
  const made = svg("svg", { class: "picture", viewBox: `0 0 ${SIZE} ${SIZE}`, "aria-hidden": "true" });
  const box = boxOf(rings.flat());
  if (!box) return made;
  const scale = (SIZE - 2 * MARGIN) / Math.max(box.high[0] - box.low[0], box.high[1] - box.low[1]);
  /** @param {Point} at @returns {Point} */
  const place = ([x, y]) => [
    SIZE / 2 + (x - (box.low[0] + box.high[0]) / 2) * scale,
    SIZE / 2 - (y - (box.low[1] + box.high[1]) / 2) * scale,
  ];
  for (const [index, ring] of rings.entries())
    made.append(svg("path", { class: `picture-layer is-${layers[index].face}`, d: path(ring.map(place)) }));
  return made;
}
