/** What the search for help is doing: what is being tried, and in the end that nothing was found. */

import { element } from "../dom.js";
import { capital } from "../dock/words.js";
import { inWords } from "../messages/in_words.js";

/** Trials follow one another faster than anybody reads. */
const EVERY_MS = 600;

export class SearchNote {
  /**
   * @param {import("../store.js").Store} store
   * @param {import("../dock/suggestion_search.js").SuggestionSearch} search
   */
  constructor(store, search) {
    this.store = store;
    this.search = search;
    this.words = element("span", "search-words");
    this.told = element("span", "unseen");
    this.told.setAttribute("aria-live", "polite");
    this.root = element("p", "hint search-note", this.words, this.told);
    this.timer = 0;
  }

  /** @param {number} count of cards @param {boolean} isAbout whether there is something to be searched for */
  show(count, isAbout) {
    const { isRunning } = this.search;
    this.root.classList.toggle("is-searching", isRunning);
    this.root.hidden = !isRunning && (count > 0 || !isAbout);
    if (!isRunning) this.say(this.nothing());
    else if (!this.timer) this.say(this.trying());
    const found = count ? `${count} ${count === 1 ? "change" : "changes"} found that would help.` : "";
    const told = found || (isRunning ? "Looking for what would help." : this.root.hidden ? "" : this.nothing());
    if (this.told.textContent !== told) this.told.textContent = told;
  }

  /** @param {string} words */
  say(words) {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      this.timer = 0;
      if (this.search.isRunning) this.say(this.trying());
    }, EVERY_MS);
    if (this.words.textContent !== words) this.words.textContent = words;
  }

  trying() {
    const { trying } = this.search;
    if (!trying) return "Looking for what would help\u2026";
    return `Trying: ${capital(inWords({ ...trying, message: "" }, this.store.state?.drawing.folds ?? []))}\u2026`;
  }

  nothing() {
    const { fault, isComplete } = this.search;
    if (fault) return `Nothing could be looked for: ${fault}.`;
    if (!isComplete) return "Nothing has been found yet, and not all was tried.";
    return "No single small change gives a plan.";
  }
}
