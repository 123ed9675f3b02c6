/**
 * Where a pointer means: at a corner, a fraction of an edge, an edge, in line with another corner, on the grid.
 * The strongest kind within its reach wins, a crossing before its lines, and the nearest of that kind; what holds lets go a little further off than
 * where it takes hold.
 */

import { say } from "../language/say.js";
import { edgePoints, handleOf, outlineEdges } from "./curves.js";
import { spacing } from "./draw_grid.js";
import { between, distance, dot, edgesOf, left, minus, nearestOn, plus, times, turned, unit as direction } from "./geometry.js";
import { FRACTIONS, REACH_PX } from "./rules.js";

/** @import { View } from "./view.js" */
/** @import { Drawing, Point } from "pleat" */

/** @typedef {keyof typeof REACH_PX} Kind */
const KINDS = /** @type {Kind[]} */ (Object.keys(REACH_PX));
const RELEASE = 1.5;
const TOUCH = 2;
const KEYS = 0.25;
/** A point is moved by no more cloth, and no further on the screen, than that; to close an outline moves none. */
const MOST_M = 0.01;
const MOST_PX = 8;
const TURN_RAD = Math.PI / 12;

/**
 * @typedef {object} Snapped garment frame (m)
 * @property {Point} at
 * @property {string} name
 * @property {string} key
 * @property {boolean} isOnCloth
 * @property {Kind} [kind] none where nothing snaps
 * @property {Point} [where] it is shown, where that is not the same
 */
/**
 * @typedef {object} Targets what is visible and may be snapped to
 * @property {Point[][]} rings the cloth's outlines
 * @property {Point[]} points further corners
 * @property {Point|null} [close] a first point that would close a ring
 * @property {Point|null} [from] where the line that is being drawn begins
 * @property {Point[]} [guides] corners to be in line with
 * @property {import("./edge_onto_edge.js").Laid[]} [laid] where an edge would be laid on another
 * @property {boolean} [onlyCloth] whether grid and guides are left out
 * @property {[Point, Point]} [bent] the ends of the edge that is being bent
 * @property {Soft} [soft] the curves of the cloth: their points are no corners
 */

/** @typedef {{at: Point, isTouch: boolean, isKeyboard: boolean, ctrl: boolean, shift: boolean}} Pointed */

export class Snapper {
  constructor() {
    this.isOn = localStorage.getItem("pleat-snap") !== "off";
    this.heldKey = "";
  }

  /** @param {boolean} on */
  turn(on) {
    this.isOn = on;
    localStorage.setItem("pleat-snap", on ? "on" : "off");
  }

  /** @param {View} view @param {Pointed} pointer @param {Targets} targets @returns {Snapped} */
  snap(view, pointer, targets) {
    const wanted = pointer.shift && targets.from ? straightened(pointer.at, targets.from) : null;
    const free = { at: wanted ?? pointer.at, name: wanted ? "15\u00B0" : "", key: "", isOnCloth: false };
    const isOff = pointer.ctrl || !this.isOn;
    const found = isOff || wanted ? null : this.strongest(view, pointer, targets);
    this.heldKey = found?.key ?? "";
    return found ?? free;
  }

  /** @param {View} view @param {Pointed} pointer @param {Targets} targets @returns {Snapped|null} */
  strongest(view, pointer, targets) {
    const wide = pointer.isKeyboard ? KEYS : pointer.isTouch ? TOUCH : 1;
    for (const kind of KINDS) {
      /** @type {(Snapped & {away: number})|null} */
      let best = null;
      for (const candidate of CANDIDATES[kind](pointer.at, targets, view)) {
        const away = distance(candidate.where ?? candidate.at, pointer.at) * view.scale;
        const most = kind === "close" ? Infinity : Math.min(MOST_M * view.scale, MOST_PX);
        const reach = Math.min(REACH_PX[kind] * wide * (candidate.key === this.heldKey ? RELEASE : 1), most);
        if (away <= reach && (!best || away < best.away)) best = { ...candidate, kind, away };
      }
      if (best) return best;
    }
    return null;
  }
}

/** @type {Record<Kind, (at: Point, targets: Targets, view: View) => Snapped[]>} */
const CANDIDATES = {
  close: (_, { close }) => (close ? [{ at: close, name: "close", key: "close", isOnCloth: false }] : []),
  vertex: (_, { rings, points, soft }) => [
    ...rings.flat().filter((at) => !soft?.has(at)).map((at) => ({ at, name: "vertex", key: `v${at}`, isOnCloth: true })),
    ...points.map((at) => ({ at, name: "vertex", key: `v${at}`, isOnCloth: false })),
  ],
  dropped: (p, { laid = [], bent }) => [
    ...laid.flatMap(({ at, on }) => (on ? [onto(at, at), onto(at, nearestOn(p, on[0], on[1]))] : [])),
    ...(bent ? [{ at: nearestOn(p, ...bent), name: say("snap.straight"), key: "straight", isOnCloth: false }] : []),
  ],
  fraction: (_, { rings, bent, soft }) => [
    ...rings
      .flatMap(edgesOf)
      .filter(([a, b]) => !soft?.has(a) && !soft?.has(b))
      .flatMap(([a, b]) =>
        FRACTIONS.map(([part, whole]) => ({
          at: between(a, b, part / whole),
          name: whole === 2 ? "midpoint" : say("snap.fraction", { part, whole }),
          key: `${part}/${whole}${a}${b}`,
          isOnCloth: true,
        })),
      ),
    ...(rings.length && soft ? soft.handles : []).map((at) => ({ at, name: "midpoint", key: `m${at}`, isOnCloth: true })),
    ...(bent ? halfCircles(bent) : []),
  ],
  bisector: (p, { laid = [], bent }) => [
    ...laid.flatMap(({ at, on }) => (on ? [] : [onto(at, at)])),
    ...(bent ? [arc(p, bent)] : []),
  ],
  edge: (p, { rings }, view) =>
    rings.flatMap(edgesOf).map(([a, b]) => ({
      at: roundOnEdge(nearestOn(p, a, b), a, b, view),
      name: "edge",
      key: `e${a}${b}`,
      isOnCloth: true,
    })),
  guides: (p, { guides = [], onlyCloth }) => (onlyCloth ? [] : inLine(p, guides).slice(0, 1)),
  guide: (p, { guides = [], onlyCloth }) => (onlyCloth ? [] : inLine(p, guides).slice(1)),
  grid: (p, { onlyCloth }, view) => (onlyCloth ? [] : onGrid(p, view).slice(0, 1)),
  line: (p, { onlyCloth }, view) => (onlyCloth ? [] : onGrid(p, view).slice(1)),
};

