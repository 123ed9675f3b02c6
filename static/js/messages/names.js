/** What things are called in messages: folds by name or counted from 1, stations by their words. */

/** @typedef {{name?: string}} Named a fold, as far as it has a name */

/**
 * @param {Named[]} folds
 * @param {number} index
 */
export const called = (folds, index) =>
  folds[index]?.name ? `\u201C${folds[index].name}\u201D` : `fold ${index + 1}`;

/** @param {string | null} station as in `front_left` */
export const place = (station) => station?.replaceAll("_", " ") ?? "";

/** Where the base stands; one that is at no station stands where it stood at the start. @param {string | null} station */
export const stand = (station) => place(station) || "where the robot stands";

/** Corners, edges and layers are counted from 1 for people. @param {number} index */
export const counted = (index) => index + 1;
