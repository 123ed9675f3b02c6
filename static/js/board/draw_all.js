/** Everything on the board, from the table up to the cursor. */

import { say } from "../language/say.js";
import { offlineHint } from "../offline.js";
import { drawCloth } from "./draw_cloth.js";
import { drawChecks, drawProblems } from "./draw_findings.js";
import { drawFolds, drawGhost } from "./draw_folds.js";
import { drawGrid } from "./draw_grid.js";
import { drawHandles } from "./draw_handles.js";
import { drawAxis, drawCursor, drawPreview, drawQuickFix } from "./draw_marks.js";
import { drawHolds } from "./draw_holds.js";
import { drawOverhang } from "./draw_overhang.js";
import { drawReason } from "./draw_reason.js";
import { drawRobot } from "./draw_robot.js";
import { drawTable, drawTableEdge } from "./draw_table.js";
import { uncovered, wordsApart } from "./words_apart.js";

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
  const { outline, propose } = board.tools;
  view.lay(board.isPlacing ? board.drawing.placement : null);
  sheets.photo.draw(board.isPlacing ? [] : board.photo.items(view));
  sheets.table.draw(board.isPlacing ? drawTable(board) : drawTableEdge(board, "table is-faint"));
  sheets.under.draw(board.overlays.under());
  sheets.cloth.draw(drawCloth(board));
  sheets.over.draw(board.overlays.over());
  sheets.ghost.draw(drawGhost(board));
  sheets.folds.draw(board.isPlaying || board.previewed ? [] : drawFolds(board));
  const found = [
    ...drawRobot(board),
    ...drawTableEdge(board, "table-line"),
    ...drawChecks(board),
    ...drawProblems(board),
    ...drawOverhang(board),
    ...drawReason(board),
    ...drawHolds(board),
  ];
  const findings = wordsApart(found, view.height);
  const inHand = [...tool.items(), ...(tool === outline ? [] : outline.items())];
  sheets.grid.draw(uncovered(drawGrid(board), [...findings, ...inHand]));
  sheets.findings.draw(findings);
  sheets.preview.draw([...drawAxis(board), ...drawPreview(board), ...drawQuickFix(board)]);
  sheets.handles.draw(board.isPlaying || tool === propose ? [] : drawHandles(board));
  sheets.tool.draw(inHand);
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
  if (board.store.isLost) board.hintLine.show(offlineHint(board.store), true);
  else board.hintLine.show(hint);
  board.store.setBegun(tool.lastPart);
  board.strip.draw();
  board.rail?.draw();
  board.blank?.draw();
  board.proposing?.draw();
  board.callout.draw();
  board.numbers.draw();
  board.legend.draw();
  board.typed.place();
}
