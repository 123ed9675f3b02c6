/** Documents: each has its own address, and the page goes there. */

import { OFFLINE, sentenceOf } from "./dialog.js";

/** @import { Garment } from "pleat" */

/** @param {string} id of a document */
export const goTo = (id) => location.assign(`../d/${id}`);

/**
 * @param {{garment?: string|Garment, arcs?: boolean}} wanted `{garment}` or nothing for a blank board
 * @param {string} tool the board's tool that is at hand there
 * @returns {Promise<Response>} what the server answered, if it was no new document
 */
export async function goToNew(wanted, tool = "") {
  const answer = await fetch("../api/documents", {
    method: "POST",
    headers: { "content-type": "application/json" },
    body: JSON.stringify(wanted),
  });
  if (answer.status === 201) location.assign((answer.headers.get("location") ?? "../") + (tool && `#${tool}`));
  return answer;
}

/** The server cannot be reached, or the page is left. */
export class OfflineError extends Error {}

/**
 * The answer's JSON; throws an error with a sentence where the server refuses or cannot be reached.
 * @param {string} url
 * @param {string} method
 * @param {object} [body] sent as JSON
 */
export async function fetched(url, method = "GET", body) {
  const headers = body ? { "content-type": "application/json" } : undefined;
  const sent = { method, headers, body: body && JSON.stringify(body) };
  const answer = await fetch(url, sent).catch(() => {
    throw new OfflineError(OFFLINE);
  });
  if (!answer.ok) throw new Error(sentenceOf(await answer.json()));
  return answer.json();
}
