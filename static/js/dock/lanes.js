/** One lane each for the base and the arms, with the slider over them and the playhead across. */

import { unit } from "../board/units.js";
import { button, element, group } from "../dom.js";
import { say } from "../language/say.js";
import { Marks } from "../rehearsal/marks.js";
import { laneBlocks, primitiveAt } from "./lane_blocks.js";
import { markStep } from "./step_menu.js";
import { armLetter, armTitle } from "../messages/arms.js";
import { place } from "../messages/names.js";
import { kindOf } from "./step_kinds.js";
import { hands, seconds, whole } from "./words.js";

/** @import { Fold, Primitive } from "pleat" */

/** Where the time axis may have its numbers: so far apart (s), and so many at most. */
const STEPS_S = [1, 2, 5, 10, 20, 30, 60, 120, 300, 600];
const TICKS_MOST = 8;

export class Lanes {
  /**
   * @param {import("../store.js").Store} store
   * @param {import("./clock.js").Clock} clock
   * @param {import("./transport.js").TimeSlider} slider
   * @param {import("./shown_plan.js").ShownPlan} shown
   * @param {import("../rehearsal/rehearsal.js").Rehearsal} rehearsal
   */
  constructor(store, clock, slider, shown, rehearsal) {
    this.store = store;
    this.clock = clock;
    this.slider = slider;
    this.told = shown;
    this.axis = element("div", "axis");
    this.axis.setAttribute("aria-hidden", "true");
    this.about = element("div", "lane-about");
    this.about.setAttribute("aria-hidden", "true");
    const heads = [element("div", "playhead"), element("div", "playhead is-ghost")];
    this.over = element("div", "lanes-over", ...heads, this.about);
    this.over.setAttribute("aria-hidden", "true");
    const time = element("div", "lanes-time", this.axis, slider.root);
    this.root = element("div", "lanes", element("span", "lane-name"), time);
    /** What is shown: plan, folds and unit. */
    this.shown = "";
    /** The primitive that is going on, -1 for none. */
    this.current = -1;
    /** How long the plan takes (s). */
    this.duration = 0;
    this.marks = new Marks((t_s) => slider.seek(t_s));
    this.root.append(this.marks.name, this.marks.lane, this.over);
    this.base = this.lane("base", "", say("lane.base"));
    /** The arms' lanes, by the arms' names. @type {Map<string, HTMLElement>} */
    this.arms = new Map();
    this.root.addEventListener("pointerdown", (event) => this.press(event));
    this.root.addEventListener("pointermove", (event) => this.hover(event));
    this.root.addEventListener("pointerleave", () => store.setHoverTime(null));
    shown.addEventListener("change", () => this.show());
    store.addEventListener("hover-time", () => this.showHover());
    store.addEventListener("document", () => this.showArms());
    clock.addEventListener("tick", () => this.tick());
    rehearsal.addEventListener("change", () => this.marks.show(rehearsal.plan ? this.plan : null, rehearsal.verdicts));
  }

  get plan() {
    return this.told.plan;
  }

  get folds() {
    return this.told.folds;
  }

  /** Have a lane for each arm of the robot, and one for its base if that drives. */
  showArms() {
    const { arms: names, base } = this.store.state?.robot ?? { arms: [], base: "omni" };
    for (const part of [this.base, this.base.previousElementSibling]) {
      if (part instanceof HTMLElement) part.hidden = base === "fixed";
    }
    if (names.join() === [...this.arms.keys()].join()) return;
    for (const lane of this.arms.values()) {
      lane.previousElementSibling?.remove();
      lane.remove();
    }
    this.arms = new Map(names.map((name) => [name, this.lane(name, armLetter(name), armTitle(name))]));
    this.shown = "";
    this.show();
  }

  show() {
    const wanted = JSON.stringify([unit.name, this.plan?.id, this.folds.map(({ name, kind }) => [name, kind])]);
    if (wanted === this.shown) return;
    this.shown = wanted;
    this.duration = this.plan?.cost_s ?? 0;
    const { base, arms } = laneBlocks(this.plan, this.folds, this.told.start, [...this.arms.keys()]);
    this.base.replaceChildren(...base.map((block) => this.block(block)));
    for (const [name, lane] of this.arms) lane.replaceChildren(...arms[name].map((block) => this.block(block)));
    this.stopAt(this.root.querySelector(".block"));
    this.current = -1; // the blocks are new
    this.axis.replaceChildren(...axisTicks(this.duration).map((t_s) => this.tickMark(t_s)));
    this.root.classList.toggle("is-empty", this.duration === 0);
    this.tick();
  }

  tick() {
    const now = this.clock.now;
    this.root.style.setProperty("--head", String(this.share(now)));
    const current = primitiveAt(this.plan, now);
    if (current === this.current) return;
    this.current = current;
    for (const block of this.root.querySelectorAll(".block")) {
      block.classList.toggle("is-current", Number(/** @type {HTMLElement} */ (block).dataset.index) === current);
    }
  }

  /** @param {string} name @param {string} letter @param {string} words */
  lane(name, letter, words) {
    const label = element("span", "lane-name", letter && element("b", "arm", letter), element("span", "", words));
    const lane = element("div", "lane");
    lane.dataset.lane = name;
    group(lane, words);
    this.marks.name.before(label, lane);
    return lane;
  }

