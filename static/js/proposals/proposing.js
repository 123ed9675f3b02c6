/**
 * `Fold it for me`: ways to fold the garment to a size, in the dock's place as long as the tool for that is in hand.
 * They are looked for while the drawing rests; what changes the garment, the robot or the size begins anew.
 */

import { insertFold } from "../board/edits.js";
import { freshId } from "../board/ids.js";
import { number, parsed, unit } from "../board/units.js";
import { toggle } from "../dock/buttons.js";
import { request } from "../dock/suggestion_search.js";
import { button, element, field, group, progressBar, toldAloud } from "../dom.js";
import { icon } from "../icons.js";
import { inEnglish, say } from "../language/say.js";
import { inWords, ProposalCards } from "./cards.js";
import { LikePicker } from "./like_picker.js";
import { ProposalSearch } from "./proposal_search.js";
import { extentOf, isLike, isWithin, PRESETS } from "./target.js";

/** @import { Garment } from "pleat" */
/** @import { Proposal } from "./proposal_search.js" */
/** @import { PresetName } from "./target.js" */

/** How long the drawing and the size rest before ways are looked for (ms). */
const REST_MS = 300;
const COUNT = 6;
/** So many ways are on show before they are planned. */
const UNTRIED_COUNT = 3;
const STEP_M = 0.01;

export class Proposing {
  /** @param {import("../store.js").Store} store @param {import("../board/board.js").Board} board */
  constructor(store, board) {
    this.store = store;
    this.board = board;
    this.tool = board.tools.propose;
    this.search = new ProposalSearch();
    /** What is looked for, as text; empty for nothing. */
    this.asked = "";
    this.keepsFolds = false;
    this.cards = new ProposalCards(store, (proposal) => this.apply(proposal));
    this.presets = PRESETS.map((name) => ({ name, made: this.preset(name) }));
    this.fields = [this.field(0, say("proposal.width")), this.field(1, say("proposal.length"))];
    this.like = new LikePicker(store, (like) => this.tool.set(like));
    this.unit = element("span", "");
    const [wide, long] = this.fields;
    const size = element("span", "proposal-size", wide, "×", long, this.unit);
    this.keep = toggle(say("proposal.keep"), (isOn) => {
      this.keepsFolds = isOn;
      this.draw();
    });
    this.keep.title = say("proposal.keep_hint");
    this.note = toldAloud("hint");
    this.bar = progressBar(say("proposal.progress"));
    this.stop = button("chip", () => this.search.stop(), say("search.stop"));
    const close = button("icon-button is-small", () => board.choose("select"), icon("close"));
    close.setAttribute("aria-label", say("dialog.close"));
    const chips = element("div", "proposal-chips", ...this.presets.map(({ made }) => made), size, this.like.root, this.keep);
    group(chips, say("proposal.sizes"));
    const head = element("header", "proposal-head", element("h2", "", say("proposal.do")), chips, close);
    const wait = element("div", "proposal-wait", this.note, this.bar, this.stop);
    this.root = element("section", "proposing", head, wait, this.cards.root);
    this.root.setAttribute("aria-label", say("proposal.do"));
    this.root.hidden = true;
    this.offer = button("main-button proposal-offer", () => store.tell("propose"), say("proposal.do"));
    this.offer.title = say("proposal.hint");
    this.offer.hidden = true;
    board.root.append(this.offer);
    document.body.append(this.root);
    this.search.addEventListener("change", () => this.showFound());
    store.addEventListener("document", () => this.follow());
    store.addEventListener("propose", () => board.choose("propose"));
    addEventListener("unit", () => this.draw());
  }

  /** @param {PresetName} name */
  preset(name) {
    const made = button("chip", () => this.tool.set(name), say(`proposal.to.${name}`));
    made.dataset.to = name;
    return made;
  }

  /** A field for a side; arrow keys make it longer or shorter. @param {0|1} axis @param {string} name */
  field(axis, name) {
    const made = field({ inputMode: "decimal", ariaLabel: name });
    /** @param {number|null} metres */
    const put = (metres) => {
      const [wide, long] = this.tool.sides ?? [metres ?? 0, metres ?? 0];
      if (metres !== null) this.tool.set(axis ? [wide, metres] : [metres, long]);
      else this.showSize();
    };
    made.addEventListener("change", () => put(parsed(made.value)));
    made.addEventListener("keydown", (event) => {
      if (event.key === "Escape") this.board.choose("select");
      const by = { ArrowUp: STEP_M, ArrowDown: -STEP_M }[event.key];
      const { sides } = this.tool;
      if (!by || !sides) return;
      event.preventDefault();
      put(sides[axis] + by);
      this.showSize();
    });
    return made;
  }

  get isOpen() {
    return this.board.tool === this.tool;
  }

  /** Whether the drawing is a garment that can be folded. */
  get isGarment() {
    return this.board.drawing.outline.length > 2 && !this.board.tools.outline.isBusy;
  }

