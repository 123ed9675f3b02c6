/** The column of the folds: the list `Folds`, or the same as a graph. */

import { isWide } from "../assumptions.js";
import { button, element } from "../dom.js";
import { inEnglish, say } from "../language/say.js";
import { isViewOnly } from "../view_only.js";
import { toggle } from "./buttons.js";
import { Dag } from "./dag.js";
import * as edits from "./fold_edits.js";
import { FoldOrder } from "./fold_order.js";
import { FoldRow } from "./fold_row.js";
import { foldStates, waitsFor } from "./fold_states.js";
import { foldName } from "./step_kinds.js";

/** @type {Record<string, number>} */
const ARROWS = { ArrowUp: -1, ArrowDown: 1 };

export class Folds {
  /**
   * @param {import("../store.js").Store} store
   * @param {import("./clock.js").Clock} clock
   * @param {import("./shown_plan.js").ShownPlan} shown
   */
  constructor(store, clock, shown) {
    this.store = store;
    this.clock = clock;
    this.shown = shown;
    /** @type {Map<string, FoldRow>} */
    this.rows = new Map();
    this.list = element("ol", "fold-list");
    this.list.setAttribute("aria-label", say("folds.title"));
    this.order = new FoldOrder(
      this.list,
      (id, to) => this.moveTo(id, to),
      () => this.show(),
    );
    this.empty = element("p", "hint", say("folds.none_yet"));
    this.dag = new Dag((id) => this.select(id));
    this.switch = toggle(say("dag.title"), (isOn) => this.showGraph(isOn));
    this.propose = button("chip for-editors", () => store.tell("propose"), say("proposal.do"));
    this.propose.title = say("proposal.hint");
    this.propose.hidden = true;
    const head = element("header", "dock-head", element("h2", "", say("folds.title")), this.propose, this.switch);
    this.root = element("section", "dock-folds", head, this.list, this.empty, this.dag.root);
    this.list.addEventListener("keydown", (event) => this.onKey(event));
    this.list.addEventListener("focusin", (event) => this.stopAt(rowOf(event)));
    shown.addEventListener("change", () => this.show());
    for (const name of ["selection", "step"]) store.addEventListener(name, () => this.showSelection());
    clock.addEventListener("tick", () => this.tick());
    this.showGraph(false);
  }

  get folds() {
    return this.store.state?.drawing.folds ?? [];
  }

  /** The plan, if it is about these very folds. */
  get plan() {
    return this.shown.fits ? this.shown.plan : null;
  }

  /** The folds that are done before the plan starts. */
  get done() {
    const { fits, plan, start } = this.shown;
    return (fits || !plan) && start ? start.folds_done : [];
  }

  show() {
    const { state } = this.store;
    if (!state || this.order.isDragging) return;
    const { folds, grip_radius_m: garmentRadius } = state.drawing;
    for (const [id] of [...this.rows].filter(([id]) => !folds.some((fold) => fold.id === id))) this.rows.delete(id);
    folds.forEach((fold, index) => {
      const row = this.rows.get(fold.id) ?? this.add(fold.id);
      row.show(fold, {
        index,
        count: folds.length,
        garmentRadius,
        isDoneBefore: this.done.includes(index),
        isAssumed: isWide(state.drawing, fold),
        waits: waitsFor(this.plan, index).map((other) => ({ index: other, name: foldName(folds[other], other) })),
        problem: state.problems.find((problem) => problem.fold === index)?.message ?? "",
      });
    });
    this.place(folds.map((fold) => /** @type {FoldRow} */ (this.rows.get(fold.id)).root));
    this.propose.hidden = !folds.length; // without any, the board offers it
    this.showGraph(!this.dag.root.hidden);
    this.dag.show(folds, this.plan);
    this.showSelection();
    this.tick();
  }

  /** @param {HTMLElement[]} roots put them in this order, without taking the focus from one that stays in place */
  place(roots) {
    const now = [...this.list.children];
    if (now.length === roots.length && now.every((root, index) => root === roots[index])) return;
    const focused = document.activeElement;
    this.list.replaceChildren(...roots);
    if (focused instanceof HTMLElement && this.list.contains(focused)) focused.focus();
  }

