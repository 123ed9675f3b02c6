/** The field that opens beside the pointer when a number is typed while something is drawn: it beats every snap. */

import { field } from "../dom.js";
import { say } from "../language/say.js";
import { parsed, unit } from "./units.js";

export class TypedLength {
  /** @param {import("./board.js").Board} board */
  constructor(board) {
    this.board = board;
    this.input = field({ className: "field typed", ariaLabel: say("typed.length"), hidden: true });
    this.input.addEventListener("input", () => this.tell());
    this.input.addEventListener("keydown", (event) => this.key(event));
    board.root.append(this.input);
  }

  get isOpen() {
    return !this.input.hidden;
  }

  /** @param {string} text what has been typed already */
  open(text) {
    this.input.hidden = false;
    this.input.value = text;
    this.input.placeholder = unit.name;
    this.place();
    this.input.focus();
    this.tell();
  }

  /** Beside the middle of what is measured. */
  place() {
    const stretch = this.board.tool.stretch;
    if (!this.isOpen || !stretch) return;
    const [a, b] = stretch.map((point) => this.board.view.toPx(point));
    const { width, height, top } = this.board.place;
    this.input.style.left = `${Math.min(Math.max((a[0] + b[0]) / 2 + 12, 4), width - 104)}px`;
    this.input.style.top = `${top + Math.min(Math.max((a[1] + b[1]) / 2 + 12, 4), height - 40)}px`;
  }

  close() {
    if (!this.isOpen) return;
    this.input.hidden = true;
    this.board.tool.type(null);
    this.board.svg.focus({ preventScroll: true });
  }

  tell() {
    const metres = parsed(this.input.value);
    const isGood = metres !== null && metres > 0;
    this.input.setAttribute("aria-invalid", String(!isGood && this.input.value !== ""));
    this.board.tool.type(isGood ? metres : null);
    this.board.render();
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    event.stopPropagation();
    if (event.key === "Escape") this.close();
    if (event.key === "Tab") this.board.svg.focus({ preventScroll: true });
    if (event.key === "Tab" || event.key === "Enter") event.preventDefault();
    if (event.key !== "Enter" || this.input.getAttribute("aria-invalid") === "true") return;
    this.board.tool.finish();
    this.close();
    this.board.render();
  }
}
