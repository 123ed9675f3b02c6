/**
 * The strip of suggestions over the board: why there is no plan, what would help as up to three cards that come while it is
 * looked for, and what is being tried until then. Each place of a card is for one kind of help, so that no card moves
 * while others come.
 */

import { showWhoFolds } from "../dialogs/who_folds.js";
import { QuickFixes } from "../dock/quick_fixes.js";
import { explanation, NO_PLAN } from "../dock/reasons.js";
import { SuggestionSearch } from "../dock/suggestion_search.js";
import { capital } from "../dock/words.js";
import { button, element } from "../dom.js";
import { icon } from "../icons.js";
import { say } from "../language/say.js";
import { inWords } from "../messages/in_words.js";
import { PHONE } from "../phone.js";
import { Cards } from "./cards.js";
import { isViewOnly } from "../view_only.js";
import { namedChanges } from "./named_changes.js";

/** @import { DocumentState, PlanMessage, Reason } from "pleat" */

/** How long a drawing rests before help is looked for (ms). */
const REST_MS = 300;
/** On a lower board the cards are folded away until they are asked for, and a hand reaches through to the cloth (px). */
const OPEN_FROM_PX = 320;
/** How long is looked when that is asked for: some changes take long to be proven (s). */
const LONG_S = 60;
const SEARCHABLE = new Set(["infeasible", "budget_exceeded"]);

export class Suggestions extends EventTarget {
  /** @param {import("../store.js").Store} store @param {HTMLElement} pane */
  constructor(store, pane) {
    super();
    this.store = store;
    this.pane = pane;
    /** Whether somebody chose to see the cards, or not to; null before. @type {boolean|null} */
    this.chosen = null;
    this.phone = matchMedia(PHONE);
    this.search = new SuggestionSearch();
    this.quickFixes = new QuickFixes(store);
    /** @type {Reason[]|undefined} the reasons of the answer */
    this.reasons = undefined;
    /** What they name as enough. @type {import("../dock/suggestion_search.js").Suggestion[]} */
    this.named = [];
    /** @type {number|null|undefined} the version that is searched for; undefined before any is known */
    this.searched = undefined;
    /** Whether more time was given to the search. */
    this.isLong = false;
    /** The id of the answer to the drawing by now. */
    this.known = () => store.plan?.plan?.id;
    this.sentence = element("p", "reason");
    this.note = new SearchNote(store, this.search);
    this.cards = new Cards(store);
    this.again = button("chip", () => store.command({ do: "plan" }), say("suggestions.plan_again"));
    this.onward = button("chip", () => store.command({ do: "look_longer" }), say("suggestions.look_longer_for_plan"));
    this.onward.title = say("suggestions.look_longer_hint");
    this.longer = button("chip look-longer", () => this.lookLonger());
    this.others = button("chip", () => showWhoFolds(store), say("robots.others"));
    this.others.title = say("robots.who_hint");
    this.fold = button("icon-button is-small suggestion-strip-fold", () => this.choose(!this.isOpen), icon("back"));
    const asked = [this.again, this.onward, this.longer, this.others, this.cards.more, this.fold];
    for (const made of asked) made.classList.add("for-editors");
    const head = element("div", "suggestion-strip-head", this.sentence, ...asked);
    this.body = element("div", "suggestion-strip-body for-editors", this.cards.root, this.note.root);
    this.root = element("section", "suggestion-strip", head, this.body);
    this.root.setAttribute("aria-label", say("plan.none"));
    this.root.hidden = true;
    pane.append(this.root);
    for (const source of [this.search, this.quickFixes]) source.addEventListener("change", () => this.showFound());
    for (const name of ["document", "plan", "connection"]) store.addEventListener(name, () => this.follow());
    new ResizeObserver(() => this.tell()).observe(this.root);
    addEventListener("unit", () => this.reword());
    addEventListener("resize", () => this.unfold(this.chosen ?? !this.isLow));
    this.unfold(true);
  }

  get isOpen() {
    return !this.body.hidden;
  }

  get isLow() {
    return this.pane.clientHeight < OPEN_FROM_PX;
  }

  /** Whether it stands at the right side: above the cloth there would be no room left for that. */
  get isBeside() {
    return this.isLow && this.isOpen && !this.phone.matches;
  }

  /** How much of the board's height it covers (px). */
  get height() {
    return this.root.hidden || this.isBeside ? 0 : this.root.offsetHeight + this.root.offsetTop;
  }

  /** How much of the board's right side it covers (px). */
  get width() {
    return this.root.hidden || !this.isBeside ? 0 : this.pane.clientWidth - this.root.offsetLeft;
  }

