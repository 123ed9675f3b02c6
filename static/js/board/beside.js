/** Where a panel stands that belongs to a place of the board. */

const AWAY_PX = 16;
const MARGIN_PX = 8;
/** So far round the pointer nothing shall come between it and the board. */
const FREE_PX = 12;
/** To the right and below, if it can be. */
const SIDES = [
  [1, 1],
  [-1, 1],
  [1, -1],
  [-1, -1],
];

/** @typedef {[number, number]} Pair */

/**
 * The side of a place on which a panel has room, and does not come to lie under the pointer: a second click is meant for
 * what the first one was.
 * @param {Pair} at px
 * @param {Pair} size the panel's (px)
 * @param {Pair} room the board's (px)
 * @param {Pair|null} pointer px
 * @returns {Pair}
 */
export function sideOf(at, size, room, pointer) {
  const cost = (side) => {
    const wanted = beside(at, size, side);
    const kept = within(wanted, size, room);
    const isUnder = pointer && pointer.every((p, axis) => kept[axis] - FREE_PX < p && p < kept[axis] + size[axis] + FREE_PX);
    return (isUnder ? 2 : 0) + (kept.some((part, axis) => part !== wanted[axis]) ? 1 : 0);
  };
  return /** @type {Pair} */ (SIDES.reduce((best, side) => (cost(side) < cost(best) ? side : best)));
}

/** The panel's left and top on that side, kept on the board. @param {Pair} at @param {Pair} size @param {Pair} room */
export const placeOf = (at, size, room, side) => within(beside(at, size, side), size, room);

const beside = (at, size, side) =>
  at.map((part, axis) => part + side[axis] * AWAY_PX - (side[axis] < 0 ? size[axis] : 0));

const within = (place, size, room) =>
  place.map((part, axis) => Math.max(Math.min(part, room[axis] - size[axis] - MARGIN_PX), MARGIN_PX));
