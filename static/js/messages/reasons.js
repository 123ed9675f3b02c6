/** Why the planner found no plan, with all the numbers. */

import { moved } from "./directions.js";
import { area, enough, height, length, listed, onGarment, onTable, point } from "./lengths.js";
import { called, counted, stand } from "./names.js";

/** @import { Says } from "pleat" */

const OBLIQUE = 0.5;
const LISTED_MAX = 4;

/** @type {Record<string, string>} */
const MOMENTS = {
  pick: "where it is picked up",
  place: "where it is laid down",
  top: "at the top of its way, as high as it is far from the fold line",
  up: "on its way up",
  down: "on its way down",
};
/** @type {Record<string, string>} */
const DEMANDS = {
  alone: "",
  "one orientation": " in the orientation that suits its way best",
  driving: " from where the base is by then",
  "with the other hand": " from where the other hand has what it needs",
};
/** @type {Record<string, string>} */
const CAUSES = {
  too_far: "too far",
  too_near: "too near",
  joint_limit: "joint limit",
  own_body: "the robot\u2019s own body is in the way",
};
/** Along the axes of the base frame. */
const SIDES = [
  ["further from the robot", "nearer to the robot"],
  ["further to its left", "further to its right"],
  ["higher", "lower"],
];

/** A number of hands. @param {number} count */
const countedHands = (count) => (count === 1 ? "one hand" : `${count} hands`);

/** @type {import("./in_words.js").Catalogue} */
export const REASONS = {
  out_of_reach: (says) => {
    const { arm, at, moment, station, back_off_m: backOff } = says;
    const isFixed = !station && backOff === 0;
    return (
      `the ${arm} grip at ${onTable(at)}, ${height(at[2])} ${MOMENTS[moment]}, ${lack(says)}` +
      (isFixed ? "" : `. Closest: ${stand(station)}, backed off ${length(backOff)}`) +
      `${carried(says)}${whatToDo(says)}`
    );
  },
  too_many_grips: ({ points, hands, grip_radius_m: radius, needed_grip_radius_m: needed }) =>
    `${points.length} points of its edge must be held, ${outermost(points)}: more than ${countedHands(hands)} can when each ` +
    `holds what is within ${length(radius)} of it. A grip radius of ${enough(needed)} would do, or a fold that moves less`,
  grips_too_close: ({ points, apart_m, needed_apart_m, grip_radius_m: radius, needed_grip_radius_m: needed }) =>
    `its grips, at ${several(points)}, are ${length(apart_m)} apart, and two hands need ${length(needed_apart_m)}. ` +
    `With a grip radius of ${enough(needed)}, now ${length(radius)}, one hand would hold both`,
  red_unheld: ({ at, before }, folds) =>
    `${onGarment(at)} must be held, but no hand that still holds from ${called(folds, before)} is on the part that ` +
    "moves. Make it a blue fold",
  red_held_too_far: ({ at, before, grip_radius_m: radius, needed_grip_radius_m: needed }, folds) =>
    `${onGarment(at)} must be held, but the nearest hand that still holds from ${called(folds, before)} is ` +
    `${length(needed)} away and holds what is within ${length(radius)}. A grip radius of ${enough(needed)} would do, ` +
    "or a blue fold",
  arms_cannot_get_there: (says) =>
    `${dragging(says)}from ${stand(says.station)} the hands could be where they must, but the arms cannot get them ` +
    `there and along their way without touching the table, the robot or each other${carried(says)}`,
  collision: (says) =>
    `${dragging(says)}from ${stand(says.station)} all is in reach, but with the ${says.arm} gripper at ` +
    `${onTable(says.at)}, ${height(says.at[2])}, the ${says.parts[0]} would hit the ${says.parts[1]} by ` +
    `${length(says.depth_m)} at least, however the arm is bent${carried(says)}`,
  line_off_table: (says) =>
    `all of its line lies beyond the table\u2019s edge, by ${length(says.off_m)}${carried(says)}. A part must be on ` +
    "the table",
  behind_line: (says) =>
    `the part that moves reaches ${length(says.behind_m)} behind the line\u2019s extension, where the fold cannot ` +
    `carry it${carried(says)}. Turn or lengthen the line, or fold that part by itself first`,
  at_start: ({ what, is_too_large: isTooLarge }, folds) =>
    `as the garment lies at the start, ${REASONS[what.code](what, folds)}. ` +
    (isTooLarge ? "It is too large for the table" : "Place it so that it stays"),
  afterwards: (says, folds) => `afterwards ${REASONS[says.what.code](says.what, folds)}${carried(says)}`,
  beside_table: ({ off_m: off }) => `nothing of the cloth lies on the table: it is ${length(off)} beside it`,
  corner_covered: ({ corner, depth_m: depth }) =>
    `the cloth covers the table\u2019s corner at ${onTable(corner)}, which is ${length(depth)} inside it`,
  hangs_from_several: ({ area_m2: m2, edges }) =>
    `a part of ${area(m2)} hangs from ${edges.length ? `the ${edges.join(" and the ")} edge` : "no edge"} at once`,
  hangs_loose: ({ layer, edge, at, beyond_m: beyond }) =>
    `layer ${counted(layer)} hangs over the ${edge} edge and nothing holds its corner at ${onGarment(at)}, ` +
    `${length(beyond)} beyond the edge`,
  slips,
  slips_on_the_way: ({ friction, needed_friction: needed }) =>
    `the cloth slips wherever it would be in reach. The friction is ${friction.toFixed(2)}` +
    (needed === null ? "" : `, ${(Math.ceil(100 * needed - 1e-6) / 100).toFixed(2)} would hold it`),
  wider_grip: ({ grip_radius_m: radius, needed_grip_radius_m: needed, in_drags: isInDrags }) =>
    `a grip radius of ${enough(needed)}${isInDrags ? ", in drags too," : ""} would do, now ${length(radius)}`,
  stiffer_cloth: ({ support_angle_rad: angle, needed_support_angle_rad: needed }) =>
    `too many points must be held, unless cloth holds itself within ${degrees(needed)} of upright, now ${degrees(angle)}`,
  one_more_hand: ({ hands }) => `must be held at more points than ${countedHands(hands)} can. One more would do`,
  waits_for: ({ folds: roots }, folds) =>
    `waits for ${listed(roots.map((/** @type {number} */ root) => called(folds, root)))}, which cannot be done`,
  not_with_the_others: () => "can be done, but not together with the others",
};

