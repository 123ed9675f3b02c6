/** The cloth at the moment that is shown: spread out, or the layers of the stack with their backs hatched. */

import { ringOf } from "./curves.js";
import { path } from "./sheet.js";

/** @import { Layer, Point } from "pleat" */
/** @import { Board } from "./board.js" */
/** @import { Items } from "./sheet.js" */
/** @import { View } from "./view.js" */

/** @param {Board} board @returns {Items} */
export function drawCloth(board) {
  const { played, previewed } = board;
  if (previewed) return [drawn(board), ...layers(board.view, previewed)];
  if (board.isPlaying && played) return layers(board.view, played.layers);
  if (board.isStopped && played) return [drawn(board), ...layers(board.view, played.layers)];
  return board.isSpread ? spread(board) : stacked(board);
}

/** Cloth as it is while the plan is played. @param {View} view @param {Pick<Layer, "polygon"|"face">[]} stack @returns {Items} */
function layers(view, stack) {
  return stack.flatMap(({ polygon, face }, index) => {
    const d = path(polygon.map((point) => view.toPx(point)));
    return [
      { key: `layer${index}`, tag: "path", class: `cloth is-${face}`, d },
      face === "back" && { key: `hatch${index}`, tag: "path", class: "cloth-hatch", d },
      { key: `rim${index}`, tag: "path", class: "cloth-rim", d },
    ];
  });
}

/** @param {Board} board @returns {Items} */
function spread({ view, drawing }) {
  const points = ringOf(drawing).map((point) => view.toPx(point));
  const isRing = points.length >= 3;
  return [
    isRing && { key: "front", tag: "path", class: "cloth is-front", d: path(points) },
    { key: "edge", tag: "path", class: "cloth-edge", d: path(points, isRing) },
  ];
}

/** The outline as it is drawn, below cloth that lies otherwise. @param {Pick<Board, "view"|"drawing">} board */
function drawn({ view, drawing }) {
  const d = path(ringOf(drawing).map((point) => view.toPx(point)));
  return { key: "before", tag: "path", class: "cloth-before", d };
}

/** @param {Board} board @returns {Items} */
function stacked({ view, drawing, layers, shown }) {
  /** @param {Point[]} points */
  const ring = (points) => path(points.map((point) => view.toPx(point)));
  const before = drawn({ view, drawing });
  if (!layers)
    return [before, { key: "whole", tag: "path", class: "cloth is-front", d: shown.silhouette.map(ring).join("") }];
  const stack = layers.flatMap(({ polygon, face, moved }, index) => [
    { key: `layer${index}`, tag: "path", class: `cloth is-${face}${moved ? " is-moved" : ""}`, d: ring(polygon) },
    face === "back" && { key: `hatch${index}`, tag: "path", class: "cloth-hatch", d: ring(polygon) },
    { key: `rim${index}`, tag: "path", class: "cloth-rim", d: ring(polygon) },
  ]);
  return [before, ...stack, { key: "edge", tag: "path", class: "cloth-edge", d: shown.silhouette.map(ring).join("") }];
}
