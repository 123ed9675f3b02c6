/** The button `Rehearse` and what is said below it: how far the rehearsal is, whether the plan holds, all runs in small. */

import { button, element, group, progressBar, toldAloud } from "../dom.js";
import { numeral } from "../language/numeral.js";
import { say } from "../language/say.js";
import { fateInAWord, summary, worstOf } from "./words.js";

/** @import { Asked, Result, Run } from "./rehearsal.js" */

const ONCE = /** @type {Asked} */ ({ runs: 1, noise: "none" });
const OFTEN = /** @type {Asked} */ ({ runs: 10, noise: "real" });

export class Rehearsing {
  /** @param {import("./rehearsal.js").Rehearsal} rehearsal */
  constructor(rehearsal) {
    this.rehearsal = rehearsal;
    this.button = button("chip for-editors", () => rehearsal.begin(ONCE), say("rehearsal.do"));
    this.button.title = say("rehearsal.hint");
    this.bar = progressBar(say("rehearsal.progress"));
    this.note = toldAloud("hint");
    this.often = button("quiet", () => rehearsal.begin(OFTEN), say("rehearsal.often"));
    this.often.title = say("rehearsal.often_hint");
    this.end = button("quiet", () => rehearsal.close(), say("search.stop"));
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
    this.end.textContent = isRunning ? say("search.stop") : say("dialog.close");
  }

  /** @param {string} sentence */
  say(sentence) {
    if (this.note.textContent !== sentence) this.note.textContent = sentence;
  }
}

const BIN_MM = 5;
const LAST_MM = 40;

/** Many runs in small: a square for each, above how far the cloth was off after the worst step; one is looked at. */
class Histogram {
  /** @param {(run: number) => void} onChosen */
  constructor(onChosen) {
    this.onChosen = onChosen;
    this.columns = element("div", "runs-columns");
    group(this.columns, say("rehearsal.runs"));
    this.about = element("p", "hint");
    this.root = element("div", "runs", this.columns, this.about);
    /** @type {Result|null} */
    this.shown = null;
    /** @type {HTMLButtonElement[]} by the run */
    this.squares = [];
  }

  /** @param {Result|null} result @param {number} chosen the run that is looked at */
  show(result, chosen) {
    this.root.hidden = !result || result.of < 2;
    if (!result || this.root.hidden) return;
    if (result !== this.shown) this.draw(result);
    this.squares.forEach((square, run) => square.setAttribute("aria-pressed", String(run === chosen)));
    this.about.textContent = told(result.runs[chosen], chosen);
  }

  /** @param {Result} result */
  draw(result) {
    this.shown = result;
    this.squares = result.runs.map((run, index) => this.square(run, index));
    const bins = result.runs.map(binOf);
    const last = LAST_MM / BIN_MM;
    const names = Array.from({ length: last + 1 }, (_, bin) => numeral(bin * BIN_MM, 0));
    names[last] += "+";
    const all = bins.includes(-1) ? [...names.keys(), -1] : [...names.keys()];
    this.columns.replaceChildren(
      ...all.map((bin) => {
        const stack = this.squares.filter((_, run) => bins[run] === bin);
        const name = element("span", "runs-name", bin < 0 ? say("rehearsal.ended_early") : bin % 2 ? "" : names[bin]);
        return element("div", bin < 0 ? "runs-column is-early" : "runs-column", ...stack, name);
      }),
    );
  }

  /** @param {Run} run @param {number} index */
  square(run, index) {
    const made = button("runs-square", () => this.onChosen(index));
    made.dataset.isHeld = String(run.held);
    made.title = told(run, index);
    made.setAttribute("aria-label", made.title);
    return made;
  }
}

/** The column of a run; -1 for one that ended early though no step was lost. @param {Run} run */
function binOf(run) {
  if (!run.held && run.steps.every(({ held }) => held)) return -1;
  return Math.min(Math.floor(worstOf(run) / BIN_MM), LAST_MM / BIN_MM);
}

/** @param {Run} run @param {number} index */
const told = (run, index) =>
  say("rehearsal.run", { run: index + 1, fate: fateInAWord(run), length: worstOf(run).toFixed(0) });
