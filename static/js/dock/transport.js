/** Play and pause, from primitive to primitive, the speed, and what is going on. */

import { button, element } from "../dom.js";
import { isTyping } from "../keys.js";
import { numeral } from "../language/numeral.js";
import { say } from "../language/say.js";
import { iconButton, relabel } from "./buttons.js";
import { icon } from "./icons.js";
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
   * @param {import("./time_slider.js").TimeSlider} slider
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
      this.play.replaceChildren(icon(playing ? "pause" : "play"), element("span", "", name));
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
