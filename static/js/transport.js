/** Play and pause, the slider `Time`, the speed. */

import { byId } from "./dom.js";
import { seconds } from "./words.js";

const STEP_S = 0.5;
const LEAP_S = 5;
const SEEK_EVERY_MS = 33;
const OWN_TIME_MS = 400;

export class Transport {
  /**
   * @param {import("./live.js").Live} live
   * @param {import("./clock.js").Clock} clock
   */
  constructor(live, clock) {
    this.live = live;
    this.clock = clock;
    this.button = /** @type {HTMLButtonElement} */ (byId("play"));
    this.slider = /** @type {HTMLInputElement} */ (byId("time"));
    this.speed = /** @type {HTMLSelectElement} */ (byId("speed"));
    this.shownTime = byId("clock");
    this.touchedAt = -Infinity;
    clearTimeout(this.timer);
    this.timer = undefined;
    this.button.addEventListener("click", () => this.toggle());
    this.slider.addEventListener("input", () => this.scrub(Number(this.slider.value)));
    this.slider.addEventListener("keydown", (event) => this.step(event));
    this.speed.addEventListener("change", () => live.send({ do: "speed", speed: Number(this.speed.value) }));
    clock.addEventListener("change", () => this.showState());
    clock.addEventListener("tick", () => this.showTime());
  }

  toggle() {
    if (!this.button.disabled) this.live.send({ do: this.clock.told.playing ? "pause" : "play" });
  }

  /** @param {number} t_s where the hand on the slider is; the slider follows it, not the server */
  scrub(t_s) {
    this.touchedAt = performance.now();
    this.wanted = t_s;
    clearTimeout(this.release);
    this.release = setTimeout(() => this.showTime(), OWN_TIME_MS + 1);
    if (this.timer !== undefined) return;
    this.timer = setTimeout(() => {
      this.timer = undefined;
      this.live.send({ do: "seek", t_s: this.wanted });
    }, SEEK_EVERY_MS);
  }

  /** @param {number} t_s */
  seek(t_s) {
    this.touchedAt = -Infinity;
    clearTimeout(this.timer);
    this.timer = undefined;
    this.live.send({ do: "seek", t_s });
  }

  /** @param {KeyboardEvent} event on the slider */
  step(event) {
    const now = Number(this.slider.value); // where the hand left it, also before the server has said so
    const { duration_s } = this.clock.told;
    const target = {
      ArrowLeft: now - STEP_S,
      ArrowDown: now - STEP_S,
      ArrowRight: now + STEP_S,
      ArrowUp: now + STEP_S,
      PageDown: now - LEAP_S,
      PageUp: now + LEAP_S,
      Home: 0,
      End: duration_s,
    }[event.key];
    if (target === undefined) return;
    event.preventDefault();
    const kept = Math.min(Math.max(target, 0), duration_s);
    this.slider.value = String(kept);
    this.seek(kept);
  }

  showState() {
    const { playing, duration_s, speed } = this.clock.told;
    this.button.textContent = playing ? "Pause" : "Play";
    this.button.disabled = this.slider.disabled = duration_s <= 0;
    this.slider.max = String(duration_s);
    const option = [...this.speed.options].find((candidate) => Number(candidate.value) === speed);
    if (option) this.speed.value = option.value;
  }

  showTime() {
    const now = this.clock.now;
    const isOwn = performance.now() - this.touchedAt < OWN_TIME_MS;
    if (!isOwn) this.slider.value = String(now);
    this.slider.setAttribute("aria-valuetext", seconds(now));
    this.shownTime.textContent = `${now.toFixed(1)} / ${seconds(this.clock.told.duration_s)}`;
  }
}
