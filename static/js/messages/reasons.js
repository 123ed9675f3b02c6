/** Why the planner found no plan, with all the numbers. */

import { say } from "../language/say.js";
import { hundredths } from "./changes.js";
import { moved } from "./directions.js";
import { area, either, enough, height, length, listed, onGarment, onTable, percent, point } from "./lengths.js";
import { called, counted, stand, word } from "./names.js";

/** @import { Reason, Says } from "pleat" */

const OBLIQUE = 0.5;
const LISTED_MAX = 4;
/** Less is not told (m). */
export const SMALL_M = 5e-4;

/** @type {Record<string, string>} */
const MOMENTS = {
  pick: say("moment.pick"),
  place: say("moment.place"),
  top: say("moment.top"),
  up: say("moment.up"),
  down: say("moment.down"),
};
/** @type {Record<string, string>} */
const DEMANDS = {
  alone: "",
  "one orientation": say("demand.one_orientation"),
  driving: say("demand.driving"),
  "with the other hand": say("demand.with_the_other_hand"),
};
/** Along the axes of the base frame. */
const SIDES = [
  [say("side.ahead"), say("side.back")],
  [say("side.left"), say("side.right")],
  [say("side.up"), say("side.down")],
];

/** A number of hands. @param {number} count */
const countedHands = (count) => say("hands.counted", { count });

/** @type {import("./in_words.js").Catalogue} */
export const REASONS = {
  out_of_reach: (says) => {
    const { arm, at, moment, station, back_off_m: backOff } = says;
    const isFixed = !station && backOff === 0;
    const told = {
      arm: word("arm", arm),
      at: onTable(at),
      height: height(at[2]),
      moment: MOMENTS[moment],
      lack: lack(says),
    };
    const closest = isFixed ? "" : say("advice.closest", { station: stand(station), back_off: length(backOff) });
    return say("message.out_of_reach", { ...told, closest, carried: carried(says), advice: advice(says) });
  },
  too_many_grips: ({ points, hands, grip_radius_m: radius, needed_grip_radius_m: needed }) =>
    say("message.too_many_grips", {
      points: points.length,
      where: outermost(points),
      hands: countedHands(hands),
      radius: length(radius),
      needed: enough(needed),
    }),
  grips_too_close: ({ points, apart_m, needed_apart_m, grip_radius_m: radius, needed_grip_radius_m: needed }) =>
    say("message.grips_too_close", {
      points: several(points),
      apart: length(apart_m),
      needed_apart: length(needed_apart_m),
      needed: enough(needed),
      radius: length(radius),
    }),
  red_unheld: ({ at, before }, folds) =>
    say("message.red_unheld", { at: onGarment(at), before: called(folds, before) }),
  red_held_too_far: ({ at, before, grip_radius_m: radius, needed_grip_radius_m: needed }, folds) =>
    say("message.red_held_too_far", {
      at: onGarment(at),
      before: called(folds, before),
      away: length(needed),
      radius: length(radius),
      needed: enough(needed),
    }),
  arms_cannot_get_there: (says) =>
    say("message.arms_cannot_get_there", {
      dragging: dragging(says),
      station: stand(says.station),
      carried: carried(says),
    }),
  collision: (says) =>
    say("message.collision", {
      dragging: dragging(says),
      station: stand(says.station),
      arm: word("arm", says.arm),
      at: onTable(says.at),
      height: height(says.at[2]),
      first: word("part", says.parts[0]),
      second: word("part", says.parts[1]),
      depth: length(says.depth_m),
      carried: carried(says),
    }),
  line_off_table: (says) => say("message.line_off_table", { off: length(says.off_m), carried: carried(says) }),
  turn_off_table: (says) => say("message.turn_off_table", { off: length(says.off_m), carried: carried(says) }),
  behind_line: (says) => say("message.behind_line", { behind: length(says.behind_m), carried: carried(says) }),
  at_start: ({ what, is_too_large: isTooLarge }, folds) =>
    say(isTooLarge ? "message.at_start.too_large" : "message.at_start", { why: REASONS[what.code](what, folds) }),
  afterwards: (says, folds) =>
    say("message.afterwards", { why: REASONS[says.what.code](says.what, folds), carried: carried(says) }),
  beside_table: ({ off_m: off }) =>
    off < SMALL_M ? say("message.beside_table.at_edge") : say("message.beside_table", { off: length(off) }),
  corner_covered: ({ corner, depth_m: depth }) =>
    say("message.corner_covered", { corner: onTable(corner), depth: length(depth) }),
  hangs_from_several: ({ area_m2: m2, edges }) => {
    const names = edges
      .map((/** @type {string} */ edge) => word("edge", edge))
      .join(say("message.hangs_from_several.join"));
    if (!names) return say("message.hangs_from_several.none", { area: area(m2) });
    return say("message.hangs_from_several", { area: area(m2), edges: names });
  },
  hangs_loose: ({ layer, edge, at, beyond_m: beyond }) =>
    say("message.hangs_loose", {
      layer: counted(layer),
      edge: word("edge", edge),
      at: onGarment(at),
      beyond: length(beyond),
    }),
  slips,
  slips_on_the_way: ({ friction, needed_friction: needed }) =>
    needed === null
      ? say("message.slips_on_the_way", { friction: hundredths(friction) })
      : say("message.slips_on_the_way.needed", { friction: hundredths(friction), needed: roundedUp(needed) }),
  wider_grip: ({ grip_radius_m: radius, needed_grip_radius_m: needed, in_drags: isInDrags }) =>
    say(isInDrags ? "message.wider_grip.in_drags" : "message.wider_grip", {
      needed: enough(needed),
      radius: length(radius),
    }),
  stiffer_cloth: ({ support_angle_rad: angle, needed_support_angle_rad: needed }) =>
    say("message.stiffer_cloth", { needed: degrees(needed), now: degrees(angle) }),
  one_more_hand: ({ hands }) => say("message.one_more_hand", { hands: countedHands(hands) }),
  waits_for: ({ folds: roots }, folds) =>
    say("message.waits_for", { folds: listed(roots.map((/** @type {number} */ root) => called(folds, root))) }),
  not_with_the_others: () => say("message.not_with_the_others"),
};

