/** The grid under the cloth, as fine as can be told apart, with figures along two sides. */

import { unit } from "./units.js";

/** @import { Items } from "./sheet.js" */
/** @import { UnitName } from "./units.js" */
/** @import { View } from "./view.js" */

/** Spacings in units, each with how many of them make a strong line. @type {Record<UnitName, [number, number][]>} */
const SPACINGS = {
  cm: [
    [0.1, 10],
    [0.5, 10],
    [1, 10],
    [5, 2],
    [10, 10],
    [50, 2],
    [100, 5],
  ],
  mm: [
    [1, 10],
    [5, 10],
    [10, 10],
    [50, 2],
    [100, 10],
    [500, 2],
    [1000, 5],
  ],
  in: [
    [0.125, 8],
    [0.25, 4],
    [0.5, 2],
    [1, 12],
    [6, 2],
    [12, 3],
    [36, 2],
  ],
};
const FINEST_PX = 9;
const RULER_PX = 15;
/** How far apart figures stand at least. */
const FIGURE_PX = 38;

/** The distance of the grid's lines (m), and how many make a strong one. @param {number} scale px per m */
export function spacing(scale) {
  const all = SPACINGS[unit.name];
  const [step, strong] = all.find(([step]) => step * unit.metres * scale >= FINEST_PX) ?? all[all.length - 1];
  return { step: step * unit.metres, strong };
}

/** @param {import("./board.js").Board} board */
export function drawGrid({ view }) {
  const { step, strong } = spacing(view.scale);
  const low = view.pxToPlane([0, view.height]);
  const high = view.pxToPlane([view.width, 0]);
  /** @type {string[]} */
  const fine = [];
  /** @type {string[]} */
  const coarse = [];
  /** @type {Items} */
  const figures = [];
  const every = strong * Math.max(1, Math.ceil(FIGURE_PX / (strong * step * view.scale)));
  for (const axis of /** @type {const} */ ([0, 1])) {
    for (let n = Math.ceil(low[axis] / step); n * step <= high[axis]; n += 1) {
      const at = view.planeToPx(axis === 0 ? [n * step, 0] : [0, n * step])[axis];
      const isStrong = n % strong === 0;
      (isStrong ? coarse : fine).push(line(view, axis, at));
      if (n % every === 0) figures.push(figure(view, axis, at, n * step));
    }
  }
  return [
    { key: "fine", tag: "path", class: "grid-fine", d: fine.join("") },
    { key: "strong", tag: "path", class: "grid-strong", d: coarse.join("") },
    ...figures,
  ];
}

/** @param {View} view @param {0|1} axis @param {number} at */
function line(view, axis, at) {
  const sharp = Math.round(at) + 0.5;
  return axis === 0 ? `M${sharp} 0V${view.height}` : `M0 ${sharp}H${view.width}`;
}

/** @param {View} view @param {0|1} axis @param {number} at @param {number} metres */
function figure(view, axis, at, metres) {
  const place = axis === 0 ? { x: at + 3, y: view.height - 5 } : { x: 4, y: at - 3 };
  const isHidden = axis === 0 ? at < 24 : at > view.height - RULER_PX;
  const text = String(Number((metres / unit.metres).toFixed(3)));
  return isHidden ? null : { key: `${axis}:${text}`, tag: "text", class: "grid-figure", ...place, text };
}
