/** The button `Rehearse` and what is said below it: how far the rehearsal is, whether the plan holds, all runs in small. */

import { button, element } from "../dom.js";
import { say } from "../language/say.js";
import { Histogram } from "./histogram.js";
import { summary } from "./words.js";

/** @import { Asked } from "./rehearsal.js" */

const ONCE = /** @type {Asked} */ ({ runs: 1, noise: "none" });
const OFTEN = /** @type {Asked} */ ({ runs: 10, noise: "real" });

export class Rehearsing {
  /** @param {import("./rehearsal.js").Rehearsal} rehearsal */
  constructor(rehearsal) {
    this.rehearsal = rehearsal;
    this.button = button("chip", () => rehearsal.begin(ONCE), say("rehearsal.do"));
    this.button.title = say("rehearsal.hint");
    this.bar = /** @type {HTMLProgressElement} */ (element("progress", "job-progress"));
    this.bar.setAttribute("aria-label", say("rehearsal.progress"));
    this.note = element("p", "hint");
    this.note.setAttribute("role", "status");
    this.often = button("quiet", () => rehearsal.begin(OFTEN), say("rehearsal.often"));
    this.often.title = say("rehearsal.often_hint");
    this.end = button("quiet", () => rehearsal.close(), say("jobs.cancel"));
    this.histogram = new Histogram((run) => rehearsal.choose(run));
    this.root = element("div", "rehearsing", this.note, this.bar, this.histogram.root, this.often, this.end);
    rehearsal.addEventListener("change", () => this.show());
    this.show();
  }

  show() {
    const { plan, isRunning, progress, result, fault, chosen } = this.rehearsal;
    this.root.hidden = plan === null;
    this.button.hidden = !this.rehearsal.rehearsable;
    this.button.disabled = isRunning;
    this.say(isRunning ? say("rehearsal.running") : result ? summary(result) : fault);
    this.note.classList.toggle("is-lost", Boolean(result) && !this.rehearsal.isHeld);
    this.bar.hidden = !isRunning;
    if (progress === null) this.bar.removeAttribute("value");
    else this.bar.value = progress;
    this.histogram.show(result, chosen);
    this.often.hidden = isRunning;
    this.end.textContent = isRunning ? say("jobs.cancel") : say("dialog.close");
  }

  /** @param {string} sentence */
  say(sentence) {
    if (this.note.textContent !== sentence) this.note.textContent = sentence;
  }
}
