/** How folds are drawn: which layers they take, which side moves; of the selected folds, or else of the next. */

import { inEnglish } from "../language/say.js";
import { flipFolds, mirrorFolds, paintFolds } from "./edits.js";

/** @import { FoldKind } from "pleat" */

export class FoldPaint {
  /** @param {import("./board.js").Board} board */
  constructor(board) {
    this.board = board;
    /** @type {FoldKind} of the next fold */
    this.kind = "blue";
    this.isFlipped = false;
    /** Whether cloth is grabbed also where a stroke would begin at its edge. */
    this.grabs = false;
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

  /** The selected folds; while folds are being drawn the one drawn last. */
  get meant() {
    const { tool } = this.board;
    const isJustDrawn = tool.name === "fold" && !tool.isBusy && this.board.fold(tool.last);
    return this.chosen.length || !isJustDrawn ? this.chosen : [tool.last];
  }

  /** @param {FoldKind} kind */
  put(kind) {
    const ids = this.chosen;
    this.kind = kind;
    const label = inEnglish(`step.make_${kind}`);
    if (ids.length) this.board.store.edit(label, (drawing) => paintFolds(drawing, ids, kind));
    else this.askAgain();
    this.board.render();
  }

  /** The other side moves: of the selected folds, the one being drawn, the one drawn last, or the next one. */
  flip() {
    const ids = this.meant;
    if (ids.length) this.board.store.edit(inEnglish("step.flip_fold"), (drawing) => flipFolds(drawing, ids));
    else this.turnOver(!this.isFlipped);
    this.board.render();
  }

  /** Folds are drawn by grabbing, or not any more; it begins the tool if that is another. */
  grab() {
    const { board } = this;
    this.grabs = board.tool.name !== "fold" || !this.grabs;
    if (board.tool.name !== "fold") board.choose("fold");
    board.render();
  }

  /** A twin for each fold that is meant, on the garment's other side. @returns {boolean} whether there was one */
  mirror() {
    const { board } = this;
    const ids = this.meant;
    if (!ids.length) return false;
    const isDrawing = board.tool.name === "fold";
    board.store
      .edit(inEnglish("step.mirror_fold"), (drawing) => mirrorFolds(drawing, ids))
      .then(() => {
        if (isDrawing) board.store.showStep(board.store.moments - 1);
      });
    return true;
  }

  /** @param {boolean} isFlipped */
  turnOver(isFlipped) {
    this.isFlipped = isFlipped;
    this.askAgain();
  }

  askAgain() {
    const { tool, svg } = this.board;
    if (!tool.isBusy) return;
    tool.ask();
    svg.focus({ preventScroll: true }); // the stroke goes on
  }
}
