/** Lengths, points and areas of messages in the unit of the page. */

import { unit } from "../board/units.js";
import { language } from "../language/language.js";
import { numeral, shortest } from "../language/numeral.js";
import { say } from "../language/say.js";

const DECIMALS = { cm: 1, in: 2, mm: 0 };

/** A number of the unit without digits that say nothing; what is tiny keeps two that do. @param {number} metres */
function figure(metres) {
  const value = metres / unit.metres;
  const rounded = Number(value.toFixed(DECIMALS[unit.name]));
  const isTiny = rounded === 0 && value !== 0 && Math.abs(metres) >= 1e-6;
  return shortest(isTiny ? Number(value.toPrecision(2)) : rounded);
}

/** @param {number} metres */
export const length = (metres) => `${figure(metres)} ${unit.name}`;

/** A point; say what of. @param {number[]} point its first two coordinates (m) */
export const point = ([x, y]) => say("point", { x: figure(x), y: figure(y), unit: unit.name });

/** A point of the cloth as it lies spread out, or folded so far. @param {number[]} at (m) */
export const onGarment = (at) => say("point.of_garment", { point: point(at) });

/** A point of the table frame: ahead of the table's middle, and to its left. @param {number[]} at (m) */
export const onTable = (at) => say("point.of_table", { point: point(at) });

/** A length that will do: rounded up. @param {number} metres */
export const enough = (metres) => length(Math.ceil(1000 * metres - 1e-6) / 1000);

/** @param {number} m2 */
export function area(m2) {
  const value = m2 / unit.metres ** 2;
  return `${shortest(value >= 100 ? Math.round(value) : Number(value.toPrecision(2)))} ${unit.name}\u00B2`;
}

/** A share of a whole. @param {number} share @param {number} [digits] at most so many behind the mark */
export const percent = (share, digits = 0) => say("amount.percent", { number: numeral(100 * share, digits, 0) });

/** How high over the table's top a point is, or how far below. @param {number} metres */
export const height = (metres) =>
  metres >= 0 ? say("height.over", { length: length(metres) }) : say("height.below", { length: length(-metres) });

const lists = language === "en" ? "en-GB" : language; // American lists have one comma more
const [all, one] = [new Intl.ListFormat(lists), new Intl.ListFormat(lists, { type: "disjunction" })];

/** Things one after the other: `a, b and c`. @param {string[]} parts */
export const listed = (parts) => all.format(parts);

/** One of several things: `a, b or c`. @param {string[]} parts */
export const either = (parts) => one.format(parts);
