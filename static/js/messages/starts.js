/** The state of the world from which a plan starts, in words. */

import { say } from "../language/say.js";
import { moved } from "./directions.js";
import { length, listed } from "./lengths.js";
import { called, place, word } from "./names.js";

/** @import { Drawing, PlanStart } from "pleat" */

const NOTICEABLE_M = 0.001;

/**
 * What has been done by then, as in `Planned from after: folded “left sleeve”`.
 * @param {PlanStart} start
 * @param {Drawing} drawing what is planned, as it would be from the beginning
 */
export function startInWords(start, drawing) {
  const { folds_done: done } = start;
  const folds = done.map((fold) => called(drawing.folds, fold)).join(", ");
  const folded = done.length ? say("start.after", { folds }) : fromMiddle(start, drawing);
  return [folded, standing(start, drawing), holding(start)].filter(Boolean).join("; ");
}

/** How far the cloth was dragged. @param {PlanStart} start @param {Drawing} drawing */
function fromMiddle({ placement: now }, { placement }) {
  const way = moved([now.x_m - placement.x_m, now.y_m - placement.y_m]);
  return way ? say("start.middle.dragged", { way }) : say("start.middle");
}

/** Where the robot stands, unless it is where it usually begins. @param {PlanStart} start @param {Drawing} drawing */
function standing({ base }, { start_station: usual }) {
  const back = base.back_off_m > NOTICEABLE_M ? say("place.back", { length: length(base.back_off_m) }) : "";
  const station = base.station && base.station !== usual ? place(base.station) : "";
  const where = [station || (back && place(base.station ?? "")), back].filter(Boolean).join(", ");
  return where && say("start.robot_at", { where });
}

/** @param {PlanStart} start */
function holding({ held }) {
  const arms = listed(held.map(({ arm }) => word("hand", arm)));
  return held.length ? say(held.length > 1 ? "start.hands_hold" : "start.hand_holds", { arms }) : "";
}
