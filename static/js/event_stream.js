/** Events that the server sends while it searches, and the pause before a search: a signal ends both. */

import { say } from "./language/say.js";

/**
 * Wait; a signal ends it with an error.
 * @param {number} delay_ms
 * @param {AbortSignal} signal
 * @returns {Promise<void>}
 */
export function rest(delay_ms, signal) {
  return new Promise((resolve, reject) => {
    const timer = setTimeout(resolve, delay_ms);
    signal.addEventListener("abort", () => {
      clearTimeout(timer);
      reject(signal.reason);
    });
  });
}

/**
 * Server-sent events as the answer to a request.
 * @param {string} url
 * @param {any} sent as JSON by POST; null for a GET
 * @param {AbortSignal} signal
 * @returns {AsyncGenerator<{event: string, data: any}>}
 */
export async function* eventStream(url, sent, signal) {
  const headers = { "content-type": "application/json", accept: "text/event-stream" };
  const body = sent && { method: "POST", body: JSON.stringify(sent) };
  const answer = await fetch(url, { ...body, headers, signal });
  if (!answer.ok || !answer.body)
    throw new Error((await problemOf(answer)) ?? say("server.answered", { status: answer.status }));
  const reader = answer.body.pipeThrough(new TextDecoderStream()).getReader();
  let kept = "";
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    const blocks = (kept + part.value).replaceAll("\r\n", "\n").split("\n\n");
    kept = blocks.pop() ?? "";
    for (const block of blocks) {
      const event = eventIn(block);
      if (event) yield event;
    }
  }
}

/** @param {string} block lines of one event; comments are passed over */
function eventIn(block) {
  let event = "message";
  /** @type {string[]} */
  const data = [];
  for (const line of block.split("\n")) {
    if (line.startsWith("event:")) event = line.slice(6).trim();
    if (line.startsWith("data:")) data.push(line.slice(5).trim());
  }
  return data.length ? { event, data: JSON.parse(data.join("\n")) } : null;
}

/** @param {Response} answer @returns {Promise<string|undefined>} */
async function problemOf(answer) {
  try {
    return (await answer.json()).detail;
  } catch {
    return undefined;
  }
}
