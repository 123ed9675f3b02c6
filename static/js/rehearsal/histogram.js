/** Many runs in small: a square for each, above how far the cloth was off after the worst step; one is looked at. */

import { button, element } from "../dom.js";
import { numeral } from "../language/numeral.js";
import { say } from "../language/say.js";
import { fateInAWord, worstOf } from "./words.js";

/** @import { Result, Run } from "./rehearsal.js" */

const BIN_MM = 5;
const LAST_MM = 40;

export class Histogram {
  /** @param {(run: number) => void} onChosen */
  constructor(onChosen) {
    this.onChosen = onChosen;
    this.columns = element("div", "runs-columns");
    this.columns.setAttribute("role", "group");
    this.columns.setAttribute("aria-label", say("rehearsal.runs"));
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
