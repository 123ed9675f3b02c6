/** Lengths, points and areas of messages in the unit of the page. */

import { unit } from "../board/units.js";

const DECIMALS = { cm: 1, in: 2 };

/** A number of the unit without digits that say nothing; what is tiny keeps two that do. @param {number} metres */
function figure(metres) {
  const value = metres / unit.metres;
  const rounded = Number(value.toFixed(DECIMALS[unit.name]));
  return String(rounded === 0 && value !== 0 && Math.abs(metres) >= 1e-6 ? Number(value.toPrecision(2)) : rounded || 0);
}

/** @param {number} metres */
export const length = (metres) => `${figure(metres)} ${unit.name}`;

/** A point; say what of. @param {number[]} point its first two coordinates (m) */
export const point = ([x, y]) => `(${figure(x)}, ${figure(y)}) ${unit.name}`;

/** A point of the cloth as it lies spread out, or folded so far. @param {number[]} at (m) */
export const onGarment = (at) => `${point(at)} of the garment`;

/** A point of the table frame: ahead of the table's middle, and to its left. @param {number[]} at (m) */
export const onTable = (at) => `${point(at)} from the table\u2019s middle`;

/** A length that will do: rounded up. @param {number} metres */
export const enough = (metres) => length(Math.ceil(1000 * metres - 1e-6) / 1000);

/** @param {number} m2 */
export function area(m2) {
  const value = m2 / unit.metres ** 2;
  return `${value >= 100 ? Math.round(value) : Number(value.toPrecision(2))} ${unit.name}\u00B2`;
}

/** How high over the table's top a point is, or how far below. @param {number} metres */
export const height = (metres) =>
  metres >= 0 ? `${length(metres)} over the table` : `${length(-metres)} below the table\u2019s top`;

/** Things one after the other: `a, b and c`. @param {string[]} parts */
export const listed = (parts) =>
  parts.length > 1 ? `${parts.slice(0, -1).join(", ")} and ${parts.at(-1)}` : (parts[0] ?? "");
