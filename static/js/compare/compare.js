/** The dialog `Compare`: two plans side by side, with one play button and one clock for both. */

import { openDialog } from "../dialogs/dialog.js";
import { briefly, seconds } from "../dock/words.js";
import { button, element, input, sayable } from "../dom.js";
import { smallIcon } from "../icons.js";
import { numeral } from "../language/numeral.js";
import { say } from "../language/say.js";
import { documentsBeside, versionsOf } from "./choices.js";
import { extentOf } from "./scene_picture.js";
import { Side } from "./side.js";

/** @import { Choice } from "./choices.js" */
/** @import { Compared } from "./compared_plan.js" */
/** @import { Primitive } from "pleat" */

const SAME_S = 0.05;

/** @param {import("../store.js").Store} store */
export async function showCompare(store) {
  if (!store.state) return;
  const said = element("p", "dialog-text", say("compare.about"));
  const dialog = openDialog(say("compare.title"), "is-wide compare", said);
  try {
    const [versions, documents] = await Promise.all([versionsOf(store), documentsBeside(store.id)]);
    const comparison = new Comparison([...versions, ...documents]);
    dialog.append(comparison.root);
    dialog.addEventListener("close", () => comparison.end());
  } catch (error) {
    said.textContent = sayable(error);
  }
}

class Comparison {
  /** @param {Choice[]} choices the first is shown on the right, beside the second if there is one */
  constructor(choices) {
    this.clock = new SharedClock();
    this.choices = choices;
    this.sides = [new Side(say("compare.left")), new Side(say("compare.right"))];
    for (const side of this.sides) {
      side.addEventListener("change", () => this.show());
      side.addEventListener("found", (event) => this.add(/** @type {CustomEvent<Choice>} */ (event).detail));
      side.offer(choices);
    }
    this.play = button("main-button", () => this.clock.toggle());
    this.slider = input("compare-slider", { type: "range", min: "0", step: "0.1", ariaLabel: say("time.label") });
    this.slider.addEventListener("input", () => this.clock.go(Number(this.slider.value)));
    this.time = element("span", "compare-time");
    this.steps = element("table", "compare-steps");
    const bar = element("div", "compare-bar", this.play, this.slider, this.time);
    const sides = element("div", "compare-sides", ...this.sides.map(({ root }) => root));
    this.root = element("div", "compare-body", sides, bar, this.steps);
    /** @type {{row: HTMLElement, steps: (Primitive|null)[]}[]} */
    this.rows = [];
    this.clock.addEventListener("tick", () => this.tick());
    const [now, before] = choices;
    if (before) this.sides[0].show(before);
    else this.sides[0].ask();
    this.sides[1].show(now);
  }

  /** A plan has been found that both sides may show. @param {Choice} choice */
  add(choice) {
    this.choices = [...this.choices, choice];
    for (const side of this.sides) side.offer(this.choices);
  }

  /** The sides have changed: how far the clock goes, and the rows. */
  show() {
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
      const { folds = [] } = (side ? right : left).drawing ?? {};
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
    const extents = this.sides.map(({ compared }) => (compared ? extentOf(compared) : [0, 0]));
    for (const side of this.sides)
      side.draw(t_s, [Math.max(...extents.map(([x]) => x)), Math.max(...extents.map(([, y]) => y))]);
    this.slider.max = String(end_s);
    this.slider.value = String(t_s);
    this.slider.disabled = end_s <= 0;
    this.play.disabled = end_s <= 0;
    this.play.replaceChildren(smallIcon(isRunning ? "pause" : "play"), `${say(isRunning ? "play.pause" : "play.play")}`);
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

/** @typedef {[Primitive|null, Primitive|null]} Row */

/** @param {Compared} compared @returns {{step: Primitive, what: string}[]} */
const stepsOf = ({ plan, drawing }) =>
  (plan?.primitives ?? []).map((step) => ({ step, what: `${step.kind} ${briefly(step, drawing?.folds ?? [])}` }));

/**
 * The longest sequence of steps that both have stands in common rows, the others in rows of their own.
 * @param {Compared} left
 * @param {Compared} right
 * @returns {Row[]}
 */
function aligned(left, right) {
  const [a, b] = [stepsOf(left), stepsOf(right)];
  const common = Array.from({ length: a.length + 1 }, () => Array.from({ length: b.length + 1 }, () => 0));
  for (let i = a.length - 1; i >= 0; i -= 1)
    for (let j = b.length - 1; j >= 0; j -= 1)
      common[i][j] =
        a[i].what === b[j].what ? common[i + 1][j + 1] + 1 : Math.max(common[i + 1][j], common[i][j + 1]);
  /** @type {Row[]} */
  const rows = [];
  let [i, j] = [0, 0];
  while (i < a.length || j < b.length) {
    const isSame = i < a.length && j < b.length && a[i].what === b[j].what;
    const isLeft = isSame || j >= b.length || (i < a.length && common[i + 1][j] >= common[i][j + 1]);
    const isRight = isSame || !isLeft;
    rows.push([isLeft ? a[i].step : null, isRight ? b[j].step : null]);
    i += Number(isLeft);
    j += Number(isRight);
  }
  return rows;
}

/** One clock for both plans: it runs in real time to the end of the longer one. */
class SharedClock extends EventTarget {
  constructor() {
    super();
    this.t_s = 0;
    this.end_s = 0;
    this.isRunning = false;
    /** @type {number|undefined} */
    this.frame = undefined;
    this.last = 0;
  }

  /** @param {number} end_s */
  reach(end_s) {
    this.end_s = end_s;
    this.go(Math.min(this.t_s, end_s));
  }

  /** @param {number} t_s */
  go(t_s) {
    this.t_s = t_s;
    this.dispatchEvent(new Event("tick"));
  }

  /** Play from here, or from the beginning where this is the end; or stop. */
  toggle() {
    if (this.isRunning) this.stop();
    else this.start();
  }

  start() {
    if (this.end_s <= 0) return;
    if (this.t_s >= this.end_s) this.t_s = 0;
    this.isRunning = true;
    this.last = performance.now();
    this.frame = requestAnimationFrame((now) => this.run(now));
    this.go(this.t_s);
  }

  stop() {
    this.isRunning = false;
    if (this.frame !== undefined) cancelAnimationFrame(this.frame);
    this.go(this.t_s);
  }

  /** @param {number} now (ms) */
  run(now) {
    const t_s = Math.min(this.t_s + Math.max(now - this.last, 0) / 1000, this.end_s);
    this.last = now;
    if (t_s >= this.end_s) this.isRunning = false;
    else this.frame = requestAnimationFrame((then) => this.run(then));
    this.go(t_s);
  }
}
