/** What stands where the plan would be: one sentence, what would help as buttons, and all the reasons on demand. */

import { button, element } from "../dom.js";
import { QuickFixes } from "./quick_fixes.js";
import { details, explanation } from "./reasons.js";
import { suggestionButton } from "./suggestion_button.js";
import { ranked, SuggestionSearch } from "./suggestion_search.js";

/** @import { DocumentState, PlanMessage } from "pleat" */
/** @import { Suggestion } from "./suggestion_search.js" */

const SHOWN_MAX = 3;
const REST_MS = 500;
/** How long is looked when that is asked for: some changes take long to be proven (s). */
const LONG_S = 60;
const SEARCHABLE = new Set(["infeasible", "budget_exceeded"]);

/** @typedef {(one: Suggestion, index: number) => HTMLElement} Make makes a suggestion's button */

/** What each button offers. @type {WeakMap<Element, Suggestion>} */
const OFFERED = new WeakMap();

export class NoPlan {
  /** @param {import("../store.js").Store} store */
  constructor(store) {
    this.store = store;
    this.search = new SuggestionSearch();
    this.quickFixes = new QuickFixes(store);
    /** @type {number|null|undefined} the version that is searched for; undefined before any is known */
    this.searched = undefined;
    /** Whether more time was given to the search. */
    this.isLong = false;
    this.sentence = element("p", "reason");
    this.longer = button("chip look-longer", () => this.lookLonger());
    this.longer.hidden = true;
    this.again = button("chip", () => store.command({ do: "plan" }), "Plan again");
    this.onward = button("chip", () => store.command({ do: "look_longer" }), "Look longer for a plan");
    this.onward.title = "Search on for a plan, six times as long";
    this.help = element("div", "suggestions");
    this.help.setAttribute("role", "group");
    this.help.setAttribute("aria-label", "Suggestions");
    this.progress = element("p", "hint search-note");
    this.progress.setAttribute("aria-live", "polite");
    this.more = element("div", "suggestions");
    this.all = element("ul", "reasons");
    this.all.setAttribute("aria-label", "Reasons");
    this.inFull = element("div", "in-full", this.all, this.more);
    this.why = button("chip why", () => this.unfold(Boolean(this.inFull.hidden)), "Why?");
    this.root = element("div", "no-plan", this.sentence, this.progress, this.again, this.onward, this.longer, this.help, this.inFull);
    for (const source of [this.search, this.quickFixes]) source.addEventListener("change", () => this.showFound());
    for (const name of ["pointerleave", "focusout"]) this.help.addEventListener(name, () => this.showFound());
    addEventListener("unit", () => this.reword());
    this.unfold(false);
  }

  /** Buttons with lengths in them are made anew. */
  reword() {
    for (const root of [this.help, this.more]) root.replaceChildren();
    this.showFound();
  }

  /**
   * @param {PlanMessage} message without a plan
   * @param {DocumentState} state
   */
  show(message, state) {
    this.sentence.textContent = explanation(message, state);
    this.again.hidden = message.status !== "failed";
    this.onward.hidden = !message.may_look_longer;
    const all = details(message, state);
    this.all.replaceChildren(...all.map((text) => element("li", "", text)));
    this.why.hidden = all.length === 0;
  }

  /** Search, or ask for quick fixes, while the drawing rests without a plan; anything else ends it. */
  follow() {
    this.quickFixes.follow();
    const { plan: message, state } = this.store;
    const isAnswered = state && message?.version === state.version && !state.gesture;
    const resting = isAnswered && SEARCHABLE.has(message.status) ? state : null;
    const wanted = resting && resting.version;
    if (wanted === this.searched) return;
    this.searched = wanted;
    this.isLong = false;
    this.unfold(false);
    this.store.setPreview(null);
    if (resting) this.search.start(resting, { delay_ms: REST_MS });
    else this.search.stop();
  }

  showFound() {
    const { found, isRunning, fault } = this.search;
    const order = [...this.quickFixes.found, ...ranked(found)];
    const offered = order.slice(0, SHOWN_MAX);
    /** @type {Make} */
    const make = (one, index) => suggestionButton(this.store, one, index === 0 ? "is-first" : "");
    if (!isUnderHand(this.help, order)) fill(this.help, offered, make);
    fill(this.more, order.slice(SHOWN_MAX), make);
    this.progress.classList.toggle("is-searching", isRunning);
    this.progress.hidden = !isRunning && offered.length > 0;
    this.progress.textContent = isRunning ? looking(offered.length) : this.nothing(fault);
    this.progress.hidden ||= !isRunning && this.searched === null;
    this.offerLonger(!isRunning && !offered.length && typeof this.searched === "number", fault);
  }

  lookLonger() {
    this.isLong = true;
    if (this.store.state) this.search.start(this.store.state, { work_s: LONG_S });
  }

  /**
   * Nothing was found: there is more time for it, once, or another try.
   * @param {boolean} isNothing
   * @param {string} fault
   */
  offerLonger(isNothing, fault) {
    this.longer.hidden = !isNothing || (this.isLong && !fault);
    this.longer.textContent = fault ? "Look again" : "Look longer";
  }

  /** @param {string} fault */
  nothing(fault) {
    if (fault) return `Nothing could be looked for: ${fault}.`;
    if (!this.search.isComplete) return "Nothing has been found yet, and not all was tried.";
    return "No single small change gives a plan.";
  }

  /** @param {boolean} isOpen */
  unfold(isOpen) {
    this.inFull.hidden = !isOpen;
    this.why.setAttribute("aria-expanded", String(isOpen));
    if (isOpen) this.inFull.scrollIntoView({ block: "nearest" });
  }
}

/** What is said while the search goes on; beside suggestions its bar says enough. @param {number} offered */
const looking = (offered) => (offered ? "" : "Looking for what would help\u2026");

/**
 * Whether somebody is about to press one of the buttons, which had better stay where they are as long as they hold.
 * @param {HTMLElement} root
 * @param {Suggestion[]} found
 */
function isUnderHand(root, found) {
  return found.length > 0 && root.children.length > 0 && root.matches(":hover, :focus-within");
}

/**
 * Buttons for suggestions; those that are there already are kept, so that the hand on one of them stays there.
 * @param {HTMLElement} root
 * @param {Suggestion[]} suggestions
 * @param {Make} make
 */
function fill(root, suggestions, make) {
  const known = [...root.children];
  const wanted = suggestions.map((one, index) => {
    const made = known.find((child) => OFFERED.get(child) === one) ?? make(one, index);
    OFFERED.set(made, one);
    made.classList.toggle("is-first", index === 0);
    return made;
  });
  if (wanted.length !== root.children.length || wanted.some((made, index) => made !== root.children[index])) {
    root.replaceChildren(...wanted);
  }
}
