/** What can be taken hold of: corners, middles of edges, ends of folds. Each can have the focus and has a name. */

import { say, translated } from "../language/say.js";
import { edgePoints, handleOf, outlineEdges } from "./curves.js";
import { between, distance, left, lengthOf, minus, plus, times, unit as direction } from "./geometry.js";
import { path } from "./sheet.js";
import { length, number } from "./units.js";

/** @import { Board } from "./board.js" */
/** @import { Item, Items } from "./sheet.js" */
/** @import { Point } from "pleat" */

const CORNER_PX = 4.5;
const END_PX = 4.5;
const MIDDLE_PX = 3.5;
const LABEL_PX = 16;
const ROOM_FOR_MIDDLE_PX = 44;

/** @param {Board} board @returns {Items} */
export function drawHandles(board) {
  if (board.isPlacing) return [];
  return [...edges(board), ...foldHandles(board), ...(board.isSpread ? corners(board) : [])];
}

/** @param {Board} board @returns {Items} */
function corners(board) {
  const { drawing, view } = board;
  return drawing.outline.map(({ id, point }, index) => {
    const [cx, cy] = view.toPx(point);
    const isHovered = board.hover?.id === id;
    const state = `${board.isSelected("vertex", id) ? " is-selected" : ""}${isHovered ? " is-hovered" : ""}`;
    const label = say("handle.vertex", { number: index + 1, x: number(point[0]), y: length(point[1]) });
    return {
      key: `v:${id}`,
      tag: "circle",
      class: `handle corner${state}`,
      cx,
      cy,
      r: CORNER_PX,
      ...focusable("vertex", id, label),
    };
  });
}

/** @param {Board} board @returns {Items} */
function foldHandles(board) {
  const { drawing, view, step } = board;
  return drawing.folds.flatMap((fold, index) => {
    if (index < step) return [];
    const ends = [view.toPx(fold.start.point), view.toPx(fold.end.point)];
    const isSelected = board.isSelected("fold", fold.id);
    const label = say("handle.fold", {
      number: index + 1,
      name: translated(fold.name) || say("handle.no_name"),
      colour: say(`colour.${fold.kind}.small`),
    });
    const state = `is-${fold.kind}${isSelected ? " is-selected" : ""}${step > 0 && index > step ? " is-later" : ""}`;
    return [
      {
        key: `f:${fold.id}`,
        tag: "path",
        class: `fold-focus ${state}`,
        d: path(ends, false),
        ...focusable("fold", fold.id, label),
      },
      ...ends.map(([cx, cy], end) => ({
        key: `f:${fold.id}:${end}`,
        tag: "circle",
        class: `handle fold-end ${state}`,
        cx,
        cy,
        r: isSelected ? END_PX : 3,
      })),
    ];
  });
}

/**
 * The edges that are selected or end at a selected corner, with their lengths; middles by which they are bent.
 * @param {Board} board
 * @returns {Items}
 */
function edges(board) {
  if (!board.isSpread) return [];
  const { drawing, view } = board;
  return outlineEdges(drawing.outline).flatMap(([corner, next]) => {
    const isSelected = board.isSelected("edge", corner.id);
    const isNear = isSelected || board.hover?.edge === corner.id;
    const isMeasured = isSelected || [corner, next].some(({ id }) => board.isSelected("vertex", id));
    const [a, b] = [view.toPx(corner.point), view.toPx(next.point)];
    const points = edgePoints(corner, next);
    const line = points.map((point) => view.toPx(point));
    const isBendable = corner.curve || (isNear && distance(a, b) > ROOM_FOR_MIDDLE_PX);
    const handle = view.toPx(handleOf(corner, next));
    const off = minus(handle, between(a, b)); // the length is written beside the middle of a curve
    return [
      isSelected && { key: `e:${corner.id}`, tag: "path", class: "edge-selected", d: path(line, false) },
      isBendable && middle(corner.id, handle, Boolean(corner.curve)),
      isMeasured &&
        lengthLabel(`l:${corner.id}`, plus(a, off), plus(b, off), lengthOf(points), board.turnsLeft),
    ];
  });
}

/** @param {string} id @param {Point} at @param {boolean} isCurved @returns {Item} */
function middle(id, [cx, cy], isCurved) {
  return { key: `m:${id}`, tag: "circle", class: `handle middle${isCurved ? " is-curved" : ""}`, cx, cy, r: MIDDLE_PX };
}

/**
 * A length written beside an edge, on the outer side.
 * @param {string} key
 * @param {Point} a px
 * @param {Point} b px
 * @param {number} metres
 * @param {boolean} isLeft whether the outer side is on the left
 * @returns {Item}
 */
export function lengthLabel(key, a, b, metres, isLeft = true) {
  const outwards = times(left(direction(minus(b, a))), isLeft ? 1 : -1);
  const [x, y] = plus(between(a, b), times(outwards, LABEL_PX));
  const anchor = Math.abs(outwards[0]) < 0.4 ? "middle" : outwards[0] > 0 ? "start" : "end";
  return { key, tag: "text", class: "length", x, y: y + 4, "text-anchor": anchor, text: length(metres) };
}

/** @param {"vertex"|"fold"} kind @param {string} id @param {string} label */
function focusable(kind, id, label) {
  return { tabindex: 0, role: "button", "aria-label": label, "data-kind": kind, "data-id": id };
}
