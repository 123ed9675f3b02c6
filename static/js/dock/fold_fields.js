/** What can be changed of the fold that is selected: colour, grip radius, name, place in the order. */

import { parsed, problemOf } from "../board/units.js";
import { button, element, input } from "../dom.js";
import { KIND_NAMES } from "../fold_kinds.js";
import { say } from "../language/say.js";
import { iconButton, relabel } from "./buttons.js";
import { length } from "../messages/lengths.js";
import { movedBy } from "./words.js";

/** @import { Fold, FoldKind } from "pleat" */

/** Fingers that hold less hold nothing (m). */
const LEAST_GRIP_M = 0.001;

export class FoldFields {
  /** @param {import("./fold_row.js").Verbs} verbs @param {() => void} onRename */
  constructor(verbs, onRename) {
    this.verbs = verbs;
    this.colours = KIND_NAMES.map((kind) => this.colour(kind));
    this.radios = element("div", "segments", ...this.colours);
    this.radios.setAttribute("role", "radiogroup");
    this.radios.addEventListener("keydown", (event) => this.turn(event));
    this.radius = input("field fold-radius", { inputMode: "decimal" });
    this.radius.addEventListener("input", () => (this.isTyped = true));
    this.radius.addEventListener("change", () => this.grip());
    this.isTyped = false;
    /** The radius that the fold has, as it is written. */
    this.told = "";
    this.radius.addEventListener("keydown", (event) => event.stopPropagation());
    this.up = iconButton("up", "", () => verbs.onMove(-1));
    this.down = iconButton("down", "", () => verbs.onMove(1));
    this.pen = iconButton("pen", "", onRename);
    this.bin = iconButton("bin", "", verbs.onDelete);
    const grip = element("label", "fold-grip", element("span", "", say("grip.label")), this.radius);
    const tools = element("span", "fold-tools", this.pen, this.up, this.down, this.bin);
    this.root = element("div", "fold-fields", this.radios, grip, tools);
  }

  /**
   * @param {Fold} fold of the drawing
   * @param {{called: string, isFirst: boolean, isLast: boolean, garmentRadius: number}} now
   */
  show(fold, { called, isFirst, isLast, garmentRadius }) {
    for (const radio of this.colours) {
      const isOn = radio.dataset.kind === fold.kind;
      radio.setAttribute("aria-checked", String(isOn));
      radio.tabIndex = isOn ? 0 : -1;
    }
    this.radios.setAttribute("aria-label", say("fold.colour_of", { fold: called }));
    this.radius.placeholder = length(garmentRadius);
    this.told = fold.grip_radius_m === null ? "" : length(fold.grip_radius_m);
    if (!this.isTyped) this.radius.value = this.told;
    this.radius.setAttribute("aria-label", say("fold.radius_of", { fold: called }));
    this.radius.title = say("fold.radius_hint");
    relabel(this.pen, say("fold.rename", { fold: called }));
    relabel(this.up, say("fold.move_up", { fold: called }));
    relabel(this.down, say("fold.move_down", { fold: called }));
    relabel(this.bin, say("fold.delete", { fold: called }));
    this.up.disabled = isFirst;
    this.down.disabled = isLast;
  }

  /** @param {FoldKind} kind */
  colour(kind) {
    const radio = button("segment", () => this.verbs.onColour(kind), say(`colour.${kind}`));
    radio.dataset.kind = kind;
    radio.setAttribute("role", "radio");
    radio.title = movedBy(kind);
    return radio;
  }

  /** @param {KeyboardEvent} event the arrows choose, as among radio buttons */
  turn(event) {
    if (!event.key.startsWith("Arrow") || event.altKey) return;
    event.preventDefault();
    event.stopPropagation();
    const step = ["ArrowLeft", "ArrowUp"].includes(event.key) ? -1 : 1;
    const at = this.colours.findIndex((radio) => radio === document.activeElement);
    const other = this.colours.at((at + step) % this.colours.length);
    other?.focus();
    other?.click();
  }

  /** Take the radius that was typed; what is none is put back, and said. */
  grip() {
    const text = this.radius.value.trim();
    this.isTyped = false;
    const problem = text === "" ? "" : problemOf(text, LEAST_GRIP_M);
    if (!problem) this.verbs.onGrip(text === "" ? null : parsed(text));
    else this.verbs.onRefuse(problem);
    if (problem) this.radius.value = this.told;
  }
}
