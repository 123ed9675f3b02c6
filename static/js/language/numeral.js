/** Numbers with the decimal mark of the reader's language. */

import { language } from "./language.js";

/** @type {Map<string, Intl.NumberFormat>} */
const formats = new Map();

/** @param {number} value @param {number} most digits behind the mark @param {number} [least] digits behind the mark */
export function numeral(value, most, least = most) {
  const key = `${least} ${most}`;
  const options = /** @type {const} */ ({
    minimumFractionDigits: least,
    maximumFractionDigits: most,
    useGrouping: false,
    signDisplay: "negative", // nothing is minus zero
  });
  const format = formats.get(key) ?? new Intl.NumberFormat(language, options);
  formats.set(key, format);
  return format.format(value);
}

/** A number as short as it can be without another value. @param {number} value */
export const shortest = (value) => numeral(value, 20, 0);