/** By how much a point is out of reach, and why. @param {Says} says */
function lack({ cause, joint, demand, towards, comfort_m, wanted_comfort_m: wanted, ...by }) {
  const limit = joint ? `${joint} limit` : "";
  const short = `${by.is_at_least ? "at least " : ""}${length(by.short_by_m)}`;
  if (cause === "comfort_only") {
    return (
      `can be reached, but with ${length(comfort_m ?? 0)} of comfort only, not ${length(wanted)}${DEMANDS[demand]} ` +
      `(${limit || "too far"}): it is ${short} out of comfort`
    );
  }
  const isUpright = cause.startsWith("too_") && !by.is_at_least && Math.abs(towards[2]) > OBLIQUE;
  const why = `${CAUSES[cause]}${isUpright ? (towards[2] > 0 ? " down" : " up") : ""}`;
  return `is ${short} out of reach${DEMANDS[demand]} (${[why, limit].filter(Boolean).join(", ")})`;
}

/** What a person can change, of what the planner has tried. @param {Says} says */
function whatToDo({ movable, shift_m: by, shift_towards: towards, enough_comfort_m: comfort, ...says }) {
  if (typeof comfort === "number") return `. With ${length(comfort)} of comfort it can be done`;
  if (typeof says.enough_cone_rad === "number") {
    return `. With pinches from within ${degrees(says.enough_cone_rad)} of the way into the cloth it can be done`;
  }
  if (!movable) return "";
  if (movable.length) return `. All of its way is in reach ${length(by)} ${whereTo(towards)}: ${how(movable, towards[2])}`;
  if (says.is_at_least) return ". Place the cloth or a station so that it is nearer";
  return `. No shift of its way by up to ${length(says.tried_m)} was found that brings it about: fold less at once`;
}

/** @param {number} rad */
const degrees = (rad) => `${Math.round((180 * rad) / Math.PI)}\u00b0`;

/** What can be moved so far, by its name, and whether that is up. @param {string[]} movable @param {number} up */
function how(movable, up) {
  const [table, torso] = up > 0 ? ["raise the table", "lower the torso"] : ["lower the table", "raise the torso"];
  const station = movable.includes("cloth") ? "the station" : "move the station";
  /** @type {Record<string, string>} */
  const words = { cloth: "move the cloth", station, table, torso };
  return movable.map((name) => words[name]).join(" or ");
}

/** A direction of the base frame in words. @param {number[]} towards */
function whereTo(towards) {
  const words = SIDES.flatMap(([more, less], axis) =>
    Math.abs(towards[axis]) > OBLIQUE ? [towards[axis] > 0 ? more : less] : [],
  );
  return words.join(" and ") || "nearer to its shoulder";
}

/** Where drags had brought the cloth. @param {Says} says */
function carried({ dragged, is_held: isHeld }) {
  const way = dragged ? moved(dragged) : "";
  return way && ` (the cloth dragged ${way} from where it starts${isHeld ? " and held on to" : ""})`;
}

/** The drag in which the arms collide. @param {Says} says */
const dragging = ({ drag }) => (drag ? `to drag the cloth ${moved(drag)}, ` : "");

/** @param {number[][]} points */
const several = (points) => `${listed(points.map(point))} of the garment`;

/** All of a few points, else the outermost. @param {number[][]} points */
function outermost(points) {
  if (points.length <= LISTED_MAX) return `at ${several(points)}`;
  return `from ${point(points[0])} round to ${onGarment(points[points.length - 1])}`;
}

/** @param {Says} says */
function slips({ hanging_m2: hanging, lying_m2: lying, friction, needed_friction: needed }) {
  /** @type {Record<string, number>} */
  const areas = hanging;
  const whole = lying + Object.values(areas).reduce((sum, m2) => sum + m2, 0);
  /** @param {number} m2 */
  const share = (m2) => `${area(m2)} (${Number(((100 * m2) / whole).toFixed(1))} %)`;
  const over = Object.entries(areas).map(([edge, m2]) => `${share(m2)} hang over the ${edge} edge`);
  return (
    `the cloth slips: ${over.join(", ")} and ${share(lying)} lie on the table, layers counted. ` +
    `The friction is ${friction.toFixed(2)}, ${(Math.ceil(100 * needed - 1e-6) / 100).toFixed(2)} would hold it`
  );
}
