/** The numbers of a plan: what it costs, compared with the one before, what that is made of, and how it was found. */

import { element } from "../dom.js";
import { KINDS, seconds } from "./words.js";

const NOTICEABLE_S = 0.05;
const COUNTERS = [
  ["Expanded", "expanded"],
  ["Explored", "explored"],
  ["IK queries", "ik_queries"],
];
const TIMES = [
  ["Search", "search_time_s"],
  ["of it, IK", "ik_time_s"],
  ["Joint paths", "joint_time_s"],
];

/**
 * @param {any} plan that is solved
 * @param {any} before the figures of the plan before, or null
 * @returns {HTMLElement[]}
 */
export function numbers(plan, before) {
  const parts = sharesOf(plan);
  const change = difference(plan.cost_s, before);
  const cost = element("p", "total", seconds(plan.cost_s), element("span", "total-change", change));
  return [cost, bar(parts, plan.cost_s), partList(parts), counters(plan.statistics)];
}

/**
 * @param {number} cost_s
 * @param {{status: string, cost_s: number|null}|null} before
 * @returns {string} empty when there was none before
 */
export function difference(cost_s, before) {
  if (!before) return "";
  if (before.cost_s === null) return "no plan before";
  const more = cost_s - before.cost_s;
  if (Math.abs(more) < NOTICEABLE_S) return "same as before";
  return `${seconds(Math.abs(more))} ${more > 0 ? "more" : "less"} than before`;
}

/** What each kind of primitive adds up to (s). */
function sharesOf(plan) {
  return Object.entries(KINDS).flatMap(([kind, name]) => {
    const own = plan.primitives.filter((primitive) => primitive.kind === kind);
    const spent = own.reduce((sum, primitive) => sum + primitive.duration_s, 0);
    return own.length ? [{ kind, name, count: own.length, spent }] : [];
  });
}

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

function partList(parts) {
  const list = element("dl", "figures is-parts");
  for (const { kind, name, count, spent } of parts) {
    const term = element("dt", "", `${count} \u00D7 ${name.toLowerCase()}`);
    term.dataset.kind = kind;
    list.append(term, element("dd", "", seconds(spent)));
  }
  return list;
}

function counters(statistics) {
  const list = element("dl", "figures");
  const add = (name, value) => list.append(element("dt", "", name), element("dd", "", value));
  for (const [name, key] of COUNTERS) add(name, statistics[key].toLocaleString("en"));
  for (const [name, key] of TIMES) add(name, `${Math.round(1000 * statistics[key]).toLocaleString("en")} ms`);
  return list;
}
