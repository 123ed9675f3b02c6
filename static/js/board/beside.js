/** Where a panel stands that belongs to a place of the board. */

/** @import { Point } from "pleat" */

const AWAY_PX = 16;
const MARGIN_PX = 8;
/** So far round the pointer nothing shall come between it and the board. */
const FREE_PX = 12;
/** To the right and below, if it can be. @type {Point[]} */
const SIDES = [
  [1, 1],
  [-1, 1],
  [1, -1],
  [-1, -1],
];

/**
 * The side of a place on which a panel has room, and does not come to lie under the pointer: a second click is meant for
 * what the first one was.
 * @param {Point} at px
 * @param {Point} size the panel's (px)
 * @param {Point} room the board's (px)
 * @param {Point|null} pointer px
 * @returns {Point}
 */
export function sideOf(at, size, room, pointer) {
  /** @param {Point} side */
  const cost = (side) => {
    const wanted = beside(at, size, side);
    const kept = within(wanted, size, room);
    const isUnder = pointer && pointer.every((p, axis) => kept[axis] - FREE_PX < p && p < kept[axis] + size[axis] + FREE_PX);
    return (isUnder ? 2 : 0) + (kept.some((part, axis) => part !== wanted[axis]) ? 1 : 0);
  };
  return SIDES.reduce((best, side) => (cost(side) < cost(best) ? side : best));
}

/**
 * The panel's left and top on that side, kept on the board.
 * @param {Point} at
 * @param {Point} size
 * @param {Point} room
 * @param {Point} side
 */
export const placeOf = (at, size, room, side) => within(beside(at, size, side), size, room);

/** @param {Point} at @param {Point} size @param {Point} side @returns {Point} */
const beside = (at, size, side) => along((axis) => at[axis] + side[axis] * AWAY_PX - (side[axis] < 0 ? size[axis] : 0));

/** @param {Point} place @param {Point} size @param {Point} room @returns {Point} */
const within = (place, size, room) =>
  along((axis) => Math.max(Math.min(place[axis], room[axis] - size[axis] - MARGIN_PX), MARGIN_PX));

/** The same along both axes. @param {(axis: 0|1) => number} part @returns {Point} */
const along = (part) => [part(0), part(1)];
