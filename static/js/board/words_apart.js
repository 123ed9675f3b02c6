/** Words that findings write on the board, moved up or down so that none is written over another. */

import { present } from "../present.js";

/** @import { Item, Items } from "./sheet.js" */

/** Words by their class, the most important first; those stay where they are as far as they can. */
const ORDER = ["reason-arm", "reason-text", "drag-text", "beyond-text", "robot-name"];
/** How wide a letter is at most on average, and how high a line (px). */
const LETTER_PX = 6.5;
const LINE_PX = 15;
/** How much of the board's foot other words have (px). */
const FOOT_PX = 36;

/** @typedef {{x0: number, x1: number, y: number}} Place */

/** @param {Items} items @param {number} height of the board (px) @returns {Items} */
export function wordsApart(items, height) {
  /** @type {Map<Item, number>} */
  const moved = new Map();
  /** @type {Place[]} */
  const taken = [];
  const words = present(items).filter(({ tag, text }) => tag === "text" && text);
  for (const name of ORDER)
    for (const item of words.filter((one) => one.class === name)) {
      const wanted = placeOf(item);
      const place = free(wanted, taken, height, name !== "reason-arm");
      taken.push(place);
      if (place.y !== wanted.y) moved.set(item, place.y);
    }
  return items.map((item) => (item && moved.has(item) ? { ...item, y: moved.get(item) } : item));
}

/** The grid without the figures over which words are written. @param {Items} grid @param {Items} items */
export function uncovered(grid, items) {
  const words = present(items).filter(({ tag, text }) => tag === "text" && text).map(placeOf);
  return present(grid).filter((item) => !item.text || words.every((word) => !isOver(word, placeOf(item))));
}

/** @param {Item} item @returns {Place} */
function placeOf({ text = "", x, y, class: name, "text-anchor": anchor }) {
  const wide = text.length * LETTER_PX;
  const isMiddle = anchor === "middle" || name === "beyond-text" || name === "reason-arm";
  const x0 = Number(x) - (isMiddle ? wide / 2 : anchor === "end" ? wide : 0);
  return { x0, x1: x0 + wide, y: Number(y) };
}

/**
 * The nearest place above or below that is on the board and free.
 * @param {Place} wanted
 * @param {Place[]} taken
 * @param {number} height
 * @param {boolean} isMovable whether it may leave the board's foot to the hint that is written there
 * @returns {Place}
 */
function free(wanted, taken, height, isMovable) {
  const foot = height - FOOT_PX;
  const y0 = isMovable && wanted.y > foot && wanted.y < height && foot > LINE_PX ? foot : wanted.y;
  const possible = [y0, ...taken.flatMap(({ y }) => [y + LINE_PX, y - LINE_PX])]
    .filter((y) => y === y0 || (y > LINE_PX && y <= foot))
    .map((y) => ({ ...wanted, y }))
    .filter((place) => taken.every((other) => !isOver(place, other)));
  const away = (/** @type {Place} */ { y }) => Math.abs(y - wanted.y);
  return possible.reduce((best, place) => (away(place) < away(best) ? place : best), possible[0] ?? wanted);
}

/** @param {Place} one @param {Place} other */
const isOver = (one, other) => Math.abs(one.y - other.y) < LINE_PX && one.x0 < other.x1 && other.x0 < one.x1;
