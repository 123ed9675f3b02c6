/** Lengths as people write them: in the unit that was chosen unless they say otherwise. */

import { numeral } from "../language/numeral.js";
import { say } from "../language/say.js";

/** @typedef {{words: string[], at: number}} Read the words of a sum, and the next one */

/** @type {Record<string, number>} */
const METRES = { mm: 0.001, cm: 0.01, m: 1, in: 0.0254, '"': 0.0254 };
const KEY = "pleat-unit";
const SUM = /^[-+*/().\d\s]+$/;
const WITH_UNIT = /(\d+\.?\d*|\.\d+)\s*(mm|cm|in|m|")/g;

/** The units that numbers can be shown in, with the digits behind the mark that a board can tell. */
const DIGITS = /** @type {const} */ ({ cm: 1, in: 2, mm: 0 });

/** @typedef {keyof typeof DIGITS} UnitName */
export const UNITS = /** @type {UnitName[]} */ (Object.keys(DIGITS));

/** The unit that numbers are shown in, and mean when no unit is written. */
export const unit = {
  /** @returns {UnitName} */
  get name() {
    return UNITS.find((name) => name === localStorage.getItem(KEY)) ?? "cm";
  },
  set name(name) {
    localStorage.setItem(KEY, name);
    dispatchEvent(new Event("unit"));
  },
  get metres() {
    return METRES[this.name];
  },
};

/**
 * A length that somebody wrote: `30`, `18in`, `91.4/2`, `(3 + 4) m`, `18in/2`, `1m - 2in`.
 * A single unit at the end means the whole; else each unit means the number before it.
 * @param {string} text
 * @returns {number|null} metres; null if it is no length
 */
export function parsed(text) {
  const written = text.trim().toLowerCase().replaceAll(",", ".");
  const [, sum, suffix] = /^(.*?)\s*(mm|cm|in|m|")?$/.exec(written) ?? [];
  if (/[a-z"]/.test(sum ?? "")) return times(unit.metres, evaluated(written.replace(WITH_UNIT, inUnit)));
  return times(suffix ? METRES[suffix] : unit.metres, evaluated(sum ?? ""));
}

/** @param {number} metres @param {number|null} value */
const times = (metres, value) => (value === null ? null : metres * value);
/** @param {string} _ @param {string} value @param {string} suffix */
const inUnit = (_, value, suffix) => `(${value}*${METRES[suffix] / unit.metres})`;

/** No length is larger, either way (m). */
const MOST_M = 10;

/**
 * What is wrong with a length that somebody wrote; empty if nothing is.
 * @param {string} text
 * @param {number} least metres
 */
export function problemOf(text, least = -MOST_M) {
  const metres = parsed(text);
  if (metres === null) return say("length.no_number", { text });
  if (metres < least) return say("length.too_little", { text, least: length(least) });
  return metres > MOST_M ? say("length.too_much", { text, most: length(MOST_M) }) : "";
}

/** The value of a sum of numbers with + - * / and brackets; null if it is none. @param {string} sum */
export function evaluated(sum) {
  if (!SUM.test(sum)) return null;
  const words = sum.match(/\d+\.?\d*|\.\d+|[-+*/()]/g) ?? [];
  const read = { words, at: 0 };
  const value = terms(read);
  return value !== null && read.at === words.length && Number.isFinite(value) ? value : null;
}

/** @param {Read} read @returns {number|null} */
function terms(read) {
  let value = factors(read);
  while (value !== null && "+-".includes(read.words[read.at] ?? "?")) {
    const sign = read.words[read.at++] === "+" ? 1 : -1;
    const next = factors(read);
    value = next === null ? null : value + sign * next;
  }
  return value;
}

/** @param {Read} read @returns {number|null} */
function factors(read) {
  let value = single(read);
  while (value !== null && "*/".includes(read.words[read.at] ?? "?")) {
    const isTimes = read.words[read.at++] === "*";
    const next = single(read);
    value = next === null ? null : isTimes ? value * next : value / next;
  }
  return value;
}

/** @param {Read} read @returns {number|null} */
function single(read) {
  const word = read.words[read.at++];
  if (word === "-" || word === "+") {
    const value = single(read);
    return value === null ? null : word === "-" ? -value : value;
  }
  if (word === "(") {
    const value = terms(read);
    return read.words[read.at++] === ")" ? value : null;
  }
  return word === undefined || Number.isNaN(Number(word)) ? null : Number(word);
}

/** A length as text with its unit. @param {number} metres */
export const length = (metres) => `${number(metres)} ${unit.name}`;

/** A length as a number of the unit, to a millimetre or a hundredth of an inch. @param {number} metres */
export const number = (metres) => numeral(metres / unit.metres, DIGITS[unit.name]);
