/**
 * One drag: shown at once, sent as previews while it lasts, one step of the history when it ends, none if dropped.
 */

/** @import { Change } from "../edit_queue.js" */

const EVERY_MS = 80;
let count = 0;

export class Gesture {
  /** @param {import("./board.js").Board} board @param {string} label the step's name */
  constructor(board, label) {
    this.board = board;
    this.label = label;
    this.key = `drag-${Date.now().toString(36)}-${(count += 1)}`;
    /** @type {Change|null} */
    this.change = null;
    /** @type {Change|null} the one that was sent last */
    this.sent = null;
    this.isOver = false;
    /** @type {number|undefined} */
    this.timer = undefined;
  }

  /** @param {Change} change may be made again and again: it says where things shall be, not by how much */
  show(change) {
    this.change = change;
    this.board.showDraft(change);
    if (this.timer !== undefined) return;
    this.send(change);
    this.timer = setTimeout(() => this.next(), EVERY_MS);
  }

  next() {
    this.timer = undefined;
    if (!this.isOver && this.change && this.change !== this.sent) this.show(this.change);
  }

  /** @param {Change} change */
  send(change) {
    this.sent = change;
    this.board.store.edit(this.label, change, { phase: "preview", gesture: this.key });
  }

  async commit() {
    if (this.isOver) return;
    this.end();
    if (this.change) await this.board.store.edit(this.label, this.change, { gesture: this.key });
    this.board.dropDraft(this.change);
  }

  async cancel() {
    if (this.isOver) return;
    this.end();
    this.board.dropDraft(this.change);
    if (this.change) await this.board.store.cancel(this.key);
  }

  end() {
    this.isOver = true;
    clearTimeout(this.timer);
  }
}
