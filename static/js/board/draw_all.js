/** Everything on the board, from the table up to the cursor. */

import { say } from "../language/say.js";
import { offlineHint } from "../offline.js";
import { present } from "../present.js";
import { drawCloth } from "./draw_cloth.js";
import { drawChecks, drawProblems } from "./draw_findings.js";
import { drawFolds, drawGhost } from "./draw_folds.js";
import { drawGrid } from "./draw_grid.js";
import { drawHandles } from "./draw_handles.js";
import { drawHolds } from "./draw_holds.js";
import { drawAxis, drawCursor, drawPreview } from "./draw_marks.js";
import { drawOverhang } from "./draw_overhang.js";
import { drawQuickFix } from "./draw_marks.js";
import { drawReason } from "./draw_reason.js";
import { drawRobot } from "./draw_robot.js";
import { drawTable, drawTableEdge } from "./draw_table.js";

/** @import { Item, Items } from "./sheet.js" */

/** The layers, the lowest first. */
export const LAYERS = /** @type {const} */ ([
  "grid",
  "photo",
  "table",
  "under",
  "cloth",
  "over",
  "ghost",
  "folds",
  "findings",
  "preview",
  "handles",
  "tool",
  "cursor",
]);

/** @typedef {typeof LAYERS[number]} LayerName */

const UNCLOSED = say("hint.unclosed");

/** @param {import("./board.js").Board} board */
export function drawAll(board) {
  if (!board.state) return;
  const { sheets, view, tool, svg } = board;
  const { outline } = board.tools;
  view.lay(board.isPlacing ? board.drawing.placement : null);
  sheets.grid.draw(drawGrid(board));
  sheets.photo.draw(board.isPlacing ? [] : board.photo.items(view));
  sheets.table.draw(board.isPlacing ? drawTable(board) : drawTableEdge(board, "table is-faint"));
  sheets.under.draw(board.overlays.under());
  sheets.cloth.draw(drawCloth(board));
  sheets.over.draw(board.overlays.over());
  sheets.ghost.draw(drawGhost(board));
  sheets.folds.draw(board.isPlaying ? [] : drawFolds(board));
  const findings = [
    ...drawRobot(board),
    ...drawTableEdge(board, "table-line"),
    ...drawChecks(board),
    ...drawProblems(board),
    ...drawOverhang(board),
    ...drawReason(board),
    ...drawHolds(board),
  ];
  sheets.findings.draw(wordsApart(findings, view.height));
  sheets.preview.draw([...drawAxis(board), ...drawPreview(board), ...drawQuickFix(board)]);
  sheets.handles.draw(board.isPlaying ? [] : drawHandles(board));
  sheets.tool.draw([...tool.items(), ...(tool === outline ? [] : outline.items())]);
  sheets.cursor.draw([...drawCursor(board), ...board.keyboard.items()]);
  const [x, y] = view.toPx([0, 0]);
  svg.dataset.originPx = `${x},${y}`;
  svg.dataset.pxPerM = String(view.scale);
  svg.dataset.version = String(board.state.version);
  svg.setAttribute("aria-busy", "false"); // there is something to work on
  svg.style.cursor = tool.cursor;
  svg.classList.toggle("shows-places", board.store.overlays.has("places"));
  svg.classList.toggle("is-sketching", tool.name === "outline" && tool.isBusy);
  const hint = tool !== outline && outline.isBusy ? UNCLOSED : tool.hint;
  board.hintLine.textContent = board.store.isLost ? offlineHint(board.store) : hint;
  board.store.setBegun(tool.lastPart);
  board.strip.draw();
  board.rail?.draw();
  board.blank?.draw();
  board.callout.draw();
  board.numbers.draw();
  board.legend.draw();
  board.typed.place();
}

/** Words by their class, the most important first; those stay where they are as far as they can. */
const ORDER = ["reason-arm", "reason-text", "drag-text", "beyond-text", "robot-name"];
/** How wide a letter is at most on average, and how high a line (px). */
const LETTER_PX = 6.5;
const LINE_PX = 15;
/** How much of the board's foot other words have (px). */
const FOOT_PX = 36;

/** @typedef {{x0: number, x1: number, y: number}} Place */

/**
 * Words that findings write, moved up or down so that none is written over another.
 * @param {Items} items
 * @param {number} height of the board (px)
 * @returns {Items}
 */
function wordsApart(items, height) {
  /** @type {Map<Item, number>} */
  const moved = new Map();
  /** @type {Place[]} */
  const taken = [];
  const words = present(items).filter(({ tag, text }) => tag === "text" && text);
  for (const name of ORDER)
    for (const item of words.filter((one) => one.class === name)) {
      const wanted = placeOf(item);
      const place = free(wanted, taken, height, name !== "reason-arm");
      taken.push(place);
      if (place.y !== wanted.y) moved.set(item, place.y);
    }
  return items.map((item) => (item && moved.has(item) ? { ...item, y: moved.get(item) } : item));
}

/** @param {Item} item @returns {Place} */
function placeOf({ text = "", x, y, class: name, "text-anchor": anchor }) {
  const wide = text.length * LETTER_PX;
  const isMiddle = anchor === "middle" || name === "beyond-text" || name === "reason-arm";
  const x0 = Number(x) - (isMiddle ? wide / 2 : anchor === "end" ? wide : 0);
  return { x0, x1: x0 + wide, y: Number(y) };
}

/**
 * The nearest place above or below that is on the board and free.
 * @param {Place} wanted
 * @param {Place[]} taken
 * @param {number} height
 * @param {boolean} isMovable whether it may leave the board's foot to the hint that is written there
 * @returns {Place}
 */
function free(wanted, taken, height, isMovable) {
  const foot = height - FOOT_PX;
  const y0 = isMovable && wanted.y > foot && wanted.y < height && foot > LINE_PX ? foot : wanted.y;
  const possible = [y0, ...taken.flatMap(({ y }) => [y + LINE_PX, y - LINE_PX])]
    .filter((y) => y === y0 || (y > LINE_PX && y <= foot))
    .map((y) => ({ ...wanted, y }))
    .filter((place) => taken.every((other) => !isOver(place, other)));
  const away = (/** @type {Place} */ { y }) => Math.abs(y - wanted.y);
  return possible.reduce((best, place) => (away(place) < away(best) ? place : best), possible[0] ?? wanted);
}

/** @param {Place} one @param {Place} other */
const isOver = (one, other) => Math.abs(one.y - other.y) < LINE_PX && one.x0 < other.x1 && other.x0 < one.x1;