  /** @param {import("./lane_blocks.js").Block} told */
  block(told) {
    const name = element("span", "block-name", told.name, element("span", "block-rest", ` ${told.rest}`));
    const parts = told.number ? [element("span", "block-number", told.number), name] : [name];
    const made = button("block", (event) => event.detail === 0 && this.slider.seek(told.start_s), ...parts);
    markStep(made, told.index);
    made.dataset.kind = told.kind;
    if (told.colour) made.dataset.colour = told.colour;
    made.classList.toggle("is-holding", told.isHolding);
    made.style.left = `${100 * this.share(told.start_s)}%`;
    made.style.width = `${100 * this.share(told.duration_s)}%`;
    made.setAttribute("aria-label", told.about);
    made.addEventListener("focus", () => made.matches(":focus-visible") && this.store.setHoverTime(told.start_s));
    made.addEventListener("blur", () => this.store.setHoverTime(null));
    made.addEventListener("keydown", (event) => this.walk(event, made));
    made.addEventListener("focus", () => this.stopAt(made));
    return made;
  }

  /** @param {number} t_s */
  tickMark(t_s) {
    const mark = element("span", "axis-tick", String(t_s));
    mark.style.left = `${100 * this.share(t_s)}%`;
    return mark;
  }

  /** @param {number} t_s */
  share(t_s) {
    return this.duration ? Math.min(t_s / this.duration, 1) : 0;
  }

  /** The time under the pointer (s); null beside the lanes or without a plan. @param {MouseEvent} event */
  timeAt(event) {
    const box = this.axis.getBoundingClientRect();
    const share = (event.clientX - box.left) / box.width;
    return this.duration && share >= 0 && share <= 1 ? share * this.duration : null;
  }

  /** A press goes to that time; pulled on, the time follows. @param {PointerEvent} event */
  press(event) {
    const t_s = this.timeAt(event);
    if (t_s === null || event.button !== 0 || event.target === this.slider.root) return;
    this.root.setPointerCapture(event.pointerId);
    this.slider.seek(t_s);
  }

  /** @param {PointerEvent} event */
  hover(event) {
    const t_s = this.timeAt(event);
    this.store.setHoverTime(event.pointerType === "touch" ? null : t_s);
    if (t_s !== null && this.root.hasPointerCapture(event.pointerId)) this.slider.scrub(t_s);
  }

  showHover() {
    const { hoverTime } = this.store;
    this.root.classList.toggle("has-hover", hoverTime !== null && this.duration > 0);
    if (hoverTime === null) return;
    const share = this.share(hoverTime);
    this.root.style.setProperty("--hover", String(share));
    this.about.classList.toggle("is-left", share > 0.5);
    const primitive = this.plan?.primitives[primitiveAt(this.plan, hoverTime)];
    this.about.replaceChildren(
      element("b", "", seconds(hoverTime)),
      ` ${primitive ? doing(primitive, this.folds) : ""}`,
    );
  }

  /** Tab stops at one block, the arrows lead on. @param {Element|null} stop */
  stopAt(stop) {
    /** @type {NodeListOf<HTMLElement>} */
    const blocks = this.root.querySelectorAll(".block");
    for (const block of blocks) block.tabIndex = block === stop ? 0 : -1;
  }

  /**
   * Arrows go from block to block along a lane and from lane to lane.
   * @param {KeyboardEvent} event
   * @param {HTMLElement} made
   */
  walk(event, made) {
    const lanes = [this.base, ...this.arms.values()].filter((lane) => lane.children.length);
    const lane = lanes.findIndex((one) => one === made.parentElement);
    const { previousElementSibling: before, nextElementSibling: after } = made;
    /** @type {Record<string, Element|null>} */
    const along = { ArrowLeft: before, ArrowRight: after };
    /** @type {Record<string, HTMLElement|undefined>} */
    const across = { ArrowUp: lanes[lane - 1], ArrowDown: lanes[lane + 1] };
    const other = across[event.key];
    const target = along[event.key] ?? (other && nearest(other, made));
    if (!(target instanceof HTMLElement)) return;
    event.preventDefault();
    target.focus();
  }
}

/** A primitive in a line: what, by which hands, from where. @param {Primitive} primitive @param {Fold[]} folds */
function doing(primitive, folds) {
  const at = kindOf(primitive).moves === "base" ? "" : place(primitive.base.station);
  return [whole(primitive, folds), hands(primitive), at].filter(Boolean).join(", ");
}

/** The block of a lane that begins closest to another block. @param {HTMLElement} lane @param {HTMLElement} made */
function nearest(lane, made) {
  /** @param {HTMLElement} block */
  const gap = (block) => Math.abs(parseFloat(block.style.left) - parseFloat(made.style.left));
  const blocks = /** @type {HTMLElement[]} */ ([...lane.children]);
  return blocks.reduce((best, block) => (gap(block) < gap(best) ? block : best));
}

/** @param {number} duration_s @returns {number[]} round times from 0, at most so many */
export function axisTicks(duration_s) {
  if (duration_s <= 0) return [];
  const step = STEPS_S.find((candidate) => duration_s / candidate <= TICKS_MOST) ?? Math.ceil(duration_s / TICKS_MOST);
  return Array.from({ length: Math.floor(duration_s / step) + 1 }, (_, index) => index * step);
}
