/** Pictures of a rehearsal: the cloth from above, as planned and as simulated; what the camera saw, with its outline. */

import { boxOf } from "../board/geometry.js";
import { path, svg } from "../board/sheet.js";

/** @import { Look, Point, TraceStep } from "pleat" */

/** Millimetres are the picture's units: its stripes have a width then. */
const MM = 1000;
const STRIPE_MM = 14;
const ROUND_MM = 30;
/** How much larger than the outline a cut of the camera's picture is. */
const CUT = 1.7;

/** A point of the table's frame (m), whose y is up, in the picture. @param {Point} at @returns {Point} */
const up = ([x, y]) => [MM * x, -MM * y];

/** @param {Point[][]} rings @returns {string} */
const outline = (rings) => rings.map((ring) => path(ring.map(up))).join("");

/** The cloth after a step: as planned, as simulated over it, and what only one of them covers striped. @param {TraceStep} step */
export function outlinesPicture({ found, planned }) {
  const box = boxOf([...found, ...planned].flat().map(up));
  const { low, high } = box ?? { low: [0, 0], high: [1, 1] };
  const [wide, tall] = [high[0] - low[0] + 2 * ROUND_MM, high[1] - low[1] + 2 * ROUND_MM];
  const viewBox = `${low[0] - ROUND_MM} ${low[1] - ROUND_MM} ${wide} ${tall}`;
  const made = svg("svg", { class: "rehearsed", viewBox, "aria-hidden": "true" });
  const stripes = svg("pattern", {
    id: "hatch-difference",
    width: STRIPE_MM,
    height: STRIPE_MM,
    patternUnits: "userSpaceOnUse",
    patternTransform: "rotate(45)",
  });
  stripes.append(svg("path", { class: "hatch-difference", d: `M0 0V${STRIPE_MM}` }));
  const defs = svg("defs");
  defs.append(stripes);
  made.append(
    defs,
    svg("path", { class: "rehearsed-planned", d: outline(planned) }),
    svg("path", { class: "rehearsed-found", d: outline(found) }),
    svg("path", { class: "rehearsed-difference", d: outline([...planned, ...found]) }),
  );
  return made;
}

/** What the camera saw, with where the stack ought to lie dashed and what was fitted. @param {Look} look @param {boolean} isWhole */
export function lookPicture({ jpeg, size_px: [width, height], fitted_px: fitted, expected_px: expected }, isWhole) {
  const viewBox = isWhole ? `0 0 ${width} ${height}` : cut([...fitted, ...expected], width, height);
  const made = svg("svg", { class: "looked", viewBox, "aria-hidden": "true" });
  made.append(svg("image", { href: `data:image/jpeg;base64,${jpeg}`, width, height }));
  for (const [name, ring] of /** @type {[string, Point[]][]} */ ([["expected", expected], ["fitted", fitted]])) {
    for (const layer of ring.length ? ["under", "over"] : [])
      made.append(svg("path", { class: `looked-${name} is-${layer}`, d: path(ring) }));
  }
  return made;
}

/** The part of a picture round some points, of its shape. @param {Point[]} points @param {number} width @param {number} height */
function cut(points, width, height) {
  const box = boxOf(points);
  if (!box) return `0 0 ${width} ${height}`;
  const { low, high } = box;
  const share = Math.min(1, CUT * Math.max((high[0] - low[0]) / width, (high[1] - low[1]) / height));
  /** @param {number} middle @param {number} size */
  const begin = (middle, size) => Math.min(Math.max(middle - (share * size) / 2, 0), size - share * size);
  const [x, y] = [begin((low[0] + high[0]) / 2, width), begin((low[1] + high[1]) / 2, height)];
  return `${x} ${y} ${share * width} ${share * height}`;
}
