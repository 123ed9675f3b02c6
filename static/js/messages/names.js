/** What things are called in messages: folds by name or counted from 1; what Pleat has named, in the reader's language. */

import { isSaid, say, translated } from "../language/say.js";

/** @typedef {{name?: string}} Named a fold, as far as it has a name */

/** @param {Named[]} folds @param {number} index */
export const called = (folds, index) =>
  folds[index]?.name
    ? say("quoted", { name: translated(folds[index].name) })
    : say("fold.numbered", { number: index + 1 });

/**
 * The words for one of a kind of things, as `elbow` of the joints; without any, its own name.
 * @param {"station"|"arm"|"arm_name"|"hand"|"edge"|"joint"|"subject"|"part"|"job_kind"} kind
 * @param {string} name as in `front_left`
 */
export function word(kind, name) {
  const key = `${kind}.${name.replaceAll(" ", "_")}`;
  return isSaid(key) ? say(key) : name.replaceAll("_", " ");
}

/** @param {string | null} station as in `front_left` */
export const place = (station) => (station ? word("station", station) : "");

/** Where the base stands; one that is at no station stands where it stood at the start. @param {string | null} station */
export const stand = (station) => place(station) || say("station.none");

/** Corners, edges and layers are counted from 1 for people. @param {number} index */
export const counted = (index) => index + 1;
