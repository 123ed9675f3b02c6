/** What stands on a board with nothing on it. */

import { button, element } from "../dom.js";
import { say } from "../language/say.js";
import { isViewOnly } from "../view_only.js";

export class Blank {
  /** @param {import("./board.js").Board} board @param {{startNew: () => void, startImport: () => void}} verbs */
  constructor(board, { startNew, startImport }) {
    this.board = board;
    /** Whether the outline is drawn with the tool that came with the board: whoever takes one up has decided. */
    this.isAtOnce = false;
    this.root = element(
      "div",
      "blank for-editors",
      element("p", "", say("blank.begin")),
      element(
        "div",
        "blank-buttons",
        button("plain-button", startNew, say("blank.template")),
        button("plain-button", startImport, say("blank.file")),
      ),
    );
    this.root.hidden = true;
    board.root.append(this.root);
    board.store.addEventListener("gone", () => this.showGone());
    board.store.addEventListener("document", () => this.takeUp(), { once: true });
  }

  /** A board with nothing on it draws at once. */
  takeUp() {
    if (isViewOnly || this.board.drawing.outline.length || this.board.tool.name !== "select") return;
    this.board.choose("outline");
    this.isAtOnce = true;
    this.board.svg.blur(); // nobody has asked for the keyboard yet
  }

  /** There is no document at this address. */
  showGone() {
    const link = element("a", "main-button", say("blank.go_to_last"));
    link.setAttribute("href", "../");
    this.root.className = "blank is-gone";
    this.root.replaceChildren(
      element("p", "blank-title", say("blank.gone")),
      element("p", "", say("blank.gone_why")),
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
