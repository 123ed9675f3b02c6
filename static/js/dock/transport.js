/** Play and pause, from primitive to primitive, the speed, and what is going on. */

import { button, element, input } from "../dom.js";
import { smallIcon } from "../icons.js";
import { isTyping } from "../keys.js";
import { numeral } from "../language/numeral.js";
import { say } from "../language/say.js";
import { iconButton, relabel } from "./buttons.js";
import { primitiveAt } from "./lane_blocks.js";
import { hands, seconds, whole } from "./words.js";

const SPEEDS = [0.25, 0.5, 1, 2, 4, 8];
/** So soon after its start (s), "previous" leads to the primitive before. */
const JUST_BEGUN_S = 0.5;
const INSTANT_S = 1e-6;

export class Transport {
  /**
   * @param {import("../store.js").Store} store
   * @param {import("./clock.js").Clock} clock
   * @param {TimeSlider} slider
   * @param {import("./shown_plan.js").ShownPlan} shown
   */
  constructor(store, clock, slider, shown) {
    this.store = store;
    this.clock = clock;
    this.slider = slider;
    this.shown = shown;
    /** What the button is called as it is shown. */
    this.shownName = "";
    this.play = button("main-button play", () => this.toggle());
    this.previous = iconButton("previous", say("play.previous"), () => this.step(-1));
    this.next = iconButton("next", say("play.next"), () => this.step(1));
    this.previous.title += " (,)";
    this.next.title += " (.)";
    this.time = element("span", "clock");
    this.now = element("span", "now");
    this.speed = /** @type {HTMLSelectElement} */ (element("select", "speed"));
    this.speed.append(...SPEEDS.map((speed) => new Option(`${speed}\u00D7`, String(speed))));
    this.speed.setAttribute("aria-label", say("play.speed"));
    this.speed.addEventListener("change", () => store.command({ do: "speed", speed: Number(this.speed.value) }));
    const buttons = element("span", "transport-buttons", this.previous, this.play, this.next);
    this.root = element("header", "dock-head transport", buttons, this.time, this.now, this.speed);
    clock.addEventListener("change", () => this.showState());
    store.addEventListener("connection", () => this.showState());
    clock.addEventListener("tick", () => this.showTime());
    addEventListener("unit", () => this.showTime());
    document.addEventListener("keydown", (event) => this.onKey(event));
    this.showState();
  }

  get primitives() {
    return this.shown.plan?.primitives ?? [];
  }

  toggle() {
    this.store.command({ do: this.clock.told.playing ? "pause" : "play" });
  }

  /** @param {1|-1} way to the next primitive's start (or the end), or back */
  step(way) {
    const now = this.slider.time;
    const starts = this.primitives.map((primitive) => primitive.start_s);
    const after = starts.find((start) => start > now + INSTANT_S) ?? this.clock.told.duration_s;
    const before = starts.findLast((start) => start < now - JUST_BEGUN_S) ?? 0;
    this.slider.seek(way > 0 ? after : before);
  }

  /** @param {KeyboardEvent} event the comma and the full stop step, as in editors of films */
  onKey(event) {
    if (event.defaultPrevented || isTyping(event.target) || event.ctrlKey || event.metaKey || event.altKey) return;
    const way = event.key === "," ? -1 : event.key === "." ? 1 : 0;
    if (!way || this.next.disabled || document.querySelector("dialog[open]")) return;
    event.preventDefault();
    this.step(way);
  }

  showState() {
    const { playing, duration_s: duration, speed } = this.clock.told;
    const name = playing ? say("play.pause") : say("play.play");
    if (this.shownName !== name) {
      this.play.replaceChildren(smallIcon(playing ? "pause" : "play"), element("span", "", name));
      relabel(this.play, name);
      this.play.title = say("play.with_key", { what: name });
      this.shownName = name;
    }
    const canPlay = duration > 0 && this.store.isLive;
    for (const part of [this.play, this.previous, this.next]) part.disabled = !canPlay;
    if (SPEEDS.includes(speed)) this.speed.value = String(speed);
  }

