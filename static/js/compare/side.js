/** One of the two sides: what is chosen for it, its picture, and what its plan takes. */

import { primitiveAt } from "../dock/lane_blocks.js";
import { briefly, seconds } from "../dock/words.js";
import { button, element, field, input, sayable, svg, toldAloud } from "../dom.js";
import { say } from "../language/say.js";
import { planById, planOfFile } from "./choices.js";
import { drawScene } from "./scene_picture.js";

/** @import { Point } from "pleat" */
/** @import { Choice } from "./choices.js" */
/** @import { Compared } from "./compared_plan.js" */

/** @type {Choice["group"][]} */
const GROUPS = ["versions", "documents", "plans"];
/** What is chosen to name a plan by its id or its file. */
const ANOTHER = "another";

/** Tells "change" whenever it has something else to show, "found" (detail: a choice) for a plan that both may show. */
export class Side extends EventTarget {
  /** @param {string} name */
  constructor(name) {
    super();
    /** @type {Choice[]} */
    this.choices = [];
    /** @type {Choice|null} */
    this.chosen = null;
    /** @type {Compared|null} */
    this.compared = null;
    this.asked = new AbortController();
    this.select = /** @type {HTMLSelectElement} */ (element("select", "field"));
    this.select.setAttribute("aria-label", name);
    this.select.addEventListener("change", () => this.pick());
    this.picture = svg("svg", { class: "compare-picture", role: "img" });
    this.cost = toldAloud("compare-cost");
    this.another = this.form();
    this.root = element("section", "compare-side", this.select, this.another, this.picture, this.cost);
    this.root.addEventListener("drop", (event) => this.drop(event));
  }

  /** A plan by its id or its file. */
  form() {
    const id = field({ placeholder: say("compare.plan_id"), ariaLabel: say("compare.plan_id") });
    const ofFile = { accept: ".json", tabIndex: -1, ariaLabel: say("compare.plan_file") };
    const file = input("unseen", { type: "file", ...ofFile });
    file.addEventListener("change", () => file.files?.[0] && this.take(planOfFile(file.files[0])));
    const form = /** @type {HTMLFormElement} */ (element("form", "compare-another"));
    const choose = button("plain-button", () => file.click(), say("compare.plan_file"));
    form.append(id, element("button", "plain-button", say("compare.show")), choose, file);
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      if (id.value.trim()) this.take(planById(id.value.trim()));
    });
    form.hidden = true;
    return form;
  }

  /** @param {Choice[]} choices */
  offer(choices) {
    this.choices = choices;
    const groups = GROUPS.map((group) => {
      const made = document.createElement("optgroup");
      made.label = say(`compare.${group}`);
      const own = choices.map((choice, index) => ({ choice, index })).filter(({ choice }) => choice.group === group);
      made.append(...own.map(({ choice, index }) => new Option(choice.name, String(index))));
      return made;
    });
    groups[GROUPS.length - 1].append(new Option(say("compare.another"), ANOTHER));
    this.select.replaceChildren(...groups.filter(({ children }) => children.length));
    this.mark();
  }

  /** The list says what is shown. */
  mark() {
    if (this.chosen) this.select.value = String(this.choices.indexOf(this.chosen));
  }

  /** Have a plan named by its id or its file. */
  ask() {
    this.select.value = ANOTHER;
    this.pick();
  }

  pick() {
    const isAnother = this.select.value === ANOTHER;
    this.another.hidden = !isAnother;
    if (isAnother) this.another.querySelector("input")?.focus();
    else this.show(this.choices[Number(this.select.value)]);
  }

  /** A plan file that is dropped here is shown here. @param {DragEvent} event */
  drop(event) {
    const file = event.dataTransfer?.files[0];
    if (!file) return;
    event.preventDefault();
    event.stopPropagation(); // the page itself would import its garment
    this.take(planOfFile(file));
  }

  /** @param {Promise<Choice>} asked */
  async take(asked) {
    this.cost.textContent = say("compare.reading");
    try {
      const choice = await asked;
      this.dispatchEvent(new CustomEvent("found", { detail: choice }));
      this.another.hidden = true;
      this.show(choice);
    } catch (error) {
      this.cost.textContent = sayable(error);
    }
  }

  /** @param {Choice} choice */
  async show(choice) {
    this.asked.abort();
    const asked = (this.asked = new AbortController());
    this.chosen = choice;
    this.mark();
    this.compared = null;
    this.cost.textContent = say("status.planning");
    this.tell();
    /** @type {Compared} */
    let compared;
    try {
      compared = await choice.load(asked.signal);
    } catch (error) {
      compared = { drawing: null, plan: null, pictures: [], problem: sayable(error) };
    }
    if (asked.signal.aborted) return;
    this.compared = compared;
    const { plan, problem } = compared;
    const count = plan?.primitives.length ?? 0;
    this.cost.textContent = plan ? say("compare.cost", { count, time: seconds(this.end_s) }) : problem;
    this.tell();
  }

  tell() {
    this.dispatchEvent(new Event("change"));
  }

  get end_s() {
    return this.compared?.plan?.cost_s ?? 0;
  }

  /** @param {number} t_s @param {Point} extent */
  draw(t_s, extent) {
    const { compared } = this;
    if (!compared) return;
    drawScene(this.picture, compared, t_s, extent);
    const step = compared.plan?.primitives[primitiveAt(compared.plan, t_s)];
    const said = step && compared.drawing ? briefly(step, compared.drawing.folds) : say("compare.no_plan");
    this.picture.setAttribute("aria-label", said);
  }
}
