/** A plan that the 3D view plays while something on the page that stands for it is pointed at. */

/** So long something is pointed at before the 3D view shows it (ms). */
const POINTED_MS = 250;

export class PointedPlan {
  /** @param {import("./store.js").Store} store @param {string|null|undefined} plan its id, if there is one */
  constructor(store, plan) {
    this.store = store;
    this.plan = plan;
    this.timer = 0;
    this.isPointed = false;
  }

  point() {
    const { store, plan } = this;
    if (!plan || this.isPointed) return;
    this.isPointed = true;
    this.timer = setTimeout(() => store.command({ do: "preview", plan }), POINTED_MS);
  }

  leave() {
    clearTimeout(this.timer);
    if (this.isPointed) this.store.command({ do: "preview", plan: null });
    this.isPointed = false;
  }
}
