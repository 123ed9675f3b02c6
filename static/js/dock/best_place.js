/** The button `Best place`: looks for a place on the table where the plan is quicker, and offers it. */

import { button, element } from "../dom.js";
import { say } from "../language/say.js";
import { suggestionButton } from "./suggestion_button.js";
import { SuggestionSearch } from "./suggestion_search.js";

/** All places are tried as long as that lasts (s); then the best so far is told. */
const WORK_S = 4;

export class BestPlace {
  /** @param {import("../store.js").Store} store */
  constructor(store) {
    this.store = store;
    this.search = new SuggestionSearch();
    /** @type {number|null} the version that it is looked for */
    this.version = null;
    this.button = button("chip", () => this.begin(), say("place.best"));
    this.button.title = say("place.best_hint");
    this.note = element("p", "hint search-note");
    this.note.setAttribute("aria-live", "polite");
    this.offer = element("div", "suggestions");
    this.end = button("quiet", () => this.close(), say("search.stop"));
    this.root = element("div", "best-place", this.note, this.offer, this.end);
    this.search.addEventListener("change", () => this.show());
    this.close();
  }

  begin() {
    const { state } = this.store;
    if (!state) return;
    this.version = state.version;
    this.search.start(state, { work_s: WORK_S });
  }

  /** What was found is about one drawing only. */
  follow() {
    if (this.version !== null && this.version !== this.store.state?.version) this.close();
  }

  close() {
    this.version = null;
    this.store.setPreview(null);
    this.search.stop();
  }

  show() {
    const { found, isRunning, fault } = this.search;
    const [best] = found.toSorted((one, other) => one.cost_s - other.cost_s);
    this.root.hidden = this.version === null;
    this.button.disabled = isRunning;
    this.note.classList.toggle("is-searching", isRunning);
    this.note.hidden = best !== undefined;
    this.offer.hidden = best === undefined;
    this.note.textContent = isRunning ? say("place.trying") : outcome(fault);
    this.end.textContent = isRunning ? say("search.stop") : say("dialog.close");
    this.offer.replaceChildren(...(best ? [suggestionButton(this.store, best, "is-first")] : []));
  }
}

/** @param {string} fault */
const outcome = (fault) => (fault ? say("search.fault", { fault }) : say("place.none"));
