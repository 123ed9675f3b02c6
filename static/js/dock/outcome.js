/** The column of what planning came to: the plan and its numbers, or why there is none and what would help. */

import { showCompare } from "../compare/compare.js";
import { button, element } from "../dom.js";
import { say } from "../language/say.js";
import { startInWords } from "../messages/starts.js";
import { Rehearsing } from "../rehearsal/rehearsing.js";
import { Running } from "../run/running.js";
import { numbers, quicker } from "./numbers.js";
import { PlanList } from "./plan.js";
import { Planning, Refining } from "./planning.js";
import { details, explanation, NO_PLAN } from "./reasons.js";
import { suggestionButton } from "./suggestion_button.js";
import { SuggestionSearch } from "./suggestion_search.js";

/** @import { DocumentState, Plan, PlanBefore, PlanMessage } from "pleat" */

export class Outcome {
  /**
   * @param {import("../store.js").Store} store
   * @param {import("./clock.js").Clock} clock
   * @param {import("./shown_plan.js").ShownPlan} shown
   * @param {import("../step_pictures.js").StepPictures} pictures
   * @param {import("../rehearsal/rehearsal.js").Rehearsal} rehearsal
   * @param {(t_s: number) => void} onSeek
   */
  constructor(store, clock, shown, pictures, rehearsal, onSeek) {
    this.store = store;
    this.shown = shown;
    this.title = element("h2", "", say("plan.label"));
    this.list = new PlanList(store, clock, pictures, onSeek);
    this.empty = element("p", "hint");
    this.numbers = element("section", "numbers");
    this.numbers.setAttribute("aria-label", say("numbers.label"));
    this.place = new BestPlace(store);
    this.compare = button("chip for-editors", () => showCompare(store), say("compare.do"));
    this.compare.title = say("compare.hint");
    this.rehearsal = rehearsal;
    this.rehearsing = new Rehearsing(rehearsal);
    rehearsal.addEventListener("change", () => this.list.judge(rehearsal.verdicts));
    this.running = new Running(rehearsal, shown, onSeek);
    this.none = new NoPlan();
    this.stop = button("chip for-editors", () => store.command({ do: "stop" }), say("search.stop"));
    this.longer = button("chip look-longer for-editors", () => store.command({ do: "look_longer" }), say("plan.look_longer"));
    this.longer.title = say("plan.look_longer_hint");
    this.refined = element("p", "refined hint");
    this.refined.setAttribute("aria-live", "polite");
    this.planning = new Planning(store);
    this.refining = new Refining(store);
    for (const waiting of [this.planning, this.refining]) waiting.addEventListener("change", () => this.offerStop());
    this.offerStop();
    const head = element("header", "dock-head", this.title, this.compare, this.rehearsing.button, this.running.button, this.place.button, this.stop);
    const plan = element("div", "plan-scroll", this.place.root, this.rehearsing.root, this.running.root, this.empty, this.list.root);
    this.solved = element("div", "outcome-solved", plan, this.numbers);
    this.title.tabIndex = -1;
    this.start = new StartLine(store, () => this.title.focus());
    this.root = element("section", "dock-outcome", head, this.start.root, this.solved, this.none.root);
    shown.addEventListener("change", () => this.show());
    this.show();
  }

  offerStop() {
    const isPlanning = this.planning.wait === "long";
    const isRefining = this.refining.isLong;
    this.stop.hidden = !isPlanning && !isRefining;
    this.stop.title = isPlanning ? say("plan.stop_hint") : say("plan.keep");
    this.tellOfQuicker();
  }

  /** Whether a quicker plan is looked for, or may exist though none was found in time. */
  tellOfQuicker() {
    const plan = this.store.plan?.plan;
    const isOpen = plan?.status === "solved" && plan.is_final && plan.at_least_s !== null;
    const searched = say("plan.searched", { ways: plan?.statistics?.ways ?? 0 });
    const open = isOpen ? `${searched} ${quicker(plan.cost_s ?? 0, plan.at_least_s ?? 0)}` : "";
    this.refined.textContent = this.refining.isLong ? say("plan.looking") : open;
    this.longer.hidden = this.refining.isLong || !isOpen || !this.store.plan?.may_look_longer;
  }

  show() {
    const { plan: message, state } = this.store;
    const plan = message?.plan?.status === "solved" ? message.plan : null;
    this.place.follow();
    this.rehearsing.show();
    this.running.show();
    if (message && message.status === "planning" && !plan) this.wait();
    else if (message && state && NO_PLAN.has(message.status)) this.showNone(message, state);
    else if (plan) this.showPlan(plan, message?.before ?? null);
  }

  /** There is neither a plan nor a reason why not; a reason of before stays until then. */
  wait() {
    if (!this.none.root.hidden) return;
    this.turn(false);
    this.list.show(null, []);
    this.numbers.replaceChildren();
    this.empty.hidden = false;
    this.empty.textContent = say("plan.working");
    this.place.button.hidden = this.compare.hidden = true;
  }

  /** @param {PlanMessage} message @param {DocumentState} state */
  showNone(message, state) {
    this.turn(true);
    this.list.show(null, []);
    this.none.show(message, state);
    this.place.button.hidden = this.compare.hidden = true;
  }

