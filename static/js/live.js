/** The websocket to the document: comes back by itself, waiting a little longer each time, unless it is gone. */

/** @import { Command } from "pleat" */

const FIRST_WAIT_MS = 300;
const LONGEST_WAIT_MS = 5000;
const NOT_FOUND = 4404;

export class Live extends EventTarget {
  /** @param {string} name the document */
  constructor(name) {
    super();
    const url = new URL(`../api/documents/${name}/live`, location.href);
    url.protocol = location.protocol === "https:" ? "wss:" : "ws:";
    this.url = url.href;
    this.waitMs = FIRST_WAIT_MS;
    this.opened = 0;
    this.socket = this.open();
  }

  /** @returns {WebSocket} */
  open() {
    const socket = new WebSocket(this.url);
    socket.addEventListener("open", () => {
      this.waitMs = FIRST_WAIT_MS;
      this.opened += 1;
      this.dispatchEvent(new CustomEvent("open", { detail: { again: this.opened > 1 } }));
    });
    socket.addEventListener("message", (event) => {
      const message = JSON.parse(event.data);
      this.dispatchEvent(new CustomEvent(message.kind, { detail: message }));
    });
    socket.addEventListener("close", (event) => {
      if (event.code === NOT_FOUND) {
        this.dispatchEvent(new CustomEvent("gone"));
        return;
      }
      this.dispatchEvent(new CustomEvent("lost"));
      setTimeout(() => (this.socket = this.open()), this.waitMs);
      this.waitMs = Math.min(2 * this.waitMs, LONGEST_WAIT_MS);
    });
    return socket;
  }

  /**
   * Send a command; without a connection it is dropped.
   * @param {Command} command
   */
  send(command) {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(command));
  }
}