  /** With each picture of the board: the panel is there as long as the tool is in hand. */
  draw() {
    const { isOpen, board } = this;
    this.offer.hidden = board.tool.name !== "select" || !this.isGarment || board.drawing.folds.length > 0;
    if (this.root.hidden === isOpen) this.turn(isOpen);
    if (!isOpen) return;
    for (const { name, made } of this.presets) made.setAttribute("aria-pressed", String(name === this.tool.to));
    this.like.show(isLike(this.tool.to));
    this.keep.hidden = !board.drawing.folds.length;
    this.keep.setAttribute("aria-pressed", String(this.keepsFolds));
    if (!this.fields.some((field) => field === document.activeElement)) this.showSize();
    this.follow();
  }

  showSize() {
    const { sides } = this.tool;
    this.fields.forEach((field, axis) => (field.value = sides ? number(sides[axis]) : ""));
    this.unit.textContent = unit.name;
  }

  /** @param {boolean} isOpen */
  turn(isOpen) {
    this.root.hidden = !isOpen;
    document.body.classList.toggle("is-proposing", isOpen);
    if (isOpen) this.like.offer();
    if (isOpen) this.presets.find(({ name }) => name === this.tool.to)?.made.focus({ preventScroll: true });
    else this.end();
  }

  /** Look for nothing any more. */
  end() {
    this.asked = "";
    this.search.forget();
    this.search.tell();
  }

  /** The request for what is to be folded now; null while it is being changed. */
  wanted() {
    const { state } = this.store;
    if (!state || !this.isOpen || !this.isGarment || state.gesture || this.tool.isBusy) return null;
    const wanted = request(state);
    const garment = this.keepsFolds ? wanted.garment : { ...wanted.garment, folds: [] };
    return { ...wanted, garment, to: this.tool.asked, count: COUNT, untried: UNTRIED_COUNT };
  }

  /** Look for what is wanted now, unless that is done already. */
  follow() {
    const wanted = this.wanted();
    const asked = wanted ? JSON.stringify(wanted) : "";
    if (asked === this.asked) return;
    this.end();
    this.asked = asked;
    if (wanted && !this.isSmall) this.search.start(wanted, REST_MS);
  }

  /** Whether the garment fits as it is drawn. */
  get isSmall() {
    const { sides } = this.tool;
    return sides !== null && !this.keepsFolds && isWithin(extentOf(this.board.drawing), sides);
  }

  /** Show what was found, and what is said about it. */
  showFound() {
    const { found, shown, isRunning } = this.search;
    this.cards.show(shown);
    const said = this.said();
    if (this.note.textContent !== said) this.note.textContent = said;
    this.bar.hidden = this.stop.hidden = !isRunning;
    if (found.length) this.bar.value = this.search.progress;
    else this.bar.removeAttribute("value");
  }

  /** What is said beside the cards. */
  said() {
    const { found, near, shown, other, isRunning, isDone, isUnable, fault } = this.search;
    const { sides } = this.tool;
    if (fault) return say("search.fault", { fault });
    if (this.isSmall) return say("proposal.fits");
    if (isUnable) {
      const count = found.length;
      const robot = this.store.state?.robot.title ?? "";
      const then = near.length ? say("proposal.nearest_first") : other && say("proposal.other", { robot: other });
      return say("proposal.unable", { robot, count, then });
    }
    const count = found.filter(({ cost_s: cost }) => cost !== null).length;
    if (count) return say("proposal.found", { count });
    if (isDone && isLike(this.tool.to)) return say("proposal.unlike");
    if (sides && shown.length && !shown.some(({ size_m: size }) => isWithin(size, sides)))
      return say("proposal.nothing", { size: inWords(sides), then: say("proposal.nearest") });
    if (sides && isDone) return say("proposal.nothing", { size: inWords(sides), then: "" });
    return isRunning ? say("proposal.looking") : isDone ? say("proposal.none") : "";
  }

  /** Its folds become the drawing's, as one step, unless this has changed since. @param {Proposal} proposal */
  apply({ garment }) {
    const wanted = this.wanted();
    if (!wanted || JSON.stringify(wanted) !== this.asked) return;
    const version = this.store.state?.version;
    const kept = this.keepsFolds ? wanted.garment.folds.length : 0;
    this.store.edit(inEnglish("step.propose"), (drawing) => {
      if (this.store.state?.version === version) takeFolds(drawing, garment, kept);
    });
    this.board.choose("select");
  }
}

/**
 * @param {import("pleat").Drawing} drawing is altered
 * @param {Garment} garment with the folds that are taken
 * @param {number} kept so many of them are those of the drawing
 */
function takeFolds(drawing, garment, kept) {
  const taken = [...drawing.folds];
  drawing.folds = drawing.folds.slice(0, kept);
  for (const { name, kind, start, end, grip_radius_m: grip } of garment.folds.slice(kept)) {
    const id = freshId("f", [...taken, ...drawing.folds]);
    const ends = { start: { point: start, on: null }, end: { point: end, on: null } };
    insertFold(drawing, drawing.folds.length, {
      id,
      name,
      kind,
      ...ends,
      grip_radius_m: grip === garment.grip_radius_m ? null : grip,
    });
  }
}
