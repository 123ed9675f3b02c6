/** The garment's axis, and changes to a drawing that mirror parts of its outline over it. */

import { inEnglish } from "../language/say.js";
import { as, bend, edgeFrom, outlineEdges, ringOf, withCurve } from "./curves.js";
import { distance, mirrored } from "./geometry.js";
import { freshId } from "./ids.js";
import { moveCorners } from "./outline_edits.js";
import { axisOf, leftOf } from "./symmetry.js";

/** @import { Corner, Curve, Drawing, Point } from "pleat" */

/** A corner this near to the axis lies on it (m). */
const ON_AXIS_M = 1e-4;

/** @typedef {{id: string, point: Point, of: Corner, isImage: boolean}} Mirrored a corner, and which one it is or is the image of */

/**
 * Make what is right of the garment's axis the mirror image of what is left of it. Images keep the names of the corners
 * in whose place they come, so that folds stay tied to them.
 * @param {Drawing} drawing
 */
export function mirrorOutline(drawing) {
  const axis = axisOfGarment(drawing);
  /** @param {Corner} corner */
  const isLeft = ({ point }) => leftOf(point, axis) >= -ON_AXIS_M;
  const ring = drawing.outline;
  const first = ring.findIndex((corner, index) => isLeft(corner) && !isLeft(ring[(index || ring.length) - 1]));
  /** @type {Corner[]} */
  const half = [];
  for (let n = 0; first >= 0 && n < ring.length; n += 1) {
    const corner = ring[(first + n) % ring.length];
    if (!isLeft(corner)) break;
    half.push(corner);
  }
  if (half.length < 2) return;
  const away = half.filter(({ point }) => leftOf(point, axis) > ON_AXIS_M).reverse();
  const images = away.map(({ point }) => mirrored(point, axis[0], axis[1]));
  const ids = nearestIds(images, ring.filter((corner) => !half.includes(corner)));
  /** @type {Mirrored[]} */
  const made = half.map((corner) => ({ id: corner.id, point: corner.point, of: corner, isImage: false }));
  for (const [index, point] of images.entries())
    made.push({ id: ids.get(index) ?? freshId("v", [...ring, ...made]), point, of: away[index], isImage: true });
  const before = ring[(first || ring.length) - 1];
  drawing.outline = made.map((corner, index) =>
    withCurve(corner.id, corner.point, curveBetween(corner, made[(index + 1) % made.length], before)),
  );
}

/**
 * The curve between two corners of a mirrored outline: as it is, as the mirror shows it, or alike on both sides of the axis.
 * @param {Mirrored} a
 * @param {Mirrored} b
 * @param {Corner} before the corner before the half that is kept
 * @returns {Curve|null}
 */
function curveBetween(a, b, before) {
  if (!a.isImage && !b.isImage) return a.of.curve ?? null;
  if (a.of !== b.of) return as.opposite(b.of.curve);
  const { curve } = a.isImage ? before : a.of;
  return curve?.across ? { along: 0, across: curve.across } : null;
}

/**
 * For each of some points a corner of its own, the nearest pairs first.
 * @param {Point[]} points
 * @param {Corner[]} corners
 * @returns {Map<number, string>} by point
 */
function nearestIds(points, corners) {
  const pairs = points.flatMap((point, index) =>
    corners.map((corner) => ({ index, id: corner.id, away: distance(point, corner.point) })),
  );
  /** @type {Map<number, string>} */
  const ids = new Map();
  for (const { index, id } of pairs.sort((one, other) => one.away - other.away))
    if (!ids.has(index) && ![...ids.values()].includes(id)) ids.set(index, id);
  return ids;
}

/** Put the partner of each corner where the corner's mirror image is. @param {Drawing} drawing @param {string[]} ids */
export function mirrorCorners(drawing, ids) {
  const places = new Map();
  for (const { id, point } of drawing.outline.filter((corner) => ids.includes(corner.id))) {
    const image = overAxis(drawing, point);
    const others = drawing.outline.filter((corner) => corner.id !== id && !ids.includes(corner.id));
    /** @param {Corner} corner */
    const away = (corner) => Math.hypot(corner.point[0] - image[0], corner.point[1] - image[1]);
    const [first, ...rest] = others;
    const partner = first && rest.reduce((best, corner) => (away(corner) < away(best) ? corner : best), first);
    if (partner) places.set(partner.id, image);
  }
  moveCorners(drawing, places);
}

/** Bend the partner of each edge as the mirror shows it. @param {Drawing} drawing @param {string[]} ids of the edges */
export function mirrorEdges(drawing, ids) {
  for (const id of ids) {
    const [a, b] = edgeFrom(drawing, id) ?? [];
    if (!a || !b) continue;
    const [to, from] = [a, b].map(({ point }) => overAxis(drawing, point));
    /** @param {[Corner, Corner]} edge */
    const away = ([p, q]) => distance(p.point, from) + distance(q.point, to);
    const partner = outlineEdges(drawing.outline).reduce((best, edge) => (away(edge) < away(best) ? edge : best));
    if (!ids.includes(partner[0].id)) bend(partner[0], as.opposite(a.curve));
  }
}

/** @param {Drawing} drawing */
export const axisOfGarment = (drawing) => axisOf(ringOf(drawing));

/** @param {Drawing} drawing @param {Point} point @returns {Point} */
export function overAxis(drawing, point) {
  const [a, b] = axisOfGarment(drawing);
  return mirrored(point, a, b);
}

/** So long the axis is seen after something was mirrored over it by a key (ms). */
const AXIS_MS = 1500;

/** The verb `Mirror`: what is selected, or else the outline's left half, over the garment's axis, which is shown meanwhile. */
export class Mirroring {
  /** @param {import("./board.js").Board} board */
  constructor(board) {
    this.board = board;
    this.isAxisShown = false;
    /** @type {number|undefined} */
    this.timer = undefined;
  }

  /** Show the axis over which things are mirrored, or not any more. @param {boolean} isShown */
  showAxis(isShown) {
    clearTimeout(this.timer);
    this.isAxisShown = isShown;
    this.board.render();
  }

  /** The folds that are meant, or the selected corners or edges, or the outline's left half. */
  mirror() {
    const { board } = this;
    if (!this.isAxisShown) {
      this.showAxis(true);
      this.timer = setTimeout(() => this.showAxis(false), AXIS_MS);
    }
    const { kind, ids = [] } = board.store.selection ?? {};
    if (!board.drawing.outline.length || board.paint.mirror()) return;
    if (kind === "vertex") board.store.edit(inEnglish("step.mirror_vertices"), (drawing) => mirrorCorners(drawing, ids));
    else if (kind === "edge") board.store.edit(inEnglish("step.mirror_edges"), (drawing) => mirrorEdges(drawing, ids));
    else board.store.edit(inEnglish("step.mirror_outline"), mirrorOutline);
  }
}
