/** The slider `Time`. It follows the hand at once and the server otherwise. */

import { element } from "../dom.js";
import { say } from "../language/say.js";
import { seconds } from "./words.js";

const STEP_S = 0.5;
const LEAP_S = 5;
const SEEK_EVERY_MS = 33;
const OWN_TIME_MS = 400;

export class TimeSlider {
  /**
   * @param {import("../store.js").Store} store
   * @param {import("./clock.js").Clock} clock
   */
  constructor(store, clock) {
    this.store = store;
    this.clock = clock;
    this.root = /** @type {HTMLInputElement} */ (element("input", "time-slider"));
    Object.assign(this.root, { id: "time", type: "range", min: "0", max: "0", step: "any", value: "0" });
    this.root.disabled = true;
    this.root.setAttribute("aria-label", say("time.label"));
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