  /** @param {Plan} plan @param {PlanBefore|null} before */
  showPlan(plan, before) {
    this.turn(false);
    this.list.show(plan, this.shown.folds);
    this.list.judge(this.rehearsal.verdicts);
    this.empty.hidden = plan.primitives.length > 0;
    const { length } = this.shown.folds;
    this.empty.textContent = length ? say("plan.nothing_left") : say("plan.nothing_to_do");
    this.place.button.hidden = plan.primitives.length === 0 || this.shown.start !== null;
    this.compare.hidden = plan.primitives.length === 0;
    this.numbers.hidden = plan.primitives.length === 0;
    const [cost, ...rest] = numbers(plan, before);
    this.numbers.replaceChildren(cost, this.refined, this.longer, ...rest);
    this.tellOfQuicker();
  }

  /** @param {boolean} isNone */
  turn(isNone) {
    this.title.textContent = isNone ? say("plan.none") : say("plan.label");
    this.solved.hidden = isNone;
    this.none.root.hidden = !isNone;
  }
}

/** What stands where the plan would be: all the reasons, with their numbers. What would help is over the board. */
class NoPlan {
  constructor() {
    this.all = element("ul", "reasons");
    this.all.setAttribute("aria-label", say("reasons.label"));
    this.brief = element("p", "hint");
    this.root = element("div", "no-plan", this.brief, this.all);
  }

  /** @param {PlanMessage} message without a plan @param {DocumentState} state */
  show(message, state) {
    const all = details(message, state);
    this.all.replaceChildren(...all.map((text) => element("li", "", text)));
    this.all.hidden = !all.length;
    this.brief.textContent = all.length ? "" : explanation(message, state);
  }
}

/** A line over the plan while it is planned from the middle: from what state, and the way back to the beginning. */
class StartLine {
  /** @param {import("../store.js").Store} store @param {() => void} onBack after the way back was taken */
  constructor(store, onBack) {
    this.store = store;
    /** Whether it takes over the focus from a step that is to go away. */
    this.isAwaited = false;
    this.words = element("p", "");
    this.words.setAttribute("aria-live", "polite");
    const goBack = () => {
      store.command({ do: "plan_from", step: null });
      onBack();
    };
    this.back = button("chip for-editors", goBack, say("start.from_start"));
    this.back.title = say("start.from_start_hint");
    this.back.hidden = true;
    this.root = element("div", "start-line", this.words, this.back);
    for (const name of ["document", "plan"]) store.addEventListener(name, () => this.show());
    addEventListener("unit", () => this.show());
    this.show();
  }

  /** Take the focus once planned from the middle, if the step that has it now goes away. */
  takeFocus() {
    this.isAwaited = true;
  }

  show() {
    const { plan, state } = this.store;
    const start = plan && state && plan.version === state.version ? plan.start : null;
    const told = start && state ? startInWords(start, state.drawing) : "";
    this.root.classList.toggle("is-empty", !told);
    this.back.hidden = !told;
    if (this.words.textContent !== told) this.words.textContent = this.words.title = told;
    if (!told || !this.isAwaited) return;
    this.isAwaited = false;
    if (document.activeElement === document.body) this.back.focus();
  }
}

/** All places are tried as long as that lasts (s); then the best so far is told. */
const WORK_S = 4;

/** The button `Best place`: looks for a place on the table where the plan is quicker, and offers it. */
class BestPlace {
  /** @param {import("../store.js").Store} store */
  constructor(store) {
    this.store = store;
    this.search = new SuggestionSearch();
    /** @type {number|null} the version that it is looked for */
    this.version = null;
    this.button = button("chip for-editors", () => this.begin(), say("place.best"));
    this.button.title = say("place.best_hint");
    this.note = element("p", "hint search-note");
    this.note.setAttribute("aria-live", "polite");
    this.offer = element("div", "suggestions");
    this.end = button("quiet", () => this.close(), say("search.stop"));
    this.root = element("div", "best-place", this.note, this.offer, this.end);
    this.search.addEventListener("change", () => this.show());
    this.close();
  }

  begin() {
    const { state } = this.store;
    if (!state) return;
    this.version = state.version;
    this.search.start(state, { work_s: WORK_S });
  }

  /** What was found is about one drawing only. */
  follow() {
    if (this.version !== null && this.version !== this.store.state?.version) this.close();
  }

  close() {
    this.version = null;
    this.store.setPreview(null);
    this.search.stop();
  }

  show() {
    const { found, isRunning, fault } = this.search;
    const [best] = found.toSorted((one, other) => one.cost_s - other.cost_s);
    this.root.hidden = this.version === null;
    this.button.disabled = isRunning;
    this.note.classList.toggle("is-searching", isRunning);
    this.note.hidden = best !== undefined;
    this.offer.hidden = best === undefined;
    this.note.textContent = isRunning ? say("place.trying") : outcome(fault);
    this.end.textContent = isRunning ? say("search.stop") : say("dialog.close");
    this.offer.replaceChildren(...(best ? [suggestionButton(this.store, best, "is-first")] : []));
  }
}

/** @param {string} fault */
const outcome = (fault) => (fault ? say("search.fault", { fault }) : say("place.none"));
