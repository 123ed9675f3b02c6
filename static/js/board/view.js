/**
 * Where the garment frame is on the board. Mostly its axes are the screen's, y up. While the garment is being placed
 * the table's are: its far side up, as the robot at the station `front` sees it, and the garment lies on it turned.
 */

import { minus, plus, times, turned } from "./geometry.js";

/** @import { Point, Pose } from "pleat" */

const CLOSEST_PX_PER_M = 20000;
const FURTHEST_PX_PER_M = 40;
const MARGIN = 0.13;
/** What is fitted is never smaller than for this share of the board's height: cloth that is a speck shows nothing. */
const LEAST_FREE = 0.4;

export class View {
  constructor() {
    this.width = 1;
    this.height = 1;
    this.scale = 500;
    /** Where the plane's origin is, from the top left (px). @type {Point} */
    this.origin = [0, 0];
    /** The garment frame in the plane. */
    this.pose = { at: /** @type {Point} */ ([0, 0]), turn: 0 };
  }

  /** @param {Point} p of the garment frame (m) @returns {Point} px */
  toPx(p) {
    return this.planeToPx(plus(turned(p, this.pose.turn), this.pose.at));
  }

  /** @param {Point} px @returns {Point} garment frame (m) */
  toM(px) {
    return turned(minus(this.pxToPlane(px), this.pose.at), -this.pose.turn);
  }

  /** @param {Point} p of the plane that is shown (m) */
  planeToPx([x, y]) {
    return /** @type {Point} */ ([this.origin[0] + x * this.scale, this.origin[1] - y * this.scale]);
  }

  /** @param {Point} px */
  pxToPlane([x, y]) {
    return /** @type {Point} */ ([(x - this.origin[0]) / this.scale, (this.origin[1] - y) / this.scale]);
  }

  /** Points of the table's frame, its far side up. @param {Point} p */
  tableToPx([x, y]) {
    return this.planeToPx([-y, x]);
  }

  /** Lay the garment down as it is on the table; null: its own axes are shown. @param {Pose|null} placement */
  lay(placement) {
    this.pose = placement
      ? { at: /** @type {Point} */ ([-placement.y_m, placement.x_m]), turn: placement.yaw_rad + Math.PI / 2 }
      : { at: /** @type {Point} */ ([0, 0]), turn: 0 };
  }

  /** @param {Point} px stays where it is @param {number} factor */
  zoomAt(px, factor) {
    const scale = Math.min(Math.max(this.scale * factor, FURTHEST_PX_PER_M), CLOSEST_PX_PER_M);
    this.origin = plus(px, times(minus(this.origin, px), scale / this.scale));
    this.scale = scale;
  }

  /** @param {Point} by px */
  pan(by) {
    this.origin = plus(this.origin, by);
  }

  /**
   * Show a box of the plane whole.
   * @param {{low: Point, high: Point}} box
   * @param {{top: number, bottom: number, right?: number}} covered how much of the board other things cover (px)
   */
  fit({ low, high }, { top, bottom, right = 0 }) {
    const [wide, tall] = [high[0] - low[0], high[1] - low[1]];
    const free = [this.width - right, Math.max(this.height - top - bottom, LEAST_FREE * this.height)];
    const room = free.map((size) => size * (1 - 2 * MARGIN));
    this.scale = Math.max(Math.min(room[0] / wide, room[1] / tall, CLOSEST_PX_PER_M), FURTHEST_PX_PER_M);
    const middle = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
    const centre = [(this.width - right) / 2, (this.height + top - bottom) / 2];
    this.origin = [centre[0] - middle[0] * this.scale, centre[1] + middle[1] * this.scale];
  }
}
