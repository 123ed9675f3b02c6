/** One fold in the list `Folds`: how far it is, its name, what it waits for; while selected, what can be changed. */

import { assumptionChip } from "../assumptions.js";
import { button, element, input } from "../dom.js";
import { smallIcon } from "../icons.js";
import { say } from "../language/say.js";
import { length, listed } from "../messages/lengths.js";
import { isViewOnly } from "../view_only.js";
import { iconButton, relabel } from "./buttons.js";
import { FoldFields } from "./fold_fields.js";
import { STATE_WORDS } from "./fold_states.js";
import { foldName } from "./step_kinds.js";
import { movedBy } from "./words.js";

/** @import { Fold, FoldKind } from "pleat" */

const DONE_BEFORE = say("fold_state.before");

/**
 * @typedef {object} Verbs
 * @property {() => void} onSelect
 * @property {() => void} onShow
 * @property {(name: string) => void} onRename
 * @property {(kind: FoldKind) => void} onColour
 * @property {(radius: number|null) => void} onGrip
 * @property {(why: string) => void} onRefuse
 * @property {(by: number) => void} onMove
 * @property {() => void} onDelete
 */

/**
 * @typedef {object} Now
 * @property {number} index
 * @property {number} count of folds
 * @property {number} garmentRadius metres
 * @property {boolean} isDoneBefore whether it is done before the plan starts
 * @property {boolean} isAssumed whether its own radius is taken to be more than that
 * @property {{index: number, name: string}[]} waits what it waits for
 * @property {string} problem what is wrong with it, or nothing
 */

export class FoldRow {
  /** @param {string} id of the fold @param {Verbs} verbs */
  constructor(id, verbs) {
    this.verbs = verbs;
    this.mark = element("span", "fold-number");
    this.stroke = element("span", "stroke");
    this.name = button("fold-name", (event) => event.detail < 2 && verbs.onSelect());
    this.name.addEventListener("dblclick", () => this.rename());
    this.waits = element("span", "fold-waits");
    this.eye = iconButton("eye", "", verbs.onShow);
    this.fields = new FoldFields(verbs, () => this.rename());
    this.assumed = element("span", "fold-assumed");
    this.fields.root.classList.add("for-editors");
    const marks = element("span", "fold-marks", this.assumed, this.waits);
    this.line = element("div", "fold-line", this.mark, this.stroke, this.name, marks, this.eye);
    this.root = element("li", "fold-row", this.line, this.fields.root);
    this.root.dataset.fold = id;
    /** @type {Fold|null} as it was shown last */
    this.fold = null;
    this.index = 0;
    this.problem = "";
    /** Whether it is done before the plan starts. */
    this.isDoneBefore = false;
    /** The names of what it waits for. */
    this.waiting = "";
    /** @type {import("./fold_states.js").FoldState|"none"} */
    this.state = "none";
    /** @type {HTMLInputElement|null} in which it is being renamed */
    this.field = null;
  }

  /** @param {Fold} fold of the drawing @param {Now} now */
  show(fold, { index, count, garmentRadius, isDoneBefore, isAssumed, waits, problem }) {
    this.fold = fold;
    this.index = index;
    const called = foldName(fold, index);
    if (!this.field) this.name.textContent = called;
    this.root.dataset.kind = fold.kind;
    this.root.classList.toggle("is-illegal", problem !== "");
    this.name.title = problem || movedBy(fold.kind);
    const assumed = isAssumed ? say("assumption.grip", { radius: length(fold.grip_radius_m ?? garmentRadius) }) : "";
    if (assumed !== this.assumed.dataset.text) {
      this.assumed.dataset.text = assumed;
      this.assumed.replaceChildren(...(assumed ? [assumptionChip(assumed, () => this.verbs.onGrip(null))] : []));
    }
    this.waits.replaceChildren(...waits.map((other) => element("span", "badge", String(other.index + 1))));
    this.waits.title = waits.length
      ? say("fold.after_hint", { folds: waits.map((other) => other.name).join(", ") })
      : "";
    this.waiting = listed(waits.map((other) => other.name));
    this.problem = problem;
    this.isDoneBefore = isDoneBefore;
    this.mark.title = isDoneBefore ? DONE_BEFORE : "";
    this.fields.show(fold, { called, isFirst: index === 0, isLast: index === count - 1, garmentRadius });
    relabel(this.eye, say("fold.show_before", { fold: called }));
    this.showState(this.state, true);
  }

  /** @param {import("./fold_states.js").FoldState|"none"} state @param {boolean} always */
  showState(state, always = false) {
    if (state === this.state && !always) return;
    this.state = state;
    this.root.dataset.state = state;
    this.root.setAttribute("aria-current", String(state === "current"));
    this.mark.replaceChildren(this.problem ? "\u2715" : state === "done" ? smallIcon("tick") : String(this.index + 1));
    const told = [
      `${this.index + 1}`,
      this.fold && movedBy(this.fold.kind),
      this.problem || (this.isDoneBefore ? DONE_BEFORE : STATE_WORDS[state]),
      this.waiting && say("fold.after", { folds: this.waiting }),
    ];
    this.name.setAttribute("aria-description", told.filter(Boolean).join(", "));
  }

  /** @param {boolean} isSelected @param {boolean} isShown whether the board shows the moment before it */
  showSelection(isSelected, isShown) {
    this.root.classList.toggle("is-selected", isSelected);
    this.name.setAttribute("aria-pressed", String(isSelected));
    this.eye.setAttribute("aria-pressed", String(isShown));
    this.fields.root.hidden = !isSelected;
  }

  /** @param {boolean} isStop whether Tab stops in this row */
  setStop(isStop) {
    for (const part of [this.name, this.eye]) part.tabIndex = isStop ? 0 : -1;
  }

  /** Turn the name into a field until Enter, Escape or leaving it. */
  rename() {
    if (isViewOnly || this.field || !this.fold) return;
    const about = { placeholder: foldName({}, this.index), ariaLabel: say("fold.name") };
    const field = input("field fold-rename", { value: this.fold.name, maxLength: 200, ...about });
    this.field = field;
    this.name.hidden = true;
    this.name.after(field);
    field.addEventListener("keydown", (event) => {
      event.stopPropagation();
      if (event.key === "Enter") this.endRename(true);
      if (event.key === "Escape") this.endRename(false);
    });
    field.addEventListener("blur", () => this.endRename(true));
    field.focus();
    field.select();
  }

  /** @param {boolean} isKept */
  endRename(isKept) {
    const { field } = this;
    if (!field) return;
    this.field = null; // first: removing it blurs it
    const hadFocus = document.activeElement === field;
    const name = field.value.trim();
    field.remove();
    this.name.hidden = false;
    if (hadFocus) this.name.focus();
    if (!isKept || name === this.fold?.name) return;
    this.name.textContent = foldName({ name }, this.index);
    this.verbs.onRename(name);
  }
}
