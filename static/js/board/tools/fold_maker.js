/** Makes folds of strokes, one after the other: a next one may be drawn before the server has answered. */

import { say } from "../../language/say.js";
import { insertFold } from "../edits.js";
import { freshId } from "../ids.js";
import { DRAW_FOLD } from "../rules.js";
import { nameOf } from "../stroke.js";
import { beginsOnEdge } from "./fold_stroke.js";

/** @import { Crease } from "pleat" */
/** @import { Change } from "../../edit_queue.js" */
/** @import { Stroke } from "./fold_stroke.js" */

export class FoldMaker {
  /**
   * @param {import("../board.js").Board} board
   * @param {import("../crease.js").CreaseQuestion} question
   * @param {{named: (id: string) => void, after: (isFault: boolean) => void}} tell what a fold is called before it is
   *   made; that a stroke is a fold, or none
   */
  constructor(board, question, tell) {
    this.board = board;
    this.question = question;
    this.tell = tell;
    /** Settled when all strokes so far are folds. */
    this.finished = Promise.resolve();
    /** How many strokes are done and not yet folds. */
    this.unmade = 0;
  }

  /** @param {Stroke} stroke */
  make(stroke) {
    this.unmade += 1;
    this.finished = this.finished.then(() => this.complete(stroke)).catch((error) => this.fail(error));
  }

  /** A stroke was lost to a fault of the page; the next ones are none the worse. @param {unknown} error */
  fail(error) {
    this.unmade -= 1;
    this.tell.after(true);
    this.board.store.refuse(say("hint.fold_failed"));
    console.error(error);
  }

  /** Add the fold to those that are there by then. @param {Stroke} stroke */
  async complete(stroke) {
    const { board } = this;
    await board.store.settled();
    if (stroke.isEarly && stroke.isGrab) stroke.isGrab = !beginsOnEdge(stroke, board); // it was quicker than the server
    const answer = await this.question.answer(stroke);
    if (answer.ok) await this.add(answer.told);
    else board.store.refuse(answer.told.detail);
    this.unmade -= 1;
    this.tell.after(false);
    board.render();
  }

  /** @param {Crease} crease */
  async add({ start, end }) {
    const { board } = this;
    const index = board.step;
    const id = freshId("f", board.drawing.folds);
    const name = nameOf(start.point, end.point, board.drawing.folds);
    const fold = { id, name, kind: board.paint.kind, start, end };
    this.tell.named(id);
    board.paint.turnOver(false);
    /** @type {Change} */
    const insert = (drawing) => insertFold(drawing, Math.min(index, drawing.folds.length), fold);
    const state = await board.store.edit(DRAW_FOLD, insert);
    if (state) board.store.showStep(index + 1);
  }
}
