/** The status pill: what planning came to, in a few words. */

import { element } from "../dom.js";
import { say, translated } from "../language/say.js";
import { percent } from "../messages/lengths.js";
import { lostAt } from "../rehearsal/words.js";
import { Planning } from "./planning.js";
import { headline, NO_PLAN } from "./reasons.js";
import { seconds } from "./words.js";

/**
 * @param {import("../store.js").Store} store
 * @param {import("../rehearsal/rehearsal.js").Rehearsal} rehearsal
 * @param {HTMLElement} pill
 */
export function mountStatus(store, rehearsal, pill) {
  const words = element("span", "pill-text", pill.textContent ?? "");
  const bar = element("span", "pill-bar");
  const planning = new Planning(store);
  let isGone = false;
  pill.replaceChildren(words, bar);

  function show() {
    const [text, kind] = isGone ? [say("status.no_document"), "failed"] : told(store, planning, rehearsal);
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
  rehearsal.addEventListener("change", show);
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
 * @param {import("../rehearsal/rehearsal.js").Rehearsal} rehearsal
 * @returns {[string|null, string]}
 */
function told(store, planning, rehearsal) {
  const { plan, state, isLive } = store;
  if (store.queue.isHeld && isLive) return [say("status.not_sent"), "lost"];
  if (!isLive) return plan ? [say("status.lost"), "lost"] : [say("status.connecting"), "planning"];
  if (!plan || !state) return [null, ""];
  if (planning.isGoingOn && plan.is_compiling) return [say("status.compiling"), "planning"];
  if (planning.isGoingOn && plan.prepared !== null) {
    return [say("status.learning", { share: percent(plan.prepared) }), "planning"];
  }
  if (planning.isGoingOn) return [planning.wait === "short" ? null : say("status.planning"), "planning"];
  if (plan.status === "solved" && plan.plan) return [rehearsed(solved(plan.plan), rehearsal), plan.status];
  if (!NO_PLAN.has(plan.status)) return [translated(plan.text), plan.status];
  return [say("status.no_plan", { why: headline(plan, state).replace(/\.$/, "") }), plan.status];
}

/** @param {string} planned @param {import("../rehearsal/rehearsal.js").Rehearsal} rehearsal */
function rehearsed(planned, { run, isHeld }) {
  if (!run || isHeld) return planned;
  const step = lostAt(run);
  return step ? say("status.lost_at", { planned, step }) : say("status.not_held", { planned });
}

/** @param {import("pleat").Plan} plan */
function solved({ dag, primitives, cost_s: cost }) {
  if (!dag.folds) return say("status.no_folds");
  return say("status.planned", { steps: say("status.steps", { count: primitives.length }), time: seconds(cost ?? 0) });
}
