/** Fold lines, each with a mark for the way the cloth goes; what they would come to while they are drawn. */

import { foldStates } from "../dock/fold_states.js";
import { between, left, minus, plus, times, unit as direction } from "./geometry.js";
import { path } from "./sheet.js";

/** @import { FoldKind, Point } from "pleat" */
/** @import { Board } from "./board.js" */
/** @import { Items } from "./sheet.js" */

const MARK_PX = 7;
/** How far along the line the mark is: not in its middle, where other folds like to end. */
const MARK_AT = 0.42;

/** @param {Board} board @returns {Items} */
export function drawFolds(board) {
  const { drawing, view, step, isPlacing, tool, tools } = board;
  const isFaint = isPlacing || tool === tools.propose;
  const states = statesNow(board);
  return drawing.folds.flatMap((fold, index) => {
    if (index < step && !isPlacing) return [];
    /** @type {[Point, Point]} */
    const ends = [view.toPx(fold.start.point), view.toPx(fold.end.point)];
    const isSelected = board.isSelected("fold", fold.id);
    const isLater = (step > 0 && index > step) || states[index] === "done";
    const isNow = states[index] === "current";
    const state = `${isSelected ? " is-selected" : ""}${isNow ? " is-now" : ""}${isLater || isFaint ? " is-later" : ""}`;
    return foldItems({ key: fold.id, kind: fold.kind, ends, state, number: index + 1 });
  });
}

/** How far the folds are at the moment of the plan that is played or pointed at. @param {Board} board */
function statesNow({ store, drawing }) {
  const plan = store.plan?.plan;
  const isOfThis = plan?.dag.folds === drawing.folds.length;
  return plan && isOfThis ? foldStates(plan, store.hoverTime ?? store.playback?.t_s ?? 0) : [];
}

/** @param {{key: string, kind: FoldKind, ends: [Point, Point], state: string, number: number|null}} fold ends in px */
export function foldItems({ key, kind, ends, state, number }) {
  const [a, b] = ends;
  const along = direction(minus(b, a));
  const across = left(along); // y is down here: this points to the right of the line, where the cloth goes
  const middle = between(a, b, MARK_AT);
  const mark = [
    plus(middle, times(along, -MARK_PX * 0.8)),
    plus(middle, times(along, MARK_PX * 0.8)),
    plus(middle, times(across, MARK_PX * 1.5)),
  ];
  const beside = plus(between(a, b, 0.14), times(across, -12));
  return [
    { key: `${key}:halo`, tag: "path", class: `fold-halo${state}`, d: path(ends, false) },
    { key: `${key}:line`, tag: "path", class: `fold is-${kind}${state}`, d: path(ends, false) },
    { key: `${key}:mark`, tag: "path", class: `fold-mark is-${kind}${state}`, d: path(mark) },
    number !== null && {
      key: `${key}:number`,
      tag: "text",
      class: `fold-number is-${kind}${state}`,
      x: beside[0],
      y: beside[1] + 4,
      text: String(number),
    },
  ];
}

/** What a fold that is being drawn moves, and where that lands. @param {Board} board @returns {Items} */
export function drawGhost({ ghost, view }) {
  if (!ghost) return [];
  /** @param {Point[][]} all */
  const rings = (all) => all.map((ring) => path(ring.map((point) => view.toPx(point)))).join("");
  return [
    { key: "moving", tag: "path", class: "ghost-moving", d: rings(ghost.moving) },
    { key: "landed", tag: "path", class: "ghost-landed", d: rings(ghost.landed) },
    { key: "hatch", tag: "path", class: "ghost-hatch", d: rings(ghost.landed) },
  ];
}
