/** The numbers of a plan: what it costs, compared with the one before, what that is made of, and how it was found. */

import { element } from "../dom.js";
import { language } from "../language/language.js";
import { numeral } from "../language/numeral.js";
import { say } from "../language/say.js";
import { STEP_KINDS } from "./step_kinds.js";
import { seconds } from "./words.js";

/** @import { Plan, PlanBefore, Statistics } from "pleat" */

const NOTICEABLE_S = 0.05;
/**
 * Of the time that a kind of primitive takes (s).
 * @typedef {{kind: keyof typeof STEP_KINDS, count: number, spent: number}} Share
 */

const COUNTERS = /** @type {const} */ ([
  [say("figure.expanded"), "expanded"],
  [say("figure.explored"), "explored"],
  [say("figure.ik_queries"), "ik_queries"],
]);
const TIMES = /** @type {const} */ ([
  [say("figure.search"), "search_time_s"],
  [say("figure.of_it_ik"), "ik_time_s"],
  [say("figure.joint_paths"), "joint_time_s"],
]);

/**
 * @param {Plan} plan that is solved
 * @param {PlanBefore|null} before the figures of the plan before
 * @returns {HTMLElement[]}
 */
export function numbers(plan, before) {
  const parts = sharesOf(plan);
  const cost_s = plan.cost_s ?? 0;
  const change = difference(cost_s, before);
  const cost = element("p", "total", seconds(cost_s), element("span", "total-change", change));
  return [cost, bar(parts, cost_s), partList(parts), counters(plan.statistics)];
}

/**
 * @param {number} cost_s
 * @param {{status: string, cost_s: number|null}|null} before
 * @returns {string} empty when there was none before, or no folds
 */
export function difference(cost_s, before) {
  if (!before || before.cost_s === 0) return "";
  if (before.cost_s === null) return say("cost.no_plan_before");
  const more = cost_s - before.cost_s;
  if (Math.abs(more) < NOTICEABLE_S) return say("cost.same");
  return say(more > 0 ? "cost.more" : "cost.less", { seconds: seconds(Math.abs(more)) });
}

/** What each kind of primitive adds up to (s). @param {Plan} plan @returns {Share[]} */
function sharesOf(plan) {
  const kinds = /** @type {(keyof typeof STEP_KINDS)[]} */ (Object.keys(STEP_KINDS));
  return kinds.flatMap((kind) => {
    const own = plan.primitives.filter((primitive) => primitive.kind === kind);
    const spent = own.reduce((sum, primitive) => sum + primitive.duration_s, 0);
    return own.length ? [{ kind, count: own.length, spent }] : [];
  });
}

/** @param {Share[]} parts @param {number} cost_s */
function bar(parts, cost_s) {
  const shown = element("div", "cost-bar");
  shown.setAttribute("aria-hidden", "true");
  for (const { kind, spent } of parts) {
    const part = element("span", "");
    part.dataset.kind = kind;
    part.style.flexGrow = String(spent / cost_s);
    shown.append(part);
  }
  return shown;
}

/** @param {Share[]} parts */
function partList(parts) {
  const list = element("dl", "figures is-parts");
  for (const { kind, count, spent } of parts) {
    const term = element("dt", "", say(`kind.${kind}.counted`, { count }));
    term.dataset.kind = kind;
    list.append(term, element("dd", "", seconds(spent)));
  }
  return list;
}

/** @param {Statistics} statistics */
function counters(statistics) {
  const list = element("dl", "figures");
  /** @param {string} name @param {string} value */
  const add = (name, value) => list.append(element("dt", "", name), element("dd", "", value));
  for (const [name, key] of COUNTERS) add(name, statistics[key].toLocaleString(language));
  for (const [name, key] of TIMES) add(name, say("time.milliseconds", { number: Math.round(1000 * statistics[key]) }));
  return element("details", "search-figures", element("summary", "hint", say("figure.title")), list);
}

/**
 * How much quicker a plan may be that was not found. Where both times read the same, the difference is told.
 * @param {number} cost_s
 * @param {number} least_s what any plan takes
 */
export function quicker(cost_s, least_s) {
  const least = seconds(least_s);
  if (seconds(cost_s) !== least) return say("cost.none_less", { least });
  const by_s = Math.max(Math.ceil(100 * (cost_s - least_s) - 1e-6) / 100, 0.01);
  return say("cost.quicker_by", { seconds: numeral(by_s, 2) });
}