  /** To the first card, or back. */
  takeFocus() {
    if (this.root.hidden) return;
    this.choose(true);
    /** @type {HTMLElement} */ (this.cards.root.querySelector("button") ?? this.fold).focus();
  }

  /** Search, or ask for quick fixes, while the drawing rests without a plan; anything else ends it. */
  follow() {
    if (!isViewOnly) this.quickFixes.follow();
    const { plan: message, state } = this.store;
    const isAnswered = state && message?.version === state.version && !state.gesture;
    if (message && state) this.show(message, state);
    const resting = !isViewOnly && isAnswered && SEARCHABLE.has(message.status) ? state : null;
    const wanted = resting && resting.version;
    const isNamedAnew = this.takeNamed(resting && message);
    if (wanted === this.searched) {
      if (isNamedAnew) this.showFound();
      return;
    }
    this.searched = wanted;
    this.isLong = false;
    if (resting) this.search.start(resting, { delay_ms: REST_MS, known: this.known });
    else this.search.stop();
  }

  /** Whether the reasons of an answer are others than before; what they name is offered. @param {PlanMessage|null} message */
  takeNamed(message) {
    const reasons = message?.plan?.reasons;
    if (reasons === this.reasons) return false;
    this.reasons = reasons;
    this.named = namedChanges(message, this.store.state);
    return true;
  }

  /** While the next answer is being worked out, what was said before stays. @param {PlanMessage} message @param {DocumentState} state */
  show(message, state) {
    if (message.status === "planning" || message.version !== state.version) return;
    const isBlank = !state.drawing.outline.length;
    const wasHidden = this.root.hidden;
    this.root.hidden = isBlank || !NO_PLAN.has(message.status);
    document.body.classList.toggle("has-suggestions", !this.root.hidden);
    if (!this.root.hidden) this.sentence.textContent = explanation(message, state);
    this.again.hidden = message.status !== "failed";
    this.onward.hidden = !message.may_look_longer;
    if (wasHidden && !this.root.hidden) this.unfold(this.chosen ?? !this.isLow);
    else if (wasHidden !== this.root.hidden) this.tell();
  }

  /** What has lengths in it is made anew. */
  reword() {
    this.cards.clear();
    const { plan: message, state } = this.store;
    if (message && state) this.show(message, state);
    this.showFound();
  }

  showFound() {
    const { found, isRunning, fault } = this.search;
    this.cards.show(this.quickFixes.found, found, this.named, isRunning);
    this.note.show(this.cards.count, typeof this.searched === "number");
    const isNothing = !isRunning && !this.cards.count && typeof this.searched === "number";
    this.longer.hidden = !isNothing || (this.isLong && !fault);
    this.others.hidden = !isNothing;
    this.longer.textContent = fault ? say("suggestions.look_again") : say("plan.look_longer");
    this.tell();
  }

  lookLonger() {
    this.isLong = true;
    const { state } = this.store;
    if (state) this.search.start(state, { work_s: LONG_S, known: this.known });
  }

  /** @param {boolean} isOpen */
  choose(isOpen) {
    this.chosen = isOpen;
    this.unfold(isOpen);
  }

  /** @param {boolean} isOpen */
  unfold(isOpen) {
    this.body.hidden = !isOpen;
    this.root.classList.toggle("is-line", this.isLow && !isOpen);
    this.root.classList.toggle("is-beside", this.isBeside);
    this.fold.setAttribute("aria-expanded", String(isOpen));
    this.fold.setAttribute("aria-label", isOpen ? say("suggestions.hide") : say("suggestions.show"));
    this.fold.title = this.fold.getAttribute("aria-label") ?? "";
    this.tell();
  }

  /** It covers more of the board, or less. */
  tell() {
    this.dispatchEvent(new Event("change"));
  }
}

/** Trials follow one another faster than anybody reads. */
const EVERY_MS = 600;

/** What the search for help is doing: what is being tried, and in the end that nothing was found. */
class SearchNote {
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
    const found = count ? say("suggestions.found", { count }) : "";
    const told = found || (isRunning ? say("suggestions.looking_said") : this.root.hidden ? "" : this.nothing());
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
    if (!trying) return say("suggestions.looking");
    return say("suggestions.trying", {
      what: capital(inWords({ ...trying, message: "" }, this.store.state?.drawing.folds ?? [])),
    });
  }

  nothing() {
    const { fault, isComplete } = this.search;
    if (fault) return say("search.fault", { fault });
    if (!isComplete) return say("suggestions.not_all");
    return say("suggestions.nothing");
  }
}
