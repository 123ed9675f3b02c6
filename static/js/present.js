/** Lists some of whose items may be missing. */

/**
 * Return the items that are there, without those that are false, null, undefined or an empty text.
 * @template T
 * @param {readonly (T|false|null|undefined|"")[]} items
 * @returns {T[]}
 */
export const present = (items) => /** @type {T[]} */ (items.filter(Boolean));
