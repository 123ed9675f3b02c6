/** Events that the server sends while it works, jobs that are followed by them, and searches that last until the next. */

import { fetched } from "./dialogs/documents.js";
import { sayable } from "./dom.js";
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

/**
 * Begin a job and yield its events; it is cancelled once nobody waits for it.
 * @param {string} url
 * @param {object} asked the body of the request
 * @param {AbortSignal} signal
 * @returns {AsyncGenerator<{event: string, data: any}>}
 */
export async function* jobEvents(url, asked, signal) {
  /** @type {import("pleat").Job} */
  const { id } = await fetched(url, "POST", asked);
  const path = `../api/jobs/${id}`;
  const cancel = () => fetch(`${path}/cancel`, { method: "POST", keepalive: true }).catch(() => {});
  if (signal.aborted) cancel();
  signal.addEventListener("abort", cancel);
  let isOver = false;
  try {
    yield* eventStream(`${path}/events`, null, signal);
    isOver = true;
  } finally {
    signal.removeEventListener("abort", cancel);
    if (!isOver && !signal.aborted) cancel();
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

/** A search in place of which another one may begin at any time. It tells "change" whenever there is news. */
export class Search extends EventTarget {
  constructor() {
    super();
    this.isRunning = false;
    this.fault = "";
    /** @type {AbortController|null} of the search that is running */
    this.abort = null;
  }

  /**
   * Search in place of what was searched for before.
   * @param {number} delay_ms how long to wait first
   * @param {(signal: AbortSignal) => Promise<void>} search
   */
  async begin(delay_ms, search) {
    this.forget();
    const { signal } = (this.abort = new AbortController());
    this.isRunning = true;
    this.tell();
    try {
      await rest(delay_ms, signal);
      await search(signal);
    } catch (error) {
      if (!signal.aborted) this.fault = sayable(error);
    }
    if (signal.aborted) return; // another search may be running by now
    this.abort = null;
    this.isRunning = false;
    this.tell();
  }

  /** Search no more, and forget what was found. */
  forget() {
    this.abort?.abort();
    this.abort = null;
    this.isRunning = false;
    this.fault = "";
  }

  tell() {
    this.dispatchEvent(new Event("change"));
  }
}
