/** A garment in small: its outline and fold lines. */

import { boxOf } from "../board/geometry.js";
import { path } from "../board/sheet.js";
import { svg } from "../dom.js";

/** @import { Point } from "pleat" */

const SIZE = 100;
const MARGIN = 8;

/** @param {Point[]} outline @param {{kind: string, start: Point, end: Point}[]} folds @returns {SVGElement} */
export function picture(outline, folds) {
  const made = svg("svg", { class: "picture", viewBox: `0 0 ${SIZE} ${SIZE}`, "aria-hidden": "true" });
  const box = boxOf(outline);
  if (!box) {
    made.append(svg("path", { class: "picture-blank", d: "M16 24H84V76H16Z" }));
    return made;
  }
  const [wide, tall] = [box.high[0] - box.low[0], box.high[1] - box.low[1]];
  const scale = (SIZE - 2 * MARGIN) / Math.max(wide, tall);
  /** @param {Point} at @returns {Point} */
  const place = ([x, y]) => [
    SIZE / 2 + (x - (box.low[0] + box.high[0]) / 2) * scale,
    SIZE / 2 - (y - (box.low[1] + box.high[1]) / 2) * scale,
  ];
  made.append(svg("path", { class: "picture-cloth", d: path(outline.map(place)) }));
  for (const { kind, start, end } of folds)
    made.append(svg("path", { class: `picture-fold is-${kind}`, d: path([place(start), place(end)], false) }));
  return made;
}
