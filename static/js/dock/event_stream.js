/** Server-sent events as the answer to a POST. */

import { say } from "../language/say.js";

/**
 * @param {string} url
 * @param {any} sent as JSON
 * @param {AbortSignal} signal
 * @returns {AsyncGenerator<{event: string, data: any}>}
 */
export async function* eventStream(url, sent, signal) {
  const headers = { "content-type": "application/json", accept: "text/event-stream" };
  const answer = await fetch(url, { method: "POST", headers, body: JSON.stringify(sent), signal });
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
