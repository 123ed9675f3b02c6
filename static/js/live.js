/**
 * The one channel to the document: a websocket on which its state comes, and on which the page sends and asks. It comes
 * back by itself, waiting a little longer each time, unless the document is gone.
 */

import { say } from "./language/say.js";
import { inWords } from "./messages/in_words.js";

/** @import { Command, Fold, Problem, Result } from "pleat" */

const FIRST_WAIT_MS = 300;
const LONGEST_WAIT_MS = 5000;
const NOT_FOUND = 4404;

/** No server has answered; it may have heard all the same. */
export class UnreachableError extends Error {
  constructor() {
    super(say("server.unreachable"));
  }
}

/** The server has refused what was sent. */
export class RefusedError extends Error {
  /** @param {Problem} problem */
  constructor(problem) {
    super(problem.detail);
    this.problem = problem;
  }

  /** What the server says, as a sentence. @param {Fold[]} folds */
  inWords(folds) {
    const [first] = this.problem.errors ?? [];
    if (first?.says) return `${inWords(first, folds)}.`;
    return first ? `${first.field}: ${first.message}` : this.message;
  }
}

/** @typedef {{resolve: (answer: Result) => void, reject: (error: Error) => void}} Waiting */

export class Live extends EventTarget {
  /** @param {string} name the document */
  constructor(name) {
    super();
    const url = new URL(`../api/documents/${name}/live`, location.href);
    url.protocol = location.protocol === "https:" ? "wss:" : "ws:";
    this.url = url.href;
    this.waitMs = FIRST_WAIT_MS;
    this.asked = 0;
    /** @type {Map<number, Waiting>} what the server has been sent and has not answered, by its number */
    this.waiting = new Map();
    /** @type {WebSocket|null} none while there is no connection, and none is tried */
    this.socket = this.open();
    addEventListener("offline", () => this.close()); // a lost network is not noticed by an open socket
  }

  /** @returns {WebSocket} */
  open() {
    const socket = new WebSocket(this.url);
    socket.addEventListener("open", () => {
      this.waitMs = FIRST_WAIT_MS;
      this.dispatchEvent(new Event("open"));
    });
    socket.addEventListener("message", (event) => socket === this.socket && this.hear(JSON.parse(event.data)));
    socket.addEventListener("close", (event) => socket === this.socket && this.lose(event.code));
    return socket;
  }

  close() {
    this.socket?.close();
    if (this.socket) this.lose();
  }

  /** @param {{kind: string, ask?: number|null}} message without a number it is for all who listen */
  hear(message) {
    const { kind, ask } = message;
    if (typeof ask !== "number") {
      this.dispatchEvent(new CustomEvent(kind, { detail: message }));
      return;
    }
    const waiting = this.waiting.get(ask);
    this.waiting.delete(ask);
    if (kind === "answer") waiting?.resolve(/** @type {Result} */ (message));
    else waiting?.reject(new RefusedError(/** @type {any} */ (message)));
  }

  /** @param {number} [code] why the socket was closed */
  lose(code) {
    this.socket = null;
    const lost = [...this.waiting.values()];
    this.waiting.clear();
    this.dispatchEvent(new Event(code === NOT_FOUND ? "gone" : "lost"));
    for (const { reject } of lost) reject(new UnreachableError());
    if (code === NOT_FOUND) return;
    setTimeout(() => (this.socket = this.open()), this.waitMs);
    this.waitMs = Math.min(2 * this.waitMs, LONGEST_WAIT_MS);
  }

  /** Send a command; without a connection it is dropped. @param {Command & {ask?: number}} command */
  send(command) {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(command));
  }

  /**
   * Send a change or a question. The state that a change leads to has come by the time it is answered.
   * @param {Command} command
   * @param {AbortSignal} [signal] ends the wait, and the server's work
   * @returns {Promise<Result>} rejected with a `RefusedError` or an `UnreachableError`
   */
  ask(command, signal) {
    if (this.socket?.readyState !== WebSocket.OPEN) return Promise.reject(new UnreachableError());
    const ask = (this.asked += 1);
    this.send({ ...command, ask });
    signal?.addEventListener("abort", () => {
      const waiting = this.waiting.get(ask);
      if (!waiting) return;
      this.waiting.delete(ask);
      this.send({ do: "drop", question: ask });
      waiting.reject(signal.reason);
    });
    return new Promise((resolve, reject) => this.waiting.set(ask, { resolve, reject }));
  }
}
