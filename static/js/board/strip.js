/** The strip over the board: which moment of the folds is shown; how folds are drawn; units; fit. */

import { button, element, group } from "../dom.js";
import { FOLD_KINDS, KIND_NAMES } from "../fold_kinds.js";
import { icon } from "../icons.js";
import { say, translated } from "../language/say.js";
import { unit, UNITS } from "./units.js";

/** @import { FoldKind } from "pleat" */

export class Strip {
  /** @param {import("./board.js").Board} board */
  constructor(board) {
    this.board = board;
    const { store } = board;
    this.back = iconButton("back", say("strip.step_before"), () => store.showStep(store.step - 1));
    this.next = iconButton("next", say("strip.step_after"), () => store.showStep(store.step + 1));
    this.moment = element("span", "strip-moment");
    this.moment.setAttribute("aria-live", "polite");
    this.paints = KIND_NAMES.map((kind) => ({ kind, made: paint(kind, () => board.paint.put(kind)) }));
    this.flip = button(
      "strip-button",
      () => board.paint.flip(),
      icon("flip"),
      element("span", "word", say("strip.flip")),
    );
    this.flip.setAttribute("aria-label", say("strip.flip"));
    this.flip.title = say("strip.flip_hint");
    this.grab = button(
      "strip-button",
      () => board.paint.grab(),
      icon("grab"),
      element("span", "word", say("strip.grab")),
    );
    this.grab.setAttribute("aria-label", say("strip.grab"));
    this.grab.title = say("strip.grab_hint");
    this.unit = button("strip-button", () => this.swapUnit(), "");
    this.fit = iconButton("fit", say("strip.fit"), () => board.framing.fit());
    this.fit.title = say("strip.fit_hint");
    const paints = partOf(say("strip.fold"), ...this.paints.map(({ made }) => made), this.flip, this.grab);
    paints.classList.add("for-editors");
    board.root.append(
      element(
        "div",
        "strip",
        partOf(say("strip.moment"), this.back, this.moment, this.next),
        paints,
        partOf(say("strip.view"), this.unit, this.fit),
      ),
    );
  }

  draw() {
    const { board } = this;
    const { store } = board;
    const last = store.moments - 1;
    this.back.disabled = board.step === 0;
    this.next.disabled = board.isPlacing || store.step >= last;
    const steps = store.plan?.plan?.primitives.length ?? 0;
    const current = board.pictures?.current ?? 0;
    const isOver = board.isStopped && current >= steps;
    const step = isOver ? board.drawing.folds.length : board.step;
    const done = board.drawing.folds[step - 1];
    const told = { step, name: translated(done?.name ?? "") };
    const after = say(told.name ? "strip.after_fold" : "strip.after", told);
    const isInStep = (board.isPlaying || board.isStopped) && !isOver;
    this.moment.textContent = board.isPlacing
      ? say("strip.on_table")
      : isInStep
        ? say("strip.in_step", { step: Math.min(current + 1, steps), last: steps })
        : board.isSpread && !isOver
          ? say("strip.spread_out")
          : after;
    this.moment.title = board.isPlacing ? "" : say("strip.moment_of", { step: store.step, last });
    for (const { kind, made } of this.paints) made.setAttribute("aria-pressed", String(kind === board.paint.shown));
    this.flip.setAttribute("aria-pressed", String(board.paint.isFlipped));
    this.grab.setAttribute("aria-pressed", String(board.paint.grabs && board.tool.name === "fold"));
    this.unit.textContent = unit.name;
    this.unit.setAttribute("aria-label", say("strip.unit", { unit: unit.name }));
    this.unit.title = say("strip.unit_hint");
  }

  swapUnit() {
    unit.name = UNITS[(UNITS.indexOf(unit.name) + 1) % UNITS.length];
    this.board.render();
  }
}

/** @param {string} name @param {...Node} parts */
const partOf = (name, ...parts) => group(element("div", "strip-group", ...parts), name);

/** @param {Parameters<typeof icon>[0]} name @param {string} label @param {() => void} onClick */
function iconButton(name, label, onClick) {
  const made = button("icon-button is-small", onClick, icon(name));
  made.setAttribute("aria-label", label);
  made.title = label;
  return made;
}

/** @param {FoldKind} kind @param {() => void} onClick */
function paint(kind, onClick) {
  const label = say(`colour.${kind}.moves`);
  const made = button(
    `strip-button paint is-${kind}`,
    onClick,
    element("span", "swatch"),
    element("span", "word", say(`colour.${kind}`)),
  );
  made.setAttribute("aria-label", label);
  made.title = `${label} (${FOLD_KINDS[kind].key.toUpperCase()})`;
  return made;
}
