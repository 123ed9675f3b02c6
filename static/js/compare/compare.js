/** The dialog `Compare`: two versions of the document side by side, with one play button and one clock for both. */

import { svg } from "../board/sheet.js";
import { openDialog, OFFLINE } from "../dialogs/dialog.js";
import { icon } from "../dock/icons.js";
import { primitiveAt } from "../dock/lane_blocks.js";
import { briefly, seconds } from "../dock/words.js";
import { button, element, sayable } from "../dom.js";
import { when } from "../gallery/tile.js";
import { numeral } from "../language/numeral.js";
import { say, translated } from "../language/say.js";
import { aligned } from "./aligned.js";
import { comparedPlan } from "./compared_plan.js";
import { drawScene } from "./scene_picture.js";
import { SharedClock } from "./shared_clock.js";

/** @import { DocumentVersion, Drawing, Primitive } from "pleat" */
/** @import { Compared } from "./compared_plan.js" */

/** @typedef {{name: string, drawing: Drawing, plan: string|null}} Choice */

const SAME_S = 0.05;

/** @param {import("../store.js").Store} store */
export async function showCompare(store) {
  const { state, plan } = store;
  if (!state) return;
  const said = element("p", "dialog-text", say("compare.about"));
  const dialog = openDialog(say("compare.title"), "is-wide compare", said);
  const answer = await fetch(`../api/documents/${store.id}/versions`).catch(() => null);
  /** @type {DocumentVersion[]} */
  const versions = answer?.ok ? await answer.json() : [];
  if (!answer?.ok) said.textContent = OFFLINE;
  const isCurrent = plan?.version === state.version && !plan.plan?.is_stale;
  const now = { name: say("compare.now"), drawing: state.drawing, plan: (isCurrent && plan.plan?.id) || null };
  const before = versions.map(({ label, changed_at: at, drawing }) => {
    const title = translated(label) || say("versions.first");
    return { name: [title, when(at)].filter(Boolean).join(", "), drawing, plan: null };
  });
  if (!before.length) said.textContent = say("compare.only_one");
  const comparison = new Comparison([now, ...before]);
  dialog.append(comparison.root);
  dialog.addEventListener("close", () => comparison.end());
}

/** One side: what is chosen, its picture and what its plan takes. */
class Side {
  /** @param {Choice[]} choices @param {number} chosen @param {string} name @param {() => void} onChange */
  constructor(choices, chosen, name, onChange) {
    this.choices = choices;
    this.onChange = onChange;
    /** @type {Compared|null} */
    this.compared = null;
    this.asked = new AbortController();
    this.select = /** @type {HTMLSelectElement} */ (element("select", "field"));
    this.select.setAttribute("aria-label", name);
    this.select.append(...choices.map((choice, index) => new Option(choice.name, String(index))));
    this.select.value = String(chosen);
    this.select.addEventListener("change", () => this.load());
    this.picture = svg("svg", { class: "compare-picture", role: "img" });
    this.cost = element("p", "compare-cost");
    this.root = element("section", "compare-side", this.select, this.picture, this.cost);
  }

  async load() {
    this.asked.abort();
    const asked = (this.asked = new AbortController());
    this.compared = null;
    this.cost.textContent = say("status.planning");
    this.onChange();
    const { drawing, plan } = this.choices[Number(this.select.value)];
    try {
      this.compared = await comparedPlan(drawing, plan, asked.signal);
    } catch (error) {
      if (asked.signal.aborted) return;
      this.compared = { drawing, plan: null, pictures: [], problem: sayable(error) };
    }
    if (asked.signal.aborted) return;
    const { plan: found, problem } = this.compared;
    const steps = found?.primitives.length ?? 0;
    this.cost.textContent = found ? say("compare.cost", { count: steps, time: seconds(this.end_s) }) : problem;
    this.onChange();
  }

  get end_s() {
    return this.compared?.plan?.cost_s ?? 0;
  }

  /** @param {number} t_s */
  draw(t_s) {
    const { compared } = this;
    if (!compared) return;
    drawScene(this.picture, compared, t_s);
    const step = compared.plan?.primitives[primitiveAt(compared.plan, t_s)];
    this.picture.setAttribute("aria-label", step ? briefly(step, compared.drawing.folds) : say("compare.no_plan"));
  }
}