  /** @param {string} id */
  add(id) {
    const { store } = this;
    const row = new FoldRow(id, {
      onSelect: () => this.select(id),
      onShow: () => this.showMoment(id),
      onRename: (name) => store.edit(inEnglish("step.rename_fold"), edits.renamed(id, name)),
      onColour: (kind) => store.edit(inEnglish(`step.make_${kind}`), edits.recoloured(id, kind)),
      onGrip: (radius) => store.edit(inEnglish("step.grip_radius"), edits.gripped(id, radius)),
      onRefuse: (why) => store.refuse(why),
      onMove: (by) => this.moveTo(id, this.indexOf(id) + by),
      onDelete: () => this.remove(id),
    });
    this.rows.set(id, row);
    return row;
  }

  showSelection() {
    const { selection, step } = this.store;
    const chosen = new Set(selection?.kind === "fold" ? selection.ids : []);
    this.folds.forEach((fold, index) => {
      this.rows.get(fold.id)?.showSelection(chosen.has(fold.id), step === index);
    });
    this.dag.showSelection(chosen);
    const stop = this.list.querySelector(".is-selected") ?? this.list.querySelector(".is-stop");
    this.stopAt(stop ?? this.list.firstElementChild);
  }

  tick() {
    const { done } = this;
    const states = foldStates(this.plan, this.clock.now, done);
    this.folds.forEach((fold, index) => {
      this.rows.get(fold.id)?.showState(states[index] ?? (done.includes(index) ? "done" : "none"));
    });
    this.dag.showStates(states);
  }

  /** @param {boolean} isOn the graph in place of the list */
  showGraph(isOn) {
    this.switch.setAttribute("aria-pressed", String(isOn));
    this.list.hidden = isOn || !this.folds.length;
    this.dag.root.hidden = !isOn;
    this.empty.hidden = isOn || this.folds.length > 0;
  }

  /** @param {string} id */
  select(id) {
    const { selection } = this.store;
    const isSelected = selection?.kind === "fold" && selection.ids.length === 1 && selection.ids[0] === id;
    this.store.select(isSelected ? null : { kind: "fold", ids: [id] });
  }

  /** The cloth before a fold, or, if that is shown already, spread out again. @param {string} id */
  showMoment(id) {
    const index = this.indexOf(id);
    this.store.showStep(this.store.step === index ? 0 : index);
  }

  /** @param {string} id @param {number} to */
  async moveTo(id, to) {
    if (to < 0 || to >= this.folds.length || to === this.indexOf(id)) return;
    await this.store.edit(inEnglish("step.reorder"), edits.moved(id, to));
    this.show();
  }

  /** @param {string} id */
  async remove(id) {
    const index = this.indexOf(id);
    await this.store.edit(inEnglish("step.delete_fold"), edits.removed(id));
    const next = this.folds[Math.min(index, this.folds.length - 1)];
    if (next) this.rows.get(next.id)?.name.focus();
  }

  /** @param {string} id */
  indexOf(id) {
    return this.folds.findIndex((fold) => fold.id === id);
  }

  /** @param {KeyboardEvent} event */
  onKey(event) {
    const id = rowOf(event)?.getAttribute("data-fold");
    if (!id) return;
    const step = ARROWS[event.key];
    const isName = event.target === this.rows.get(id)?.name;
    if (step && !event.altKey) this.focusRow(this.indexOf(id) + step);
    else if (isViewOnly) return;
    else if (step) this.moveTo(id, this.indexOf(id) + step);
    else if (event.key === "F2") this.rows.get(id)?.rename();
    else if (isName && (event.key === "Delete" || event.key === "Backspace")) this.remove(id);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  /** @param {number} index */
  focusRow(index) {
    const fold = this.folds[index];
    if (fold) this.rows.get(fold.id)?.name.focus();
  }

  /** Tab goes through one row alone, the arrows from row to row. @param {Element|null} root */
  stopAt(root) {
    for (const row of this.rows.values()) {
      row.setStop(row.root === root);
      row.root.classList.toggle("is-stop", row.root === root);
    }
  }
}

/** @param {Event} event */
const rowOf = (event) => /** @type {Element} */ (event.target).closest(".fold-row");
