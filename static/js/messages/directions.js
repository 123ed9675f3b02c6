/** Ways and directions of the table frame in words, as the robot sees them from the near edge of the table. */

import { say } from "../language/say.js";
import { length, listed } from "./lengths.js";

/** A shorter way need not be told (m). */
const NOTICEABLE_M = 5e-4;
/** Only what is more than 22 degrees off an axis is oblique. */
const OBLIQUE = 0.4;

/** As in `8 cm towards the robot and 5 cm to the left`; empty for none. @param {number[]} by (m) */
export function moved([x, y]) {
  const parts = [];
  if (Math.abs(x) > NOTICEABLE_M) parts.push(`${length(Math.abs(x))} ${ahead(x)}`);
  if (Math.abs(y) > NOTICEABLE_M) parts.push(`${length(Math.abs(y))} ${aside(y)}`);
  return listed(parts);
}

/** @param {number[]} towards */
export function direction([x, y]) {
  const parts = [];
  if (Math.abs(x) > OBLIQUE * Math.abs(y)) parts.push(ahead(x));
  if (Math.abs(y) > OBLIQUE * Math.abs(x)) parts.push(aside(y));
  return listed(parts);
}

/** @param {number} x */
const ahead = (x) => say(x > 0 ? "direction.ahead" : "direction.back");
/** @param {number} y */
const aside = (y) => say(y > 0 ? "direction.left" : "direction.right");