  showTime() {
    const now = this.clock.now;
    const text = `${numeral(now, 1)} / ${seconds(this.clock.told.duration_s)}`;
    if (this.time.textContent !== text) this.time.textContent = text;
    const primitive = this.primitives[primitiveAt(this.shown.plan, now)];
    const doing = primitive ? [whole(primitive, this.shown.folds), hands(primitive)] : [];
    const told = doing.filter(Boolean).join(", ");
    if (this.now.textContent !== told) this.now.textContent = this.now.title = told;
  }
}

const STEP_S = 0.5;
const LEAP_S = 5;
const SEEK_EVERY_MS = 33;
const OWN_TIME_MS = 400;

/** The slider `Time`. It follows the hand at once and the server otherwise. */
export class TimeSlider {
  /** @param {import("../store.js").Store} store @param {import("./clock.js").Clock} clock */
  constructor(store, clock) {
    this.store = store;
    this.clock = clock;
    const range = { type: "range", min: "0", max: "0", step: "any", value: "0", disabled: true };
    this.root = input("time-slider", { id: "time", ...range, ariaLabel: say("time.label") });
    this.touchedAt = -Infinity;
    /** Where the hand was last (s). */
    this.wanted = 0;
    this.root.addEventListener("input", () => this.scrub(Number(this.root.value)));
    this.root.addEventListener("keydown", (event) => this.step(event));
    clock.addEventListener("change", () => this.showState());
    store.addEventListener("connection", () => this.showState());
    clock.addEventListener("tick", () => this.showTime());
  }

  /** Where the hand left it, also before the server has said so (s). */
  get time() {
    return this.isOwn ? Number(this.root.value) : this.clock.now;
  }

  get isOwn() {
    return performance.now() - this.touchedAt < OWN_TIME_MS;
  }

  /** @param {number} t_s where the hand on the slider is */
  scrub(t_s) {
    this.touch();
    this.wanted = t_s;
    if (this.timer !== undefined) return;
    this.timer = setTimeout(() => {
      this.timer = undefined;
      this.store.command({ do: "seek", t_s: this.wanted });
    }, SEEK_EVERY_MS);
  }

  /** @param {number} t_s go there at once; kept within the plan */
  seek(t_s) {
    const kept = Math.min(Math.max(t_s, 0), this.clock.told.duration_s);
    clearTimeout(this.timer);
    this.timer = undefined;
    this.root.value = String(kept);
    this.touch();
    this.store.command({ do: "seek", t_s: kept });
  }

  touch() {
    this.touchedAt = performance.now();
    clearTimeout(this.release);
    this.release = setTimeout(() => this.showTime(), OWN_TIME_MS + 1);
  }

  /** @param {KeyboardEvent} event */
  step(event) {
    /** @type {Record<string, number>} */
    const targets = {
      ArrowLeft: this.time - STEP_S,
      ArrowDown: this.time - STEP_S,
      ArrowRight: this.time + STEP_S,
      ArrowUp: this.time + STEP_S,
      PageDown: this.time - LEAP_S,
      PageUp: this.time + LEAP_S,
      Home: 0,
      End: this.clock.told.duration_s,
    };
    const target = targets[event.key];
    if (target === undefined) return;
    event.preventDefault();
    this.seek(target);
  }

  showState() {
    const { duration_s: duration } = this.clock.told;
    this.root.disabled = duration <= 0 || !this.store.isLive;
    this.root.max = String(duration);
  }

  showTime() {
    if (!this.isOwn || this.clock.told.playing) this.root.value = String(this.clock.now);
    const told = seconds(this.time);
    if (this.root.getAttribute("aria-valuetext") !== told) this.root.setAttribute("aria-valuetext", told);
  }
}
