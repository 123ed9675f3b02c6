/** A length that is missing or gone, as an arrow; a short one is drawn longer than it is, to be seen. */

import { distance, left, minus, plus, times, unit as direction } from "./geometry.js";
import { path } from "./sheet.js";

/** @import { Point } from "pleat" */

const LEAST_ARROW_PX = 14;

/**
 * An arrow with a tick at its end, and what it measures.
 * @param {string} key
 * @param {Point} a px
 * @param {Point} b px
 * @param {string} text
 */
export function dimension(key, a, b, text) {
  const along = direction(minus(b, a));
  const tip = distance(a, b) < LEAST_ARROW_PX ? plus(a, times(along, LEAST_ARROW_PX)) : b;
  const aside = times(left(along), 4);
  const back = minus(tip, times(along, 8));
  const d = path([a, tip], false) + path([plus(back, aside), tip, minus(back, aside)], false);
  const tick = path([plus(tip, times(left(along), 9)), minus(tip, times(left(along), 9))], false);
  const beyond = plus(tip, times(along, 10));
  const anchor = Math.abs(along[0]) < 0.5 ? "middle" : along[0] > 0 ? "start" : "end";
  return /** @type {const} */ ([
    { key, tag: "path", class: "reason-arrow", d: d + tick },
    {
      key: `${key}:text`,
      tag: "text",
      class: "reason-text",
      x: beyond[0],
      y: beyond[1] + (along[1] > 0.5 ? 12 : 4),
      "text-anchor": anchor,
      text,
    },
  ]);
}
