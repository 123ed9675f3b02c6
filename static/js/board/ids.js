/** Names of new corners and folds. */

/** A name that is not taken yet. @param {string} prefix @param {{id: string}[]} taken */
export function freshId(prefix, taken) {
  const used = new Set(taken.map(({ id }) => id));
  let number = 0;
  while (used.has(`${prefix}${number}`)) number += 1;
  return `${prefix}${number}`;
}
