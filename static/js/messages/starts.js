/** The state of the world from which a plan starts, in words. */

import { moved } from "./directions.js";
import { length, listed } from "./lengths.js";
import { called, place } from "./names.js";

/** @import { Drawing, PlanStart } from "pleat" */

const NOTICEABLE_M = 0.001;

/**
 * What has been done by then, as in `Planned from after: folded “left sleeve”`.
 * @param {PlanStart} start
 * @param {Drawing} drawing what is planned, as it would be from the beginning
 */
export function startInWords(start, drawing) {
  const { folds_done: done } = start;
  const folded = done.length
    ? `Planned from after: folded ${done.map((fold) => called(drawing.folds, fold)).join(", ")}`
    : `Planned from the middle: nothing folded yet${carried(start, drawing)}`;
  return [folded, standing(start, drawing), holding(start)].filter(Boolean).join("; ");
}

/** How far the cloth was dragged. @param {PlanStart} start @param {Drawing} drawing */
function carried({ placement: now }, { placement }) {
  const way = moved([now.x_m - placement.x_m, now.y_m - placement.y_m]);
  return way && `; the cloth dragged ${way}`;
}

/** Where the robot stands, unless it is where it usually begins. @param {PlanStart} start @param {Drawing} drawing */
function standing({ base }, { start_station: usual }) {
  const back = base.back_off_m > NOTICEABLE_M ? `${length(base.back_off_m)} back` : "";
  const station = base.station && base.station !== usual ? place(base.station) : "";
  const where = [station || (back && place(base.station ?? "")), back].filter(Boolean).join(", ");
  return where && `robot at ${where}`;
}

/** @param {PlanStart} start */
function holding({ held }) {
  const arms = held.map(({ arm }) => arm);
  return arms.length ? `the ${listed(arms)} ${arms.length > 1 ? "hands hold" : "hand holds"} the cloth` : "";
}
