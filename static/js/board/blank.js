/** What stands on a board with nothing on it. */

import { button, element } from "../dom.js";

/** Tools that need no cloth to begin with. */
const DRAWING = new Set(["outline", "photo", "measure"]);

export class Blank {
  /** @param {import("./board.js").Board} board @param {{startNew: () => void, startImport: () => void}} verbs */
  constructor(board, { startNew, startImport }) {
    this.board = board;
    this.root = element(
      "div",
      "blank",
      element("p", "blank-title", "Nothing is drawn yet"),
      element("p", "", "Click corner after corner, or begin with a garment that is nearly right."),
      element(
        "div",
        "blank-buttons",
        button("main-button", () => board.choose("outline"), "Draw an outline"),
        button("plain-button", startNew, "From a template"),
        button("plain-button", startImport, "From a file"),
      ),
    );
    this.root.hidden = true;
    board.root.append(this.root);
    board.store.addEventListener("gone", () => this.showGone());
  }

  /** There is no document at this address. */
  showGone() {
    const link = element("a", "main-button", "Go to the last one");
    link.setAttribute("href", "../");
    this.root.replaceChildren(
      element("p", "blank-title", "Nothing is kept under this address"),
      element("p", "", "The document was removed, or the address is mistyped."),
      element("div", "blank-buttons", link),
    );
    this.root.hidden = false;
  }

  draw() {
    const { drawing, tool, tools } = this.board;
    this.root.hidden = drawing.outline.length > 0 || DRAWING.has(tool.name) || tools.outline.isBusy;
  }
}
