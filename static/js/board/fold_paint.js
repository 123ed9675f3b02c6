/** How folds are drawn: which layers they take, which side moves; of the selected folds, or else of the next. */

import { flipFolds, paintFolds } from "./edits.js";

export class FoldPaint {
  /** @param {import("./board.js").Board} board */
  constructor(board) {
    this.board = board;
    /** @type {"blue"|"red"} of the next fold */
    this.kind = "blue";
    this.isFlipped = false;
  }

  /** The kind that the buttons show. */
  get shown() {
    const [id] = this.chosen;
    return (id && this.board.fold(id)?.kind) || this.kind;
  }

  get chosen() {
    const { selection } = this.board.store;
    return selection?.kind === "fold" ? selection.ids : [];
  }

  /** @param {"blue"|"red"} kind */
  put(kind) {
    const ids = this.chosen;
    this.kind = kind;
    const label = kind === "red" ? "Make fold red" : "Make fold blue";
    if (ids.length) this.board.store.edit(label, (drawing) => paintFolds(drawing, ids, kind));
    else this.askAgain();
    this.board.render();
  }

  /** The other side moves: of the selected folds, the one being drawn, the one drawn last, or the next one. */
  flip() {
    const { tool, store } = this.board;
    const last = tool.name === "fold" && !tool.isBusy && this.board.fold(tool.last) ? [tool.last] : [];
    const ids = this.chosen.length ? this.chosen : last;
    if (ids.length) store.edit("Flip fold", (drawing) => flipFolds(drawing, ids));
    else this.turnOver(!this.isFlipped);
    this.board.render();
  }

  /** @param {boolean} isFlipped */
  turnOver(isFlipped) {
    this.isFlipped = isFlipped;
    this.askAgain();
  }

  askAgain() {
    if (this.board.tool.isBusy) this.board.tool.ask();
  }
}
