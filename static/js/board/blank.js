/** What stands on a board with nothing on it. */

import { button, element } from "../dom.js";

export class Blank {
  /** @param {import("./board.js").Board} board @param {{startNew: () => void, startImport: () => void}} verbs */
  constructor(board, { startNew, startImport }) {
    this.board = board;
    /** Whether the outline is drawn with the tool that came with the board: whoever takes one up has decided. */
    this.isAtOnce = false;
    this.root = element(
      "div",
      "blank",
      element("p", "", "Draw, or begin with a garment that is nearly right:"),
      element(
        "div",
        "blank-buttons",
        button("plain-button", startNew, "From a template"),
        button("plain-button", startImport, "From a file"),
      ),
    );
    this.root.hidden = true;
    board.root.append(this.root);
    board.store.addEventListener("gone", () => this.showGone());
    board.store.addEventListener("document", () => this.takeUp(), { once: true });
  }

  /** A board with nothing on it draws at once. */
  takeUp() {
    if (this.board.drawing.outline.length || this.board.tool.name !== "select") return;
    this.board.choose("outline");
    this.isAtOnce = true;
    this.board.svg.blur(); // nobody has asked for the keyboard yet
  }

  /** There is no document at this address. */
  showGone() {
    const link = element("a", "main-button", "Go to the last one");
    link.setAttribute("href", "../");
    this.root.classList.add("is-gone");
    this.root.replaceChildren(
      element("p", "blank-title", "Nothing is kept under this address"),
      element("p", "", "The document was removed, or the address is mistyped."),
      element("div", "blank-buttons", link),
    );
    this.root.hidden = false;
  }

  draw() {
    const { drawing, tool, tools } = this.board;
    const isDrawn = drawing.outline.length > 0 || tools.outline.isBusy;
    this.root.hidden = isDrawn || !(tool.name === "select" || this.isAtOnce);
  }
}
