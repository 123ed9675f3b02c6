/** The points that stand for the curves of a drawing: no corners to a hand that looks for one. */

import { edgePoints, handleOf, outlineEdges } from "./curves.js";

/** @import { Drawing, Point } from "pleat" */

/** Points of the server's cloth are told from those of the page by no more than this (m). */
const SAME_M = 1e-4;

export class Soft {
  /** @param {Pick<Drawing, "outline">} drawing */
  constructor({ outline }) {
    const curved = outlineEdges(outline).filter(([a]) => a.curve);
    /** The middles of the curves. @type {Point[]} */
    this.handles = curved.map(([a, b]) => handleOf(a, b));
    this.keys = new Set(curved.flatMap(([a, b]) => edgePoints(a, b).slice(1, -1).map(keyOf)));
  }

  /** @param {Point} point */
  has(point) {
    return this.keys.has(keyOf(point));
  }
}

/** @param {Point} point */
const keyOf = ([x, y]) => `${Math.round(x / SAME_M)},${Math.round(y / SAME_M)}`;
