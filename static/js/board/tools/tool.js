/** What a tool may be asked; by itself it does nothing. */

/** @import { Point } from "pleat" */
/** @import { Pointer } from "../pointer.js" */
/** @import { Items } from "../sheet.js" */

/** @typedef {"select"|"outline"|"fold"|"place"|"measure"|"photo"|"propose"} ToolName */

export class Tool {
  /** @param {import("../board.js").Board} board @param {ToolName} name @param {string} cursor */
  constructor(board, name, cursor) {
    this.board = board;
    this.name = name;
    this.cursor = cursor;
    /** The fold that was drawn last. */
    this.last = "";
  }

  /** One sentence on what to do. */
  get hint() {
    return "";
  }

  /** Whether something is begun that is not done. */
  get isBusy() {
    return false;
  }

  /** The way whose length is being drawn. @returns {[Point, Point]|null} */
  get stretch() {
    return null;
  }

  /** The tool has been chosen. */
  enter() {}

  /** Whether a press there is the tool's, where others wait for it too. @param {Pointer} _pointer */
  takes(_pointer) {
    return true;
  }

  /** The pointer is there. @param {Pointer} _pointer */
  hover(_pointer) {}

  /** The pointer has left the board. */
  leave() {}

  /** @param {Pointer} _pointer */
  press(_pointer) {}

  /** It has moved since it was pressed. @param {Pointer} _pointer */
  drag(_pointer) {}

  /** @param {Pointer} _pointer @param {boolean} _hasMoved since it was pressed */
  release(_pointer, _hasMoved) {}

  /** Pressed twice. @param {Pointer} _pointer */
  twice(_pointer) {}

  /** Drop what is begun. @returns {boolean} whether anything was */
  cancel() {
    return false;
  }

  /** Another tool is chosen, or two fingers pan: what is begun is dropped, unless it took more than this gesture. */
  interrupt() {
    this.cancel();
  }

  /** What Undo would take back of what is begun; empty for nothing. */
  get lastPart() {
    return "";
  }

  /** Take back the last part of what is begun. */
  takeBack() {
    this.cancel();
  }

  /** @param {KeyboardEvent} _event @returns {boolean} whether it was ours */
  key(_event) {
    return false;
  }

  /** A length while it is being typed. @param {number|null} _metres */
  type(_metres) {}

  /** The length that was typed holds. */
  finish() {}

  /** Ask the server again: how the fold is drawn has changed. */
  ask() {}

  /** @returns {Items} what it shows of what is begun */
  items() {
    return [];
  }
}