/** By how much a point is out of reach, and why, as strip and panel say it. @param {Says} says */
export function lack({ cause, joint, demand: asked, towards, comfort_m, wanted_comfort_m, ...says }) {
  const limit = joint ? say("joint.limit", { joint: word("joint", joint) }) : "";
  const by = shortBy(says);
  const demand = DEMANDS[asked] ?? "";
  if (cause === "comfort_only") {
    const [comfort, wanted] = [length(comfort_m ?? 0), length(wanted_comfort_m ?? 0)];
    return say("lack.comfort", { comfort, wanted, demand, why: limit || say("cause.too_far"), by });
  }
  const isUpright = towards && !says.is_at_least && Math.abs(towards[2]) > OBLIQUE;
  const causes = [causeInWords(cause, isUpright ? (towards[2] > 0 ? "down" : "up") : ""), limit].filter(Boolean).join(", ");
  return say("lack.reach", { by, demand, why: causes && ` (${causes})` });
}

/** How much is missing, as strip, board and panel say it. @param {Says|Pick<Reason, "short_by_m"|"is_at_least">} data */
export function shortBy({ short_by_m: short, is_at_least: isAtLeast }) {
  const by = length(short ?? 0);
  return isAtLeast ? say("amount.at_least", { length: by }) : by;
}

/**
 * The way that the cloth had been dragged by then; empty for none. Of a drag in which the arms collide the reason's
 * message tells all of it, so that how far the hand had come is not told.
 * @param {Pick<Reason, "offset_m"|"says">} reason
 */
export const draggedBy = ({ offset_m: offset, says }) => (offset && !says?.drag ? moved(offset) : "");

