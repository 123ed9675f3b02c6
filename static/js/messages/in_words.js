/**
 * Messages of the server in words. A message comes as a code and named numbers in SI units, folds and edges counted from
 * 0; here they become a sentence in the page's unit and numbering. No number is read out of a sentence.
 */

import { CHANGES } from "./changes.js";
import { DRAWING } from "./drawing.js";
import { files } from "./files.js";
import { PICTURES } from "./pictures.js";
import { REASONS } from "./reasons.js";

/** @import { Says } from "pleat" */
/** @import { Named } from "./names.js" */

/** @typedef {{says?: Says|null, message: string}} Told a message as it comes */
/** @typedef {{[code: string]: (says: any, folds: Named[]) => string}} Catalogue */

/** @type {Catalogue} */
const CATALOGUE = { ...DRAWING, ...REASONS, ...CHANGES, ...PICTURES, ...files(inWords) };

/**
 * A message without a capital in front and a full stop behind. One that has no numbers comes as its sentence alone.
 * @param {Told} told
 * @param {Named[]} folds
 */
export function inWords({ says, message }, folds) {
  const words = says ? CATALOGUE[says.code] : undefined;
  return words && says ? words(says, folds) : message;
}
