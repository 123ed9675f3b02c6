/** A line over the plan while it is planned from the middle: from what state, and the way back to the beginning. */

import { button, element } from "../dom.js";
import { say } from "../language/say.js";
import { startInWords } from "../messages/starts.js";

export class StartLine {
  /**
   * @param {import("../store.js").Store} store
   * @param {() => void} onBack after the way back was taken
   */
  constructor(store, onBack) {
    this.store = store;
    /** Whether it takes over the focus from a step that is to go away. */
    this.isAwaited = false;
    this.words = element("p", "");
    this.words.setAttribute("aria-live", "polite");
    const goBack = () => {
      store.command({ do: "plan_from", step: null });
      onBack();
    };
    this.back = button("chip", goBack, say("start.from_start"));
    this.back.title = say("start.from_start_hint");
    this.back.hidden = true;
    this.root = element("div", "start-line", this.words, this.back);
    for (const name of ["document", "plan"]) store.addEventListener(name, () => this.show());
    addEventListener("unit", () => this.show());
    this.show();
  }

  /** Take the focus once planned from the middle, if the step that has it now goes away. */
  takeFocus() {
    this.isAwaited = true;
  }

  show() {
    const { plan, state } = this.store;
    const start = plan && state && plan.version === state.version ? plan.start : null;
    const told = start && state ? startInWords(start, state.drawing) : "";
    this.root.classList.toggle("is-empty", !told);
    this.back.hidden = !told;
    if (this.words.textContent !== told) this.words.textContent = this.words.title = told;
    if (!told || !this.isAwaited) return;
    this.isAwaited = false;
    if (document.activeElement === document.body) this.back.focus();
  }
}
