/** The cards of the strip of suggestions: one place for each kind of help, and all others on demand. */

import { ringOf } from "../board/curves.js";
import { picture } from "../dialogs/picture.js";
import { offer, suggestionWords } from "../dock/suggestion_button.js";
import { ranked } from "../dock/suggestion_search.js";
import { seconds } from "../dock/words.js";
import { arrowsLead, button, element, group } from "../dom.js";
import { say } from "../language/say.js";
import { HELP } from "../messages/changes.js";
import { foldedPicture } from "./folded_picture.js";

/** @import { Suggestion } from "../dock/suggestion_search.js" */
/** @import { SuggestionEvent } from "pleat" */

const SHOWN_MAX = 3;

/** What each card offers. @type {WeakMap<Element, Suggestion>} */
const OFFERED = new WeakMap();

export class Cards {
  /** @param {import("../store.js").Store} store */
  constructor(store) {
    this.store = store;
    this.root = element("div", "cards");
    group(this.root, say("suggestions.suggestions"));
    this.root.addEventListener("keydown", (event) => arrowsLead(this.root, event));
    this.more = button("chip more-cards", () => this.showAll(!this.isAll));
    this.more.hidden = true;
    this.isAll = false;
    /** @type {Suggestion[]} the best first */
    this.order = [];
    this.isRunning = false;
    for (const name of ["pointerleave", "focusout"]) this.root.addEventListener(name, () => this.draw());
  }

  /** The number of changes found. */
  get count() {
    return this.order.length;
  }

  clear() {
    this.root.replaceChildren();
  }

  /**
   * @param {Suggestion[]} quickFixes
   * @param {SuggestionEvent[]} found
   * @param {Suggestion[]} named by reasons; of one kind with what was found that comes instead, with its plan
   * @param {boolean} isRunning
   */
  show(quickFixes, found, named, isRunning) {
    const [changed, assumed] = [false, true].map((is) => found.filter((one) => (groupOf(one) === "assume") === is));
    const others = named.filter(({ kind }) => found.every((one) => one.kind !== kind));
    this.order = [...quickFixes, ...ranked(changed), ...others, ...ranked(assumed)];
    this.isRunning = isRunning;
    if (!this.order.length) this.isAll = false;
    if (!this.isUnderHand()) this.draw();
  }

  /** Whether somebody is about to press a card: it stays where it is as long as it holds. */
  isUnderHand() {
    return (
      this.order.length > 0 && this.root.querySelector("button") !== null && this.root.matches(":hover, :focus-within")
    );
  }

  draw() {
    const shown = this.isAll ? this.order : this.chosen();
    const first = shown[0];
    /** @type {HTMLElement[]} */
    const cards = shown.map((one) => this.made(one, one === first));
    const isWaiting = this.isRunning && !this.isAll;
    const missing = isWaiting ? GROUPS.filter((group) => !shown.some((one) => groupOf(one) === group)) : [];
    const slots = missing.map((group) => empty(group));
    const all = isWaiting ? [...cards, ...slots].sort((a, b) => place(a) - place(b)) : cards;
    const isSame =
      all.length === this.root.children.length && all.every((one, n) => isAlike(one, this.root.children[n]));
    if (!isSame) this.root.replaceChildren(...all);
    this.root.hidden = !all.length;
    const others = this.order.length - this.chosen().length;
    this.more.hidden = others <= 0;
    this.more.textContent = this.isAll ? say("suggestions.fewer") : say("suggestions.more", { count: others });
  }

  /** The best of each kind of help; where a kind has none, more of the others. */
  chosen() {
    const firsts = GROUPS.flatMap((group) => this.order.find((one) => groupOf(one) === group) ?? []);
    const others = this.isRunning ? [] : this.order.filter((one) => !firsts.includes(one));
    return [...firsts, ...others].slice(0, SHOWN_MAX);
  }

  /** The card there is already, so that a hand on it stays there, or a new one. @param {Suggestion} one @param {boolean} isFirst */
  made(one, isFirst) {
    const known = [...this.root.children].find((child) => OFFERED.get(child) === one);
    const made = /** @type {HTMLElement} */ (known ?? card(this.store, one));
    OFFERED.set(made, one);
    made.classList.toggle("is-first", isFirst);
    return made;
  }

  /** @param {boolean} isAll */
  showAll(isAll) {
    this.isAll = isAll;
    this.draw();
  }
}

/** Where a card of one kind of help will be. @param {typeof GROUPS[number]} group */
function empty(group) {
  const made = element("div", "card is-empty");
  made.dataset.group = group;
  made.dataset.title = HELP[group];
  made.setAttribute("aria-hidden", "true");
  return made;
}

/** @param {HTMLElement} one */
const place = ({ dataset }) => GROUPS.findIndex((group) => group === dataset.group);

/** @param {HTMLElement} one @param {Element} other */
const isAlike = (one, other) =>
  one === other ||
  (one.matches(".is-empty") &&
    other.matches(".is-empty") &&
    one.dataset.group === /** @type {HTMLElement} */ (other).dataset.group);

/** The kinds of help, in the order of their places. */
const GROUPS = /** @type {const} */ (["place", "fold", "assume"]);

/** @type {Record<Suggestion["kind"], typeof GROUPS[number]>} */
const GROUP_OF = {
  placement: "place",
  size: "place",
  fold_line: "fold",
  split: "fold",
  halve: "fold",
  flip: "fold",
  order: "fold",
  quick_fix: "fold",
  station: "assume",
  robot: "assume",
  friction: "assume",
  grip_radius: "assume",
  comfort_radius: "assume",
  together: "assume",
};

/** Kinds that take the place of an assumption, and are none. */
const ABOUT_ROBOT = new Set(["station", "robot"]);

/** @param {Suggestion} one */
const groupOf = ({ kind }) => GROUP_OF[kind];

/**
 * A change that gives a plan, with a picture of the folded cloth, and what the plan then takes.
 * @param {import("../store.js").Store} store
 * @param {Suggestion} suggestion
 */
function card(store, suggestion) {
  const { change, cost_s: cost, plan_id: plan } = suggestion;
  const shown = element("span", "card-picture");
  if (plan) foldedPicture(plan).then((drawn) => drawn && shown.replaceChildren(drawn));
  else if (change.drawing) shown.append(pictureOf(change.drawing));
  const what = element("span", "suggestion-what", suggestionWords(store, suggestion));
  const parts = cost === null ? [what] : [what, element("span", "suggestion-cost", seconds(cost))];
  const made = button("card", () => {}, shown, element("span", "card-words", ...parts));
  made.dataset.kind = suggestion.kind;
  made.dataset.group = groupOf(suggestion);
  made.dataset.title = ABOUT_ROBOT.has(suggestion.kind) ? HELP.robot : HELP[groupOf(suggestion)];
  made.setAttribute("aria-description", made.dataset.title);
  offer(store, suggestion, made);
  return made;
}

/** @param {import("pleat").Drawing} drawing */
const pictureOf = ({ outline, folds }) =>
  picture(
    ringOf({ outline }),
    folds.map(({ kind, start, end }) => ({ kind, start: start.point, end: end.point })),
  );
