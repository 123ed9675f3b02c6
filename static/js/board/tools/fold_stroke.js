/** A stroke of the tool `Draw fold`, how it lies to the cloth, and what is seen of it. */

import { FOLD_KINDS } from "../../fold_kinds.js";
import { say, translated } from "../../language/say.js";
import { foldItems } from "../draw_folds.js";
import { lengthLabel } from "../draw_handles.js";
import { dropsOnto, edgeNear, endsOnto } from "../edge_onto_edge.js";
import { distance, isInside, nearestOnRings } from "../geometry.js";
import { FIRST_IS_RED, NO_CLOTH, REACH_PX, STROKE_MIN_M } from "../rules.js";
import { lineOf, reachesCloth } from "../stroke.js";

/** @import { Point } from "pleat" */
/** @import { Board } from "../board.js" */
/** @import { Laid } from "../edge_onto_edge.js" */
/** @import { Pointer } from "../pointer.js" */
/** @import { Items } from "../sheet.js" */
/** @import { Snapped } from "../snap.js" */

/** Cloth that is grabbed so near to an edge is grabbed by that edge (px). */
const BY_EDGE_PX = 20;
/** Kinds of snaps that mean the point itself, not its edge. */
const POINTS = new Set(["vertex", "fraction"]);

const UNCLOSED = say("hint.outline_open");

/**
 * A stroke across the cloth.
 * @typedef {object} Stroke
 * @property {boolean} isGrab whether it takes cloth along; else it is the fold's line
 * @property {boolean} isEarly whether it began while folds before it were still being made
 * @property {boolean} isTouch
 * @property {Point} from
 * @property {Point} to
 * @property {Laid[]} laid where it would have to end to lay one edge on another
 * @property {number} step the moment of the folds at which it began
 * @property {number} version the document's at that time
 */

/** Whether a stroke is too short to mean anything. @param {Stroke} stroke */
export const isShort = ({ from, to }) => distance(from, to) < STROKE_MIN_M;

/** Why there is nothing to draw a fold on. @param {Board} board */
export function whyNoCloth({ paint, step, tools }) {
  if (FOLD_KINDS[paint.kind].takesFlap && step === 0) return translated(FIRST_IS_RED);
  return tools.outline.isBusy ? UNCLOSED : translated(NO_CLOTH);
}

/**
 * Whether a stroke that begins there takes cloth along: inside it always, at its edges and corners when told to.
 * @param {Board} board
 * @param {Snapped} snapped
 * @param {Pointer} pointer
 */
export const isGrabbed = (board, { at, isOnCloth }, pointer) =>
  isOnCloth ? isToGrab(board, pointer) : isInside(at, board.rings);

/** @param {Board} board @param {Pointer} pointer */
export const isToGrab = ({ paint }, { alt }) => alt || paint.grabs;

/** The fold's line; what lies to its left moves. @param {Stroke} stroke @param {Board} board */
export const lineAlong = (stroke, { rings, paint }) => lineOf(stroke, rings, paint.isFlipped);

/** Whether a stroke is drawn beside the cloth. @param {Stroke} stroke @param {Board} board */
export const isBeside = (stroke, { rings, view }) =>
  !stroke.isGrab && !reachesCloth(stroke, rings, reachPx(stroke) / view.scale);

/** Whether a stroke begins at an edge of the cloth as it is by now. @param {Stroke} stroke @param {Board} board */
export function beginsOnEdge(stroke, { rings, view }) {
  const near = nearestOnRings(stroke.from, rings);
  return near !== null && distance(near, stroke.from) * view.scale <= reachPx(stroke);
}

/** @param {Stroke} stroke */
const reachPx = ({ isTouch }) => (isTouch ? 2 : 1) * REACH_PX.edge;

/**
 * Where a stroke would have to end to lay one edge on another.
 * @param {Board} board
 * @param {Snapped} snapped
 * @param {Pick<Stroke, "isGrab"|"isTouch">} how
 * @returns {Laid[]}
 */
export function laidFrom({ rings, view }, { at, kind }, { isGrab, isTouch }) {
  if (!isGrab) return endsOnto(at, rings);
  const reach_m = ((isTouch ? 2 : 1) * BY_EDGE_PX) / view.scale;
  const edge = kind !== undefined && POINTS.has(kind) ? null : edgeNear(at, rings, reach_m);
  return edge ? dropsOnto(at, edge, rings) : [];
}

/** @param {Stroke} stroke @param {Board} board @returns {Items} */
export function strokeItems(stroke, board) {
  const { view, paint } = board;
  const [from, to] = [view.toPx(stroke.from), view.toPx(stroke.to)];
  const dots = [from, to].map(([cx, cy], n) => ({
    key: `end${n}`,
    tag: "circle",
    class: `handle fold-end is-${paint.kind}`,
    cx,
    cy,
    r: 4,
  }));
  if (isShort(stroke)) return dots;
  const [a, b] = lineAlong(stroke, board);
  /** @type {[Point, Point]} */
  const ends = [view.toPx(a), view.toPx(b)];
  return [
    ...foldItems({ key: "stroke", kind: paint.kind, ends, state: " is-selected", number: null }),
    stroke.isGrab && { key: "carry", tag: "path", class: "carry", d: `M${from.join(" ")}L${to.join(" ")}` },
    ...dots,
    !stroke.isGrab && lengthLabel("length", from, to, distance(stroke.from, stroke.to)),
  ];
}
