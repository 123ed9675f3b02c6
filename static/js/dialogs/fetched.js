/** Requests to the server whose refusals are told to who asked. */

import { OFFLINE, sentenceOf } from "./dialog.js";

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
    throw new Error(OFFLINE);
  });
  if (!answer.ok) throw new Error(sentenceOf(await answer.json()));
  return answer.json();
}
