/** The first problem in words, beside the place where it is. */

import { foldName } from "../dock/step_kinds.js";
import { element } from "../dom.js";
import { inWords } from "../messages/in_words.js";

const AWAY_PX = 14;

export class Callout {
  /** @param {import("./board.js").Board} board */
  constructor(board) {
    this.board = board;
    this.root = element("p", "callout");
    this.root.hidden = true;
    board.root.append(this.root);
  }

  draw() {
    const { board } = this;
    const isShown = !board.draft && !board.tool.isBusy && board.drawing.outline.length > 0;
    const problem = isShown ? board.state?.problems.find(({ points }) => points.length) : undefined;
    this.root.hidden = !problem;
    if (!problem) return;
    const name = problem.fold === null ? "" : foldName(board.drawing.folds[problem.fold], problem.fold);
    const words = inWords(problem, board.drawing.folds);
    const text = name ? `${name}: ${words}` : words;
    this.root.textContent = text[0].toUpperCase() + text.slice(1);
    const [x, y] = board.view.toPx(problem.points[0]);
    const { width, height, top } = board.place;
    const { offsetWidth: wide, offsetHeight: tall } = this.root;
    const above = y - AWAY_PX - tall > 6 ? y - AWAY_PX - tall : y + AWAY_PX; // numbers stand below
    this.root.style.left = `${Math.min(Math.max(x - wide / 2, 6), Math.max(width - wide - 6, 6))}px`;
    this.root.style.top = `${top + Math.min(Math.max(above, 6), height - tall - 6)}px`;
  }
}
