/** What a garment is called that somebody has just drawn: what its outline looks like. */

import { inEnglish } from "../language/say.js";
import { boxOf, cross, edgesOf, minus } from "./geometry.js";

/** @import { Point } from "pleat" */

/** From so many times as long as wide it is a scarf; from so many corners, none of them inwards, it is round. */
const LONG = 4;
const ROUND = 10;
/** How near to the middle a neck or a crotch is, and how deep a crotch at least (shares of the garment). */
const MIDDLE = 0.1;
const DEEP = 0.35;

/** A title in English, as titles are stored; empty where it looks like nothing known. @param {Point[]} ring */
export function guessedTitle(ring) {
  const box = boxOf(ring);
  if (!box) return "";
  const [wide, long] = minus(box.high, box.low);
  const inward = inwardCorners(ring).map(([x, y]) => [(x - box.low[0]) / wide, (y - box.low[1]) / long]);
  if (!inward.length) {
    if (Math.max(wide, long) > LONG * Math.min(wide, long)) return inEnglish("name.scarf");
    return ring.length === 4 ? inEnglish("name.towel") : ring.length >= ROUND ? inEnglish("name.round") : "";
  }
  const central = inward.filter(([x]) => Math.abs(x - 0.5) < MIDDLE);
  const aside = inward.filter((corner) => !central.includes(corner));
  if (!aside.length && central.length === 1) {
    const [, y] = central[0];
    return y > DEEP && y < 1 - DEEP ? inEnglish("name.trousers") : y >= 1 - DEEP ? inEnglish("name.vest") : "";
  }
  const isPair = aside.length === 2 && Math.abs(aside[0][0] + aside[1][0] - 1) < MIDDLE;
  return isPair && central.length < 2 ? inEnglish("name.t_shirt") : "";
}

/** @param {Point[]} ring either way round @returns {Point[]} */
function inwardCorners(ring) {
  const turn = Math.sign(edgesOf(ring).reduce((sum, [p, q]) => sum + cross(p, q), 0));
  return ring.filter((point, index) => {
    const [before, after] = [ring.at(index - 1) ?? point, ring[(index + 1) % ring.length]];
    return turn * cross(minus(point, before), minus(after, point)) < 0;
  });
}
