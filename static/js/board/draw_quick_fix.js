/** A quick fix that is pointed at: the outline and the folds that would be others, and a cross on what would be gone. */

import { ringOf } from "./curves.js";
import { crossAt } from "./draw_findings.js";
import { foldItems } from "./draw_folds.js";
import { between, distance } from "./geometry.js";
import { path } from "./sheet.js";

/** @import { Corner, Drawing, Fold, Point } from "pleat" */
/** @import { Items } from "./sheet.js" */
/** @import { View } from "./view.js" */

const SAME_M = 1e-9;
const CROSS_PX = 9;

/** @param {import("./board.js").Board} board @returns {Items} */
export function drawQuickFix({ store, view, drawing }) {
  const wanted = store.preview?.drawing;
  if (!wanted) return [];
  /** @param {Corner} corner */
  const isCornerKept = (corner) => wanted.outline.some(({ id }) => id === corner.id);
  const goneCorners = drawing.outline.filter((corner) => !isCornerKept(corner)).map(({ point }) => point);
  const goneFolds = drawing.folds.filter(({ id }) => !wanted.folds.some((fold) => fold.id === id));
  const gone = [...goneCorners, ...goneFolds.map(({ start, end }) => between(start.point, end.point))];
  return [
    ...outline(view, drawing, wanted),
    ...folds(view, drawing, wanted),
    ...gone.map((at, n) => crossAt(`quick-fix:gone${n}`, view.toPx(at), CROSS_PX)),
  ];
}

/** @param {View} view @param {Drawing} drawing @param {Drawing} wanted @returns {Items} */
function outline(view, drawing, wanted) {
  const [before, after] = [drawing, wanted].map(ringOf);
  if (before.length === after.length && before.every((point, index) => isSame(point, after[index]))) return [];
  return [{ key: "quick-fix:outline", tag: "path", class: "preview", d: path(after.map((point) => view.toPx(point))) }];
}

/** @param {View} view @param {Drawing} drawing @param {Drawing} wanted @returns {Items} */
function folds(view, drawing, wanted) {
  const before = new Map(drawing.folds.map((fold) => [fold.id, fold]));
  const changed = wanted.folds.filter((fold) => !isSameFold(fold, before.get(fold.id)));
  return changed.flatMap(({ id, kind, start, end }) =>
    foldItems({
      key: `quick-fix:${id}`,
      kind,
      ends: [view.toPx(start.point), view.toPx(end.point)],
      state: " is-preview",
      number: null,
    }),
  );
}

/** @param {Point} a @param {Point} b */
const isSame = (a, b) => distance(a, b) <= SAME_M;

/** @param {Fold} fold @param {Fold|undefined} other */
const isSameFold = (fold, other) =>
  other?.kind === fold.kind && isSame(fold.start.point, other.start.point) && isSame(fold.end.point, other.end.point);
