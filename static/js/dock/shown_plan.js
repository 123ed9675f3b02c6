/**
 * The plan that is shown, with the folds that it is about.
 *
 * While the next plan is being worked out the one before stays; the drawing's folds may have other names, numbers and
 * colours by then.
 */

/** @import { Fold, Plan, PlanStart } from "pleat" */

export class ShownPlan extends EventTarget {
  /** @param {import("../store.js").Store} store */
  constructor(store) {
    super();
    this.store = store;
    /** @type {Plan|null} the plan in the message of kind `plan`, solved or not; null: there is none */
    this.plan = null;
    /** @type {Fold[]} the folds of the drawing that it is a plan of */
    this.folds = [];
    /** @type {PlanStart|null} the state of the world that it starts from; null: before all folds, as drawn */
    this.start = null;
    for (const name of ["document", "plan"]) store.addEventListener(name, () => this.look());
    addEventListener("unit", () => this.look());
  }

  /** Whether it is about the drawing's folds, in their order. */
  get fits() {
    const now = this.store.state?.drawing.folds ?? [];
    const isSame = this.folds.length === now.length && this.folds.every((fold, index) => fold.id === now[index].id);
    return isSame && this.plan?.dag.folds === now.length;
  }

  look() {
    const { plan: message, state } = this.store;
    const plan = message?.plan ?? null;
    if (!plan?.is_stale) this.start = message?.start ?? null;
    const isNew = plan?.id !== this.plan?.id;
    if (state && (isNew || plan?.version === state.version)) this.folds = state.drawing.folds;
    this.plan = plan;
    this.dispatchEvent(new Event("change"));
  }
}
