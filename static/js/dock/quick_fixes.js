/** Quick fixes of a drawing that cannot be planned: asks the server once the drawing rests. */

/** @import { QuickFixes as Answer, Says } from "pleat" */
/** @import { Preview } from "../store.js" */

/** @typedef {import("./suggestion_search.js").Suggestion} Suggestion */

export class QuickFixes extends EventTarget {
  /** @param {import("../store.js").Store} store */
  constructor(store) {
    super();
    this.store = store;
    /** @type {Suggestion[]} the best first */
    this.found = [];
    /** @type {number|null} the version that is asked about */
    this.version = null;
  }

  /** Ask while the drawing rests with something wrong; anything else forgets what was found. */
  follow() {
    const { plan: message, state } = this.store;
    const isWrong = state && message?.status === "illegal" && message.version === state.version;
    const wanted = isWrong && !state.gesture && state.drawing.outline.length ? state.version : null;
    if (wanted === this.version) return;
    this.version = wanted;
    if (this.found.length) this.store.setPreview(null);
    this.take([]);
    if (wanted !== null) this.ask(wanted);
  }

  /** @param {number} version */
  async ask(version) {
    const answer = await this.store.ask({ do: "quick_fixes" }).catch(() => null);
    const told = /** @type {Answer|undefined} */ (answer?.result);
    if (this.version !== version || told?.version !== version) return;
    this.take(told.quick_fixes.map(({ label, says, drawing }) => suggestion(label, says, { drawing, version })));
  }

  /** @param {Suggestion[]} found */
  take(found) {
    if (!found.length && !this.found.length) return;
    this.found = found;
    this.dispatchEvent(new Event("change"));
  }
}

/**
 * A quick fix has no plan yet, and so no cost.
 * @param {string} message
 * @param {Says} says
 * @param {Preview} change
 * @returns {Suggestion}
 */
function suggestion(message, says, change) {
  return { kind: "quick_fix", is_assumption: false, message, says, change, size: 0, cost_s: null, plan_id: null };
}