/** @param {string|null} cause @param {"up"|"down"|""} upright where it is too far or too near, if that is straight there */
function causeInWords(cause, upright) {
  if (!cause) return "";
  if (cause === "too_far" || cause === "too_near") return say(upright ? `cause.${cause}.${upright}` : `cause.${cause}`);
  return say(cause === "joint_limit" ? "cause.joint_limit" : "cause.own_body");
}

/** What a person can change, of what the planner has tried. @param {Says} says */
function advice({ movable, shift_m: by, shift_towards: towards, enough_comfort_m: comfort, ...says }) {
  const isPart = says.is_enough === false;
  if (typeof comfort === "number") {
    return say(isPart ? "advice.comfort.part" : "advice.comfort", { comfort: length(comfort) });
  }
  if (typeof says.enough_cone_rad === "number") {
    return say(isPart ? "advice.cone.part" : "advice.cone", { cone: degrees(says.enough_cone_rad) });
  }
  if (!movable) return "";
  if (movable.length) {
    const [whereto, how] = [whereTo(towards), howTo(movable, towards[2])];
    return say("advice.shift", { length: length(by), whereto, how });
  }
  return says.is_at_least ? say("advice.nearer") : say("advice.fold_less", { length: length(says.tried_m) });
}

/** @param {number} rad */
const degrees = (rad) => `${Math.round((180 * rad) / Math.PI)}\u00b0`;

/** What can be moved so far, by its name, and whether that is up. @param {string[]} movable @param {number} up */
function howTo(movable, up) {
  /** @type {Record<string, string>} */
  const words = {
    cloth: say("move.cloth"),
    station: say(movable.includes("cloth") ? "move.station_too" : "move.station"),
    table: say(up > 0 ? "move.table_up" : "move.table_down"),
    torso: say(up > 0 ? "move.torso_down" : "move.torso_up"),
  };
  return either(movable.map((name) => words[name]));
}

/** A direction of the base frame in words. @param {number[]} towards */
function whereTo(towards) {
  const words = SIDES.flatMap(([more, less], axis) =>
    Math.abs(towards[axis]) > OBLIQUE ? [towards[axis] > 0 ? more : less] : [],
  );
  return listed(words) || say("side.shoulder");
}

/** Where drags had brought the cloth. @param {Says} says */
function carried({ dragged, is_held: isHeld }) {
  const way = dragged ? moved(dragged) : "";
  return way && say(isHeld ? "carried.held" : "carried", { way });
}

/** The drag in which the arms collide. @param {Says} says */
const dragging = ({ drag }) => (drag ? say("dragging", { way: moved(drag) }) : "");

/** @param {number[][]} points */
const several = (points) => say("points.several", { points: listed(points.map(point)) });

/** All of a few points, else the outermost. @param {number[][]} points */
function outermost(points) {
  if (points.length <= LISTED_MAX) return say("points.at", { points: listed(points.map(point)) });
  return say("points.round", { first: point(points[0]), last: onGarment(points[points.length - 1]) });
}

/** @param {Says} says */
function slips({ hanging_m2: hanging, lying_m2: lying, friction, needed_friction: needed }) {
  /** @type {Record<string, number>} */
  const areas = hanging;
  const whole = lying + Object.values(areas).reduce((sum, m2) => sum + m2, 0);
  /** @param {number} m2 */
  const share = (m2) => `${area(m2)} (${percent(m2 / whole, 1)})`;
  const over = Object.entries(areas).map(([edge, m2]) =>
    say("message.slips.over", { share: share(m2), edge: word("edge", edge) }),
  );
  return say("message.slips", {
    over: over.join(", "),
    lying: share(lying),
    friction: hundredths(friction),
    needed: roundedUp(needed),
  });
}

/** A friction that will do. @param {number} friction */
export const roundedUp = (friction) => hundredths(Math.ceil(100 * friction - 1e-6) / 100);

/** The reason that is told first, in words and on the board. @template {{message: string}} R @param {R[]} reasons */
export const toldReason = (reasons) => reasons.find((reason) => reason.message);