/** The handle that makes an edge an arc of a circle. @param {Point} p @param {[Point, Point]} edge @returns {Snapped} */
function arc(p, [a, b]) {
  const [middle, way] = [between(a, b), left(direction(minus(b, a)))];
  return { at: plus(middle, times(way, dot(minus(p, middle), way))), name: say("snap.arc"), key: "arc", isOnCloth: false };
}

/** The handles that make an edge half a circle. @param {[Point, Point]} edge @returns {Snapped[]} */
function halfCircles([a, b]) {
  const [middle, rise] = [between(a, b), times(left(minus(b, a)), 0.5)];
  return [1, -1].map((side) => ({
    at: plus(middle, times(rise, side)),
    name: say("snap.half_circle"),
    key: `half${side}`,
    isOnCloth: false,
  }));
}

/** @param {Point} at @param {Point} where @returns {Snapped} */
const onto = (at, where) => ({ at, where, name: say("snap.edge_onto_edge"), key: `o${at}`, isOnCloth: false });

/**
 * A place on an edge, moved to where the edge crosses a line of the grid if that is near.
 * @param {Point} p
 * @param {Point} a
 * @param {Point} b
 * @param {View} view
 */
function roundOnEdge(p, a, b, view) {
  const { step } = spacing(view.scale);
  let best = p;
  let least = REACH_PX.grid / view.scale;
  for (const axis of /** @type {const} */ ([0, 1])) {
    const share = (Math.round(p[axis] / step) * step - a[axis]) / (b[axis] - a[axis]);
    if (!(share >= 0 && share <= 1)) continue;
    const crossing = between(a, b, share);
    if (distance(crossing, p) < least) [best, least] = [crossing, distance(crossing, p)];
  }
  return best;
}

/**
 * Where the lines plumb to and level with the nearest corners cross, and the place on each of the two.
 * @param {Point} p
 * @param {Point[]} guides
 * @returns {Snapped[]}
 */
function inLine(p, guides) {
  const [first] = guides;
  if (!first) return [];
  /** @param {0|1} axis */
  const nearest = (axis) =>
    guides.reduce((best, g) => (Math.abs(g[axis] - p[axis]) < Math.abs(best[axis] - p[axis]) ? g : best), first);
  const [plumb, level] = [nearest(0), nearest(1)];
  return [
    {
      at: /** @type {Point} */ ([plumb[0], level[1]]),
      name: say("snap.in_line"),
      key: `i${plumb}${level}`,
      isOnCloth: false,
    },
    { at: /** @type {Point} */ ([plumb[0], p[1]]), name: "plumb", key: `x${plumb}`, isOnCloth: false },
    { at: /** @type {Point} */ ([p[0], level[1]]), name: "level", key: `y${level}`, isOnCloth: false },
  ];
}

/**
 * Where two lines of the grid cross, and the place on each of the two.
 * @param {Point} p
 * @param {View} view
 * @returns {Snapped[]}
 */
function onGrid(p, view) {
  const { step } = spacing(view.scale);
  const [x, y] = [Math.round(p[0] / step) * step, Math.round(p[1] / step) * step];
  return [
    { at: /** @type {Point} */ ([x, y]), name: "grid", key: `g${x},${y}`, isOnCloth: false },
    { at: /** @type {Point} */ ([x, p[1]]), name: say("snap.grid_line"), key: `gx${x}`, isOnCloth: false },
    { at: /** @type {Point} */ ([p[0], y]), name: say("snap.grid_line"), key: `gy${y}`, isOnCloth: false },
  ];
}

/** The point moved onto the nearest direction of so many times 15 degrees. @param {Point} p @param {Point} from */
export function straightened(p, from) {
  const along = minus(p, from);
  const angle = Math.round(Math.atan2(along[1], along[0]) / TURN_RAD) * TURN_RAD;
  const way = turned([1, 0], angle);
  return plus(from, times(way, dot(along, way)));
}

/** The point so far from a on the way to b and beyond. @param {Point} a @param {Point} b @param {number} metres */
export const atLength = (a, b, metres) => plus(a, times(direction(minus(b, a)), metres));

/** Points of the server's cloth are told from those of the page by no more than this (m). */
const SAME_M = 1e-4;

/** The points that stand for the curves of a drawing: no corners to a hand that looks for one. */
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
