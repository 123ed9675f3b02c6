/** The layers of the stack at each moment; asked for when a folded moment is shown. */

/** @import { Layer, Steps } from "pleat" */

export class Layers {
  /** @param {import("../store.js").Store} store @param {() => void} onChange */
  constructor(store, onChange) {
    this.store = store;
    this.onChange = onChange;
    /** @type {Steps} */
    this.known = { version: -1, steps: [] };
    this.isAsking = false;
  }

  /**
   * The layers at a moment, bottom to top; null while they are not known.
   * @param {number} step
   * @returns {Layer[]|null}
   */
  at(step) {
    if (step === 0) return null;
    if (this.known.version !== this.store.state?.version) this.ask();
    return this.known.version === this.store.state?.version ? (this.known.steps[step]?.layers ?? null) : null;
  }

  async ask() {
    if (this.isAsking) return;
    this.isAsking = true;
    const answer = await this.store.ask({ do: "steps" }).catch(() => null);
    this.isAsking = false;
    if (!answer) return;
    this.known = /** @type {Steps} */ (answer.result);
    this.onChange();
  }
}
