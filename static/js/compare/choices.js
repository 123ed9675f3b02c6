/** What can be compared: versions of the document, other documents, plans made before. Each is planned when it is chosen. */

import { OFFLINE, sentenceOf } from "../dialogs/dialog.js";
import { fetched } from "../dialogs/documents.js";
import { titleOf, when } from "../gallery/tile.js";
import { listed } from "../garments.js";
import { say, translated } from "../language/say.js";
import { comparedPlan, storedPlan } from "./compared_plan.js";

/** @import { DocumentEntry, DocumentState, DocumentVersion, Plan } from "pleat" */
/** @import { Compared, Folded } from "./compared_plan.js" */

/**
 * @typedef {object} Choice
 * @property {string} name
 * @property {"versions"|"documents"|"plans"} group
 * @property {(signal: AbortSignal) => Promise<Compared>} load
 */

const PLAN_FILE = "application/vnd.pleat.plan+json";

/** @param {import("../store.js").Store} store @returns {Promise<Choice[]>} this drawing, then those before it */
export async function versionsOf(store) {
  const { id, state, plan } = store;
  if (!state) return [];
  const isCurrent = plan?.version === state.version && !plan.plan?.is_stale;
  const known = (isCurrent && plan.plan?.id) || null;
  const { drawing } = state;
  /** @type {Choice} */
  const now = { name: say("compare.now"), group: "versions", load: (signal) => comparedPlan(drawing, known, signal) };
  const versions = /** @type {DocumentVersion[]} */ (await fetched(`../api/documents/${id}/versions`));
  const before = versions.map(({ label, changed_at: at, drawing: then }) => {
    const name = [translated(label) || say("versions.first"), when(at)].filter(Boolean).join(", ");
    return /** @type {Choice} */ ({ name, group: "versions", load: (signal) => comparedPlan(then, null, signal) });
  });
  return [now, ...before];
}

/** The other documents, the latest changed first; none for somebody who may see this one alone. @param {string} id @returns {Promise<Choice[]>} */
export async function documentsBeside(id) {
  const found = await listed("../api/documents?limit=500", /** @type {DocumentEntry[]} */ ([]));
  return found
    .filter((entry) => entry.id !== id && !entry.problem)
    .map((entry) => ({
      name: [titleOf(entry), when(entry.changed_at)].filter(Boolean).join(", "),
      group: "documents",
      load: async (signal) => {
        const { drawing } = /** @type {DocumentState} */ (await fetched(`../api/documents/${entry.id}`));
        return comparedPlan(drawing, null, signal);
      },
    }));
}

/** A plan that the server keeps. @param {string} id @returns {Promise<Choice>} */
export async function planById(id) {
  const path = `../api/plans/${encodeURIComponent(id)}`;
  const [plan, { task }] = await Promise.all([fetched(path), fetched(`${path}/file`)]);
  return choiceOf(task.garment.title, plan, task);
}

/** A plan of a file, which the server replays first. @param {File} file @returns {Promise<Choice>} */
export async function planOfFile(file) {
  const headers = { "content-type": PLAN_FILE };
  const answer = await fetch("../api/plans/imports", { method: "POST", headers, body: file }).catch(() => {
    throw new Error(OFFLINE);
  });
  const plan = await answer.json();
  if (!answer.ok) throw new Error(say("compare.refused", { name: file.name, why: sentenceOf(plan) }));
  const { task } = JSON.parse(await file.text());
  return choiceOf(file.name, plan, task);
}

/** @param {string} title @param {Plan} plan @param {{garment: Pick<Folded, "folds">, scene: Folded["scene"]}} task @returns {Choice} */
function choiceOf(title, plan, { garment: { folds }, scene }) {
  const name = say("compare.plan", { title: translated(title), id: plan.id });
  return { name, group: "plans", load: (signal) => storedPlan({ folds, scene }, plan, signal) };
}
