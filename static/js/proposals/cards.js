/** The cards of proposals: each a picture of the packet, its numbers, and what the robot makes of it. */

import { number, unit } from "../board/units.js";
import { fetched } from "../dialogs/documents.js";
import { seconds } from "../dock/words.js";
import { arrowsLead, button, element, group } from "../dom.js";
import { say } from "../language/say.js";
import { PointedPlan } from "../pointed_plan.js";
import { layersPicture } from "../suggestions/folded_picture.js";

/** @import { Layer } from "pleat" */
/** @import { Store } from "../store.js" */
/** @import { Proposal } from "./proposal_search.js" */

/** So long each moment of the folds is on show while a proposal is played (ms). */
const MOMENT_MS = 550;

/** What has a mouse or the focus; a finger hovers nowhere, though browsers say so of where it was last. */
const HELD = ":hover, :focus-within";

export class ProposalCards {
  /** @param {Store} store @param {(proposal: Proposal) => void} onChosen */
  constructor(store, onChosen) {
    this.store = store;
    this.onChosen = onChosen;
    /** @type {Map<Proposal, ProposalCard>} in the order of arrival */
    this.cards = new Map();
    this.root = element("div", "proposal-cards");
    group(this.root, say("proposal.ways"));
    this.root.addEventListener("keydown", (event) => arrowsLead(this.root, event));
    for (const name of ["pointerleave", "focusout"]) this.root.addEventListener(name, () => this.place());
  }

  /** @param {Proposal[]} found */
  show(found) {
    const before = this.cards;
    this.cards = new Map();
    for (const proposal of found) {
      const known = before.get(proposal);
      const made = known ?? new ProposalCard(this.store, proposal, () => this.onChosen(proposal));
      this.cards.set(proposal, made);
      if (!known) this.root.append(made.root);
    }
    for (const [proposal, card] of before) if (!this.cards.has(proposal)) card.remove();
    const isHeld = this.root.matches(HELD) && matchMedia("(hover: hover)").matches;
    if (!isHeld) this.place(); // else they stay where a hand is about to press
  }

  /** The quickest first, of those that do not fit the nearest; those without a plan last. */
  place() {
    const rank = (/** @type {ProposalCard} */ { proposal: { cost_s: cost, number } }) =>
      cost === null ? Number.MAX_VALUE : number && cost;
    const roots = [...this.cards.values()].sort((a, b) => rank(a) - rank(b)).map(({ root }) => root);
    if (roots.some((root, index) => root !== this.root.children[index])) this.root.replaceChildren(...roots);
  }
}

class ProposalCard {
  /** @param {Store} store @param {Proposal} proposal @param {() => void} onChosen */
  constructor(store, proposal, onChosen) {
    this.store = store;
    this.proposal = proposal;
    /** @type {Promise<Layer[]>[]} the stack after so many folds */
    this.stacks = [];
    /** @type {object|null} the playing that goes on */
    this.playing = null;
    this.plan = new PointedPlan(store, proposal.plan_id);
    const { folds, layers, cost_s: cost, size_m: size, is_loose: isLoose } = proposal;
    const shown = element("span", "card-picture");
    this.stack(folds.length).then((stack) => shown.replaceChildren(layersPicture(stack, 0)), () => {});
    const without = proposal.plan_id ? say("proposal.unplanned") : say("proposal.untried");
    const robot = cost === null ? without : say("proposal.planned", { time: seconds(cost) });
    const counted = [say("import.folds", { count: folds.length }), say("proposal.layers", { count: layers })];
    if (isLoose) counted.push(say("proposal.loose"));
    const words = element(
      "span",
      "card-words",
      element("span", "suggestion-cost", robot),
      element("span", "", inWords(size)),
      element("span", "hint", counted.join(", ")),
    );
    this.root = button("card proposal-card", onChosen, shown, words);
    this.root.dataset.status = proposal.status;
    if (cost !== null) this.root.setAttribute("aria-description", say("proposal.planned_hint"));
    if (isLoose) this.root.title = say("proposal.loose_hint");
    for (const name of ["pointerenter", "focus"]) this.root.addEventListener(name, () => this.play());
    for (const name of ["pointerleave", "blur"]) this.root.addEventListener(name, () => this.leave());
  }

  /** The layers after some of the folds, bottom to top. @param {number} count @returns {Promise<Layer[]>} */
  stack(count) {
    const { garment } = this.proposal;
    const folded = { ...garment, folds: garment.folds.slice(0, count) };
    this.stacks[count] ??= fetched("../api/dag", "POST", { garment: folded }).then(({ layers }) => layers);
    return this.stacks[count];
  }

  /**
   * Show how the cloth is folded, on the board one fold after the other, with the lines of those to come, and in the 3D
   * view by the robot, or by nobody where it cannot.
   */
  async play() {
    this.plan.point();
    const own = (this.playing = {});
    const { garment } = this.proposal;
    const isStill = matchMedia("(prefers-reduced-motion: reduce)").matches;
    for (let done = isStill ? garment.folds.length : 0; done <= garment.folds.length; done += 1) {
      const layers = await this.stack(done).catch(() => []);
      if (this.playing !== own) return;
      this.store.setPreview({ garment: { ...garment, folds: garment.folds.slice(done) }, layers });
      await new Promise((resolve) => setTimeout(resolve, MOMENT_MS));
      if (this.playing !== own) return;
    }
  }

  leave() {
    this.plan.leave();
    if (!this.playing) return;
    this.playing = null;
    this.store.setPreview(null);
  }

  remove() {
    this.leave();
    this.root.remove();
  }
}

/** A size in the unit of the page. @param {[number, number]} sides (m) */
export const inWords = ([wide, long]) => `${number(wide)} × ${number(long)} ${unit.name}`;