class Comparison {
  /** @param {Choice[]} choices */
  constructor(choices) {
    this.clock = new SharedClock();
    this.sides = [1, 0].map((chosen, index) => {
      const name = say(index ? "compare.right" : "compare.left");
      return new Side(choices, Math.min(chosen, choices.length - 1), name, () => this.show());
    });
    this.play = button("main-button", () => this.clock.toggle());
    this.slider = /** @type {HTMLInputElement} */ (element("input", "compare-slider"));
    Object.assign(this.slider, { type: "range", min: "0", step: "0.1" });
    this.slider.setAttribute("aria-label", say("time.label"));
    this.slider.addEventListener("input", () => this.clock.go(Number(this.slider.value)));
    this.time = element("span", "compare-time");
    this.steps = element("table", "compare-steps");
    const bar = element("div", "compare-bar", this.play, this.slider, this.time);
    const sides = element("div", "compare-sides", ...this.sides.map(({ root }) => root));
    this.root = element("div", "compare-body", sides, bar, this.steps);
    /** @type {{row: HTMLElement, steps: (Primitive|null)[]}[]} */
    this.rows = [];
    this.clock.addEventListener("tick", () => this.tick());
    for (const side of this.sides) side.load();
  }

  /** The sides have changed: how far the clock goes, and the rows. */
  show() {
    if (!this.root) return;
    this.clock.reach(Math.max(...this.sides.map(({ end_s }) => end_s)));
    const [left, right] = this.sides.map(({ compared }) => compared);
    this.rows = left && right ? aligned(left, right).map((steps) => ({ steps, row: this.row(steps, left, right) })) : [];
    const heads = ["compare.left", "compare.right", "compare.difference"].map((key) =>
      element("th", "", say(/** @type {"compare.left"} */ (key))),
    );
    const [a, b] = this.sides.map(({ end_s }) => end_s);
    const sum = element("tr", "compare-sum", ...[a, b].map((cost) => element("td", "", cost ? seconds(cost) : "")));
    sum.append(element("td", "", a && b ? difference(b - a) : ""));
    this.steps.replaceChildren(
      element("thead", "", element("tr", "", ...heads)),
      element("tbody", "", ...this.rows.map(({ row }) => row), sum),
    );
    this.tick();
  }

  /** @param {(Primitive|null)[]} steps @param {Compared} left @param {Compared} right */
  row(steps, left, right) {
    const [one, other] = steps;
    const cells = steps.map((step, side) => {
      const { folds } = (side ? right : left).drawing;
      const cell = element("td", step ? "" : "is-missing");
      if (!step) return cell;
      const go = button("compare-step", () => this.clock.go(step.start_s), briefly(step, folds), " ");
      go.append(element("span", "compare-takes", seconds(step.duration_s)));
      cell.append(go);
      return cell;
    });
    const by = one && other ? other.duration_s - one.duration_s : (other?.duration_s ?? 0) - (one?.duration_s ?? 0);
    return element("tr", "", ...cells, element("td", "compare-by", difference(by)));
  }

  tick() {
    const { t_s, end_s, isRunning } = this.clock;
    for (const side of this.sides) side.draw(t_s);
    this.slider.max = String(end_s);
    this.slider.value = String(t_s);
    this.slider.disabled = end_s <= 0;
    this.play.disabled = end_s <= 0;
    this.play.replaceChildren(icon(isRunning ? "pause" : "play"), `${say(isRunning ? "play.pause" : "play.play")}`);
    this.time.textContent = `${numeral(t_s, 1)} / ${seconds(end_s)}`;
    for (const { row, steps } of this.rows) {
      steps.forEach((step, side) => {
        const isNow = Boolean(step && t_s >= step.start_s && t_s < step.start_s + step.duration_s);
        row.children[side].classList.toggle("is-now", isNow);
      });
    }
  }

  end() {
    this.clock.stop();
    for (const side of this.sides) side.asked.abort();
  }
}

/** How much longer the right one takes. @param {number} by seconds */
const difference = (by) => (Math.abs(by) < SAME_S ? "=" : `${by > 0 ? "+" : "\u2212"}${seconds(Math.abs(by))}`);
