/** What the search for help is doing: what is being tried, and in the end that nothing was found. */

import { element } from "../dom.js";
import { capital } from "../dock/words.js";
import { say } from "../language/say.js";
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
    const found = count ? say("repair.found", { count }) : "";
    const told = found || (isRunning ? say("repair.looking_said") : this.root.hidden ? "" : this.nothing());
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
    if (!trying) return say("repair.looking");
    return say("repair.trying", {
      what: capital(inWords({ ...trying, message: "" }, this.store.state?.drawing.folds ?? [])),
    });
  }

  nothing() {
    const { fault, isComplete } = this.search;
    if (fault) return say("search.fault", { fault });
    if (!isComplete) return say("repair.not_all");
    return say("repair.nothing");
  }
}
