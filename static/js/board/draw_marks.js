/** Marks that come and go: the snap in force by its name, the garment's axis, and what a suggestion would change. */

import { ringOf } from "./curves.js";
import { dimension } from "./draw_dimension.js";
import { crossAt } from "./draw_findings.js";
import { foldItems } from "./draw_folds.js";
import { middleOf } from "./edits.js";
import { between, distance, dot, minus, plus, times, toInner, toOuter, unit } from "./geometry.js";
import { axisOfGarment } from "./mirror.js";
import { path } from "./sheet.js";
import { length } from "./units.js";

/** @import { Items } from "./sheet.js" */
/** @import { View } from "./view.js" */
/** @import { Corner, Drawing, Fold, Point } from "pleat" */

/** @param {import("./board.js").Board} board */
export function drawCursor({ snapped, view, said }) {
  if (!snapped) return [];
  const [x, y] = view.toPx(snapped.where ?? snapped.at);
  const text = said || snapped.name;
  if (!text) return [];
  const lines = wrapped(text, LINE_LETTERS);
  const wide = Math.max(...lines.map((line) => line.length)) * LETTER_PX;
  const isRight = x > view.width - 120;
  const start = isRight ? x - ASIDE_PX - wide : x + ASIDE_PX;
  const left = Math.max(Math.min(start, view.width - wide - 4), 4);
  const top = y - ASIDE_PX - LINE_PX * (lines.length - 1);
  const first = top < LINE_PX ? y + LINE_PX + 8 : top;
  return [
    snapped.key !== "" && { key: "snap", tag: "rect", class: "snap-mark", x: x - 5, y: y - 5, width: 10, height: 10 },
    ...lines.map((line, n) => ({
      key: `name${n}`,
      tag: "text",
      class: said ? "snap-name is-said" : "snap-name",
      x: isRight ? left + wide : left,
      y: first + n * LINE_PX,
      "text-anchor": isRight ? "end" : "start",
      text: line,
    })),
  ];
}

/** Words in lines of at most so many letters, unless a word is longer. @param {string} text @param {number} most */
function wrapped(text, most) {
  return text.split(" ").reduce((lines, word) => {
    const longer = `${lines.at(-1) ?? ""} ${word}`.trim();
    return longer.length <= most || !lines.length ? [...lines.slice(0, -1), longer] : [...lines, word];
  }, /** @type {string[]} */ ([]));
}

/** Words at the cursor: how far from it, how wide a letter is at most on average, how high a line (px), how long. */
const ASIDE_PX = 12;
const LETTER_PX = 7;
const LINE_PX = 14;
const LINE_LETTERS = 44;
/** How far the axis is drawn beyond the garment (px). */
const BEYOND_PX = 28;

/** The axis over which Mirror takes things, while it is at hand. @param {import("./board.js").Board} board */
export function drawAxis({ isAxisShown, drawing, view }) {
  if (!isAxisShown || drawing.outline.length < 3) return [];
  const [start, end] = axisOfGarment(drawing);
  const way = unit(minus(end, start));
  const along = ringOf(drawing).map((point) => dot(minus(point, start), way));
  const beyond = BEYOND_PX / view.scale;
  const ends = [Math.min(...along) - beyond, Math.max(...along) + beyond];
  const line = ends.map((far) => view.toPx(plus(start, times(way, far))));
  return [{ key: "axis", tag: "path", class: "mirror-axis", d: path(line, false) }];
}

/**
 * A suggestion that is pointed at: where the cloth would lie, how the folds would run.
 * @param {import("./board.js").Board} board
 */
export function drawPreview({ store, view, drawing }) {
  const { placement, garment } = store.preview ?? {};
  /** @type {Items} */
  const items = [];
  /** @param {Point} point of the garment that would lie elsewhere */
  const placed = (point) => (placement ? toInner(drawing.placement, toOuter(placement, point)) : point);
  if (placement) {
    const ring = (garment?.outline ?? ringOf(drawing)).map((point) => view.toPx(placed(point)));
    items.push({ key: "placed", tag: "path", class: "preview", d: path(ring) });
    const middle = middleOf(drawing);
    const moved = () => dimension("moved", view.toPx(middle), view.toPx(placed(middle)), length(distance(middle, placed(middle))));
    if (!garment) items.push(...moved()); // of a smaller garment every point moves by another length
  }
  for (const [index, fold] of (garment?.folds ?? []).entries()) {
    items.push(
      ...foldItems({
        key: `p${index}`,
        kind: fold.kind,
        ends: [view.toPx(placed(fold.start)), view.toPx(placed(fold.end))],
        state: " is-preview",
        number: null,
      }),
    );
  }
  return items;
}

const SAME_M = 1e-9;
const CROSS_PX = 9;

/**
 * A quick fix that is pointed at: the outline and the folds that would be others, and a cross on what would be gone.
 * @param {import("./board.js").Board} board
 * @returns {Items}
 */
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
