/** The status pill: what planning came to, in a few words. */

import { element } from "../dom.js";
import { Planning } from "./planning.js";
import { headline, NO_PLAN } from "./reasons.js";

/**
 * @param {import("../store.js").Store} store
 * @param {HTMLElement} pill
 */
export function mountStatus(store, pill) {
  const words = element("span", "pill-text", pill.textContent ?? "");
  const bar = element("span", "pill-bar");
  const planning = new Planning(store);
  let isGone = false;
  pill.replaceChildren(words, bar);

  function show() {
    const [text, kind] = isGone ? ["There is no such document.", "failed"] : told(store, planning);
    pill.setAttribute("aria-busy", String(planning.wait !== ""));
    bar.hidden = planning.wait !== "long";
    if (text === null) return;
    if (!planning.isGoingOn && store.plan) pill.dataset.version = String(store.plan.version);
    if (words.textContent !== text) words.textContent = pill.title = text;
    pill.dataset.status = kind;
    pill.dataset.isFinal = String(store.plan?.plan?.is_final ?? true);
  }

  for (const name of ["document", "plan", "connection", "held"]) store.addEventListener(name, show);
  planning.addEventListener("change", show);
  addEventListener("unit", show);
  store.addEventListener("gone", () => {
    isGone = true;
    show();
  });
  show();
}

/**
 * What to say, and of which kind it is; null: what was said still holds.
 * @param {import("../store.js").Store} store
 * @param {Planning} planning
 * @returns {[string|null, string]}
 */
function told(store, planning) {
  const { plan, state, isLive } = store;
  if (store.queue.isHeld && isLive) return ["Not sent yet, trying again...", "lost"];
  if (!isLive) return plan ? ["Connection lost, trying again...", "lost"] : ["Connecting...", "planning"];
  if (!plan || !state) return [null, ""];
  if (planning.isGoingOn && plan.prepared !== null) {
    return [`Learning where this robot's arms can reach, once: ${Math.round(100 * plan.prepared)} %`, "planning"];
  }
  if (planning.isGoingOn) return [planning.wait === "short" ? null : "Planning...", "planning"];
  if (!NO_PLAN.has(plan.status)) return [plan.text, plan.status];
  return [`No plan: ${headline(plan, state).replace(/\.$/, "")}`, plan.status];
}
