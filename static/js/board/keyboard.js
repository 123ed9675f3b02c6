/** Keys on the board. With a drawing tool the arrow keys lead a cross and Enter puts a point there. */

import { isViewOnly } from "../view_only.js";
import { plus, times } from "./geometry.js";

/** @import { Point } from "pleat" */
/** @import { Items } from "./sheet.js" */
/** @import { Selection } from "../store.js" */

const FINE_M = 0.001;
const STEP_M = 0.01;
const WIDE_M = 0.1;
/** @type {Record<string, Point>} */
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
const NUMBER = /^[0-9.]$/;
const DRAWING = new Set(["outline", "fold", "measure"]);

export class Keyboard {
  /** @param {import("./board.js").Board} board */
  constructor(board) {
    this.board = board;
    /** Where the cross is, garment frame (m). @type {Point|null} */
    this.cross = null;
    /** Whether the cross, and not the mouse, leads. */
    this.isOn = false;
    board.svg.addEventListener("keydown", (event) => this.key(event));
    board.svg.addEventListener("focusin", (event) => this.focused(event));
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    const { board } = this;
    if (event.key === "Tab" || ARROWS[event.key]) board.svg.classList.remove("is-pointed");
    if (event.ctrlKey || event.metaKey) return;
    if (!this.isOurs(event)) return;
    event.preventDefault();
    event.stopPropagation();
    board.render();
  }

  /** Whether a key is the board's; what it means is done. @param {KeyboardEvent} event */
  isOurs(event) {
    const { board } = this;
    const { tool } = board;
    if (event.key === "Escape") return board.escape();
    if (board.store.isLost || isViewOnly) return false;
    if (event.key === "Tab") return !event.shiftKey && this.toNumbers(event);
    if (tool.stretch && NUMBER.test(event.key)) {
      board.openTyped(event.key);
      return true;
    }
    if (tool.isBusy && event.key.toLowerCase() === "x") {
      board.paint.flip();
      return true;
    }
    if (DRAWING.has(tool.name) && ARROWS[event.key]) return this.lead(event);
    if (event.key === "Enter" && this.isOnItem(event)) return board.numbers.focus();
    return tool.key(event);
  }

  /** @param {KeyboardEvent} event */
  isOnItem(event) {
    return event.target !== this.board.svg && this.board.tool.name === "select";
  }

  /** Tab goes to the number that is being drawn, or to those of what is selected. @param {KeyboardEvent} event */
  toNumbers(event) {
    const { board } = this;
    if (board.tool.stretch) {
      board.openTyped("");
      return true;
    }
    return event.target === board.svg && board.store.selection !== null && board.numbers.focus();
  }

  /** @param {KeyboardEvent} event */
  lead(event) {
    const { board } = this;
    const step = event.altKey ? FINE_M : event.shiftKey ? WIDE_M : STEP_M;
    const from = this.cross ?? this.first();
    const [x, y] = plus(from, times(ARROWS[event.key], step));
    this.cross = [round(x), round(y)];
    this.begin(event);
    board.announce(board.whereText(this.cross));
    return true;
  }

  /** From now on the cross leads, from where it is or begins. @param {KeyboardEvent} event */
  begin(event) {
    this.isOn = true;
    this.cross ??= this.first();
    this.reveal(this.cross);
    this.board.tool.hover(this.pointer(event));
  }

  /** The middle of what is seen, on whole centimetres; for a fold the cloth's first corner. @returns {Point} */
  first() {
    const { view, rings, tool } = this.board;
    const corner = tool.name === "fold" ? rings[0]?.[0] : null;
    if (corner) return corner;
    const [x, y] = view.toM([view.width / 2, view.height / 2]);
    return [Math.round(x / STEP_M) * STEP_M, Math.round(y / STEP_M) * STEP_M];
  }

  /** Keep the cross on the board. @param {Point} cross */
  reveal(cross) {
    const { view } = this.board;
    const [x, y] = view.toPx(cross);
    const margin = 24;
    view.pan([
      Math.max(margin - x, 0) - Math.max(x - (view.width - margin), 0),
      Math.max(margin - y, 0) - Math.max(y - (view.height - margin), 0),
    ]);
  }

  /** The cross as a pointer. @param {KeyboardEvent} event @returns {import("./pointer.js").Pointer} */
  pointer(event) {
    const at = (this.cross ??= this.first());
    return {
      px: this.board.view.toPx(at),
      at,
      isTouch: false,
      isKeyboard: true,
      ctrl: false,
      shift: false,
      alt: event.altKey,
    };
  }

  /** How far an arrow key moves what is selected (m); null for other keys. @param {KeyboardEvent} event */
  nudge(event) {
    const way = ARROWS[event.key];
    return way && !event.altKey ? times(way, event.shiftKey ? STEP_M : FINE_M) : null;
  }

  /** A corner or fold that gets the focus is selected. @param {FocusEvent} event */
  focused(event) {
    const { board } = this;
    const target = /** @type {SVGElement} */ (event.target);
    if (event.relatedTarget instanceof Node && !board.root.contains(event.relatedTarget))
      board.svg.classList.toggle("is-pointed", !target.matches(":focus-visible"));
    const { kind, id } = target.dataset;
    if (kind && id) board.store.select({ kind: /** @type {Selection["kind"]} */ (kind), ids: [id] });
  }

  /** @returns {Items} */
  items() {
    if (!this.isOn || !this.cross || !DRAWING.has(this.board.tool.name)) return [];
    const [x, y] = this.board.view.toPx(this.cross);
    return [{ key: "cross", tag: "path", class: "cross", d: `M${x - 14} ${y}h10m8 0h10M${x} ${y - 14}v10m0 8v10` }];
  }
}

/** @param {number} metres */
const round = (metres) => Math.round(metres * 1e6) / 1e6;
