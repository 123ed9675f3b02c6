/** What the robot can do and does: where its arms reach, the base's way, the hands' paths, the slip limit. */

import { ringOf } from "./curves.js";
import { say } from "../language/say.js";
import { word } from "../messages/names.js";
import { between, boxOf, cornersWithin, plus, turned } from "./geometry.js";
import { path } from "./sheet.js";
import { length } from "./units.js";
import { armLetter } from "../messages/arms.js";

/** @import { Overlays, Places, Point, Region } from "pleat" */
/** @import { Board } from "./board.js" */
/** @import { Items } from "./sheet.js" */
/** @import { View } from "./view.js" */

/** Beneath the cloth. @param {Board} board @param {Overlays|null} found @param {Places|null} places @returns {Items} */
export function drawUnder(board, found, places) {
  return [
    ...costs(board, places),
    ...(found ? [...table(board, found), ...reach(board, found), ...base(board, found)] : []),
  ];
}

/** Above the cloth. @param {Board} board @param {Overlays|null} found @returns {Items} */
export function drawOver(board, found) {
  return found ? [...outlines(board, found), ...slip(board, found), ...paths(board, found)] : [];
}

/** @param {View} view @param {Point[]} points */
const ring = (view, points) => path(points.map((point) => view.toPx(point)));
/** @param {View} view @param {Region} region */
const region = (view, { outer, holes }) => [outer, ...holes].map((points) => ring(view, points)).join("");
/** @param {View} view @param {Region[]} all */
const regions = (view, all) => all.map((one) => region(view, one)).join("");

/** @param {Board} board @param {Overlays} found @returns {Items} */
function table({ view, isPlacing }, found) {
  return isPlacing ? [] : [{ key: "table", tag: "path", class: "table is-faint", d: ring(view, found.table) }];
}

/** @param {Board} board @param {Overlays} found @returns {Items} */
function reach({ view }, found) {
  return (found.reach ?? []).map(({ arm, regions: all }) => ({
    key: `reach:${arm}`,
    tag: "path",
    class: `reach is-${arm}`,
    d: regions(view, all),
  }));
}

/** The limits of reach stay visible over the cloth. @param {Board} board @param {Overlays} found @returns {Items} */
function outlines({ view }, found) {
  const arms = found.reach ?? [];
  return arms.flatMap(({ arm, regions: all, bare }, n) => {
    const box = boxOf(all.flatMap(({ outer }) => outer));
    const [x, y] = box ? view.toPx(between(box.low, box.high)) : [0, 0];
    return [
      { key: `bare:${arm}`, tag: "path", class: "reach-line is-bare", d: regions(view, bare) },
      { key: `line:${arm}`, tag: "path", class: "reach-line", d: regions(view, all) },
      box && {
        key: `letter:${arm}`,
        tag: "text",
        class: "reach-letter",
        x: x + (n < arms.length / 2 ? -14 : 14),
        y,
        text: armLetter(arm),
      },
    ];
  });
}

/** @param {Board} board @param {Overlays} found @returns {Items} */
function base({ view }, found) {
  if (!found.base) return [];
  const { outline } = found.robot;
  return [
    { key: "robot", tag: "path", class: "robot-base", d: ring(view, outline) },
    {
      key: "way",
      tag: "path",
      class: "base-way",
      d: path(
        found.base.way.map((point) => view.toPx(point)),
        false,
      ),
    },
    ...found.base.stands.map(({ point, yaw_rad }, n) => {
      const [x, y] = view.toPx(point);
      const [ax, ay] = view.toPx(plus(point, turned([0.12, 0], yaw_rad)));
      return {
        key: `stand${n}`,
        tag: "path",
        class: "base-stand",
        d: `M${x - 4} ${y}a4 4 0 1 0 8 0a4 4 0 1 0 -8 0M${x} ${y}L${ax} ${ay}`,
      };
    }),
  ];
}

/** @param {Board} board @param {Overlays} found @returns {Items} */
function slip({ view }, found) {
  return (found.slip?.limits ?? []).flatMap(({ edge, line, at_m }, n) => {
    const [from, to] = [view.toPx(line[0]), view.toPx(line[1])];
    // Lines of opposite edges may be the same, to and fro: their words stand at its two ends.
    const [low, high] = from[0] < to[0] || (from[0] === to[0] && from[1] <= to[1]) ? [from, to] : [to, from];
    const [x, y] = between(low, high, n < 2 ? 0.08 : 0.76);
    return [
      { key: `slip:${edge}`, tag: "path", class: "slip", d: path([from, to], false) },
      {
        key: `slip:${edge}:text`,
        tag: "text",
        class: "length",
        x: x + 6,
        y: y - 6,
        text: say("slip.over", { length: length(at_m), edge: word("edge", edge) }),
      },
    ];
  });
}

/** @param {Board} board @param {Overlays} found @returns {Items} */
function paths(board, found) {
  const { view, step } = board;
  return (found.paths ?? []).flatMap(({ primitive, fold, grips }) => {
    if (step > 0 && fold !== step) return [];
    const state = primitive === found.primitive ? " is-now" : "";
    return grips.flatMap(({ arm, points, place }) => {
      const at = points.map(([x, y]) => view.toPx([x, y]));
      const [x, y] = view.toPx(place);
      return [
        { key: `path${primitive}:${arm}`, tag: "path", class: `hand-path${state}`, d: path(at, false) },
        { key: `path${primitive}:${arm}:end`, tag: "circle", class: `hand-end${state}`, cx: x, cy: y, r: 7 },
        {
          key: `path${primitive}:${arm}:letter`,
          tag: "text",
          class: `hand-letter${state}`,
          x,
          y: y + 3.5,
          text: armLetter(arm),
        },
      ];
    });
  });
}

/** How full the shade of a place is. @param {number} share 1 for the quickest, 0 for the slowest */
export const fullness = (share) => 0.1 + 0.5 * share;

/**
 * What the plan would cost if the garment's middle lay there: the stronger the cheaper.
 * @param {Board} board
 * @param {Places|null} places
 * @returns {Items}
 */
function costs({ view, drawing }, places) {
  const box = boxOf(ringOf(drawing));
  if (!places || !box) return [];
  const middle = between(box.low, box.high);
  const half = places.step_m / 2;
  const known = places.cells.map(({ cost_s }) => cost_s).filter((cost) => cost !== null);
  const [least, most] = [Math.min(...known), Math.max(...known)];
  return places.cells.flatMap(({ move, placement, cost_s }, n) => {
    const centre = plus(middle, move);
    const corners = cornersWithin(half, half).map((corner) => view.toPx(plus(centre, turned(corner, -placement.yaw_rad))));
    const share = cost_s === null || most === least ? 0.5 : (most - cost_s) / (most - least);
    const [x, y] = view.toPx(centre);
    return [
      {
        key: `cell${n}`,
        tag: "path",
        class: cost_s === null ? "cost is-none" : "cost",
        "fill-opacity": cost_s === null ? 0 : fullness(share),
        d: path(corners),
      },
      cost_s !== null &&
        places.step_m * view.scale > 34 && {
          key: `cost${n}`,
          tag: "text",
          class: "cost-text",
          x,
          y: y + 4,
          text: cost_s.toFixed(0),
        },
    ];
  });
}
