/** The numbers of a plan, or, when there is none, the reasons as sentences. */

import { byId, element } from "./dom.js";
import { KINDS, seconds, WHY_NOT } from "./words.js";

const COUNTERS = [
  ["Expanded", "expanded"],
  ["Explored", "explored"],
  ["Reach queries", "ik_queries"],
];
const TIMES = [
  ["Search", "search_time_s"],
  ["of that, reach", "ik_time_s"],
];

/**
 * @param {any} message of kind `document`
 */
export function showNumbers(message) {
  const { plan, status, text } = message;
  const solved = status === "solved";
  byId("numbers-title").textContent = solved || status === "planning" ? "Numbers" : WHY_NOT;
  byId("numbers").replaceChildren(...(solved ? figures(plan) : sentences(plan, status, text)));
}

function figures(plan) {
  const list = element("dl", "figures");
  const add = (name, value) => list.append(element("dt", "", name), element("dd", "", value));
  for (const [kind, name] of Object.entries(KINDS)) {
    const own = plan.primitives.filter((primitive) => primitive.kind === kind);
    const spent = own.reduce((sum, primitive) => sum + primitive.duration_s, 0);
    if (own.length) add(`${own.length} x ${name.toLowerCase()}`, seconds(spent));
  }
  list.append(element("div", "gap"));
  for (const [name, key] of COUNTERS) add(name, plan.statistics[key].toLocaleString("en"));
  for (const [name, key] of TIMES) add(name, `${(1000 * plan.statistics[key]).toFixed(0)} ms`);
  return [element("p", "cost", seconds(plan.cost_s)), list];
}

function sentences(plan, status, text) {
  if (status === "planning") return [element("p", "hint", "Planning...")];
  const messages = (plan?.reasons ?? []).map((reason) => reason.message).filter(Boolean);
  if (!messages.length) messages.push(text);
  return [element("ul", "reasons", ...messages.map((message) => element("li", "", message)))];
}
