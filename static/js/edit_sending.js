/** How a change of the drawing is sent to the server, and what the server answers. */

import { say } from "./language/say.js";
import { inWords } from "./messages/in_words.js";

/** @import { Fold, Problem } from "pleat" */
/** @import { Base, Job } from "./edit_queue.js" */

/** @typedef {{ok: boolean, status: number, told: any}} Answer */

/** No server has heard of the change. */
export class UnreachableError extends Error {}

/** @param {string} address @param {string} method @param {unknown} sent @returns {Promise<Answer>} */
export async function send(address, method, sent = undefined) {
  const body = sent === undefined ? undefined : JSON.stringify(sent);
  const headers = { "content-type": "application/json" };
  try {
    const answer = await fetch(address, { method, headers, body });
    return { ok: answer.ok, status: answer.status, told: await answer.json() };
  } catch {
    throw new UnreachableError();
  }
}

/** @param {Job} job @param {Base} base */
export function bodyOf({ label, change, phase, coalesce, gesture }, base) {
  const common = { base_version: base.version, label, phase, coalesce, gesture };
  if (!change) return common;
  const copy = structuredClone(base.drawing);
  return { ...common, drawing: change(copy) ?? copy };
}

/** @param {Problem} problem @param {Fold[]} folds */
export function sentence(problem, folds) {
  const first = problem.errors?.[0];
  if (first?.says) return `${inWords(first, folds)}.`;
  return first ? `${first.field}: ${first.message}` : (problem.detail ?? problem.title ?? say("server.was_refused"));
}
