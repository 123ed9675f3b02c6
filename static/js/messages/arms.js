/** What a robot's arms are called: by name, and by a letter where there is little room. */

import { isSaid, say } from "../language/say.js";

/** @type {string[]} */
let names = [];

/** Take over the names of the robot's arms, from left to right. @param {string[]} given */
export function tellArms(given) {
  names = given;
}

/** An arm's initial, or its number from the left where several arms have the same. @param {string} arm */
export function armLetter(arm) {
  const initial = arm[0].toUpperCase();
  const isShared = names.filter((name) => name[0].toUpperCase() === initial).length > 1;
  return isShared ? String(names.indexOf(arm) + 1) : initial;
}

/** An arm as a title, as in `Left arm`. @param {string} arm */
export function armTitle(arm) {
  const key = `arm_title.${arm}`;
  if (isSaid(key)) return say(key);
  const words = arm.replaceAll("_", " ");
  const name = `${words[0].toUpperCase()}${words.slice(1)}`;
  return /\barm$/.test(words) ? name : say("arm_title.other", { name });
}
