/** The strip over the board: which moment of the folds is shown; how folds are drawn; units; fit. */

import { button, element } from "../dom.js";
import { icon } from "../icons.js";
import { unit } from "./units.js";

/** @import { FoldKind } from "pleat" */

export class Strip {
  /** @param {import("./board.js").Board} board */
  constructor(board) {
    this.board = board;
    const { store } = board;
    this.back = iconButton("back", "Step before", () => store.showStep(store.step - 1));
    this.next = iconButton("next", "Step after", () => store.showStep(store.step + 1));
    this.moment = element("span", "strip-moment");
    this.moment.setAttribute("aria-live", "polite");
    this.blue = paint("blue", "Blue: all layers", "Blue", () => board.paint.put("blue"));
    this.red = paint("red", "Red: last flap", "Red", () => board.paint.put("red"));
    this.flip = button("strip-button", () => board.paint.flip(), icon("flip"), element("span", "word", "Flip"));
    this.flip.setAttribute("aria-label", "Flip");
    this.flip.title = "Flip: the other side moves (X)";
    this.grab = button("strip-button", () => board.paint.grab(), icon("grab"), element("span", "word", "Grab"));
    this.grab.setAttribute("aria-label", "Grab");
    this.grab.title = "Grab the cloth, also at its edges and corners, and drop it where it shall land (G)";
    this.unit = button("strip-button", () => this.swapUnit(), "");
    this.fit = iconButton("fit", "Fit", () => board.framing.fit());
    this.fit.title = "Show the whole cloth (0)";
    board.root.append(
      element(
        "div",
        "strip",
        group("Moment", this.back, this.moment, this.next),
        group("Fold", this.blue, this.red, this.flip, this.grab),
        group("View", this.unit, this.fit),
      ),
    );
  }

  draw() {
    const { board } = this;
    const { store } = board;
    const last = store.moments - 1;
    this.back.disabled = board.step === 0;
    this.next.disabled = board.isPlacing || store.step >= last;
    const done = board.drawing.folds[board.step - 1];
    const after = `After ${board.step}${done?.name ? `: ${done.name}` : ""}`;
    this.moment.textContent = board.isPlacing ? "On the table" : board.isSpread ? "Spread out" : after;
    this.moment.title = board.isPlacing ? "" : `Moment ${store.step} of ${last}`;
    const kind = board.paint.shown;
    this.blue.setAttribute("aria-pressed", String(kind === "blue"));
    this.red.setAttribute("aria-pressed", String(kind === "red"));
    this.flip.setAttribute("aria-pressed", String(board.paint.isFlipped));
    this.grab.setAttribute("aria-pressed", String(board.paint.grabs && board.tool.name === "fold"));
    this.unit.textContent = unit.name;
    this.unit.setAttribute("aria-label", `Unit: ${unit.name}`);
    this.unit.title = "Centimetres or inches";
  }

  swapUnit() {
    unit.name = unit.name === "cm" ? "in" : "cm";
    this.board.render();
  }
}

/** @param {string} name @param {...Node} parts */
function group(name, ...parts) {
  const made = element("div", "strip-group", ...parts);
  made.setAttribute("role", "group");
  made.setAttribute("aria-label", name);
  return made;
}

/** @param {Parameters<typeof icon>[0]} name @param {string} label @param {() => void} onClick */
function iconButton(name, label, onClick) {
  const made = button("icon-button is-small", onClick, icon(name));
  made.setAttribute("aria-label", label);
  made.title = label;
  return made;
}

/** @param {FoldKind} kind @param {string} label @param {string} word @param {() => void} onClick */
function paint(kind, label, word, onClick) {
  const made = button(
    `strip-button paint is-${kind}`,
    onClick,
    element("span", "swatch"),
    element("span", "word", word),
  );
  made.setAttribute("aria-label", label);
  made.title = `${label} (${kind[0].toUpperCase()})`;
  return made;
}
