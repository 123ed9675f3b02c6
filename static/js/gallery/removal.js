/** A document that is deleted: for a while it can be had back, and only then it is removed for good. */

import { button, element } from "../dom.js";
import { say } from "../language/say.js";

/** How long it can be had back (ms). */
const REGRET_MS = 8000;

export class Removal {
  /** @param {(sentence: string) => void} onFault @param {() => void} onBack */
  constructor(onFault, onBack) {
    this.onFault = onFault;
    this.onBack = onBack;
    /** @type {string|null} the document's */
    this.id = null;
    this.timer = 0;
    this.words = element("span", "");
    this.root = element(
      "p",
      "removal",
      this.words,
      button("chip", () => this.takeBack(), say("history.undo")),
    );
    this.root.setAttribute("role", "status");
    this.root.hidden = true;
    addEventListener("pagehide", () => this.finish());
  }

  /** @param {string} id @param {string} title */
  begin(id, title) {
    this.finish();
    this.id = id;
    this.words.textContent = say("gallery.deleted", { title });
    this.root.hidden = false;
    this.timer = setTimeout(() => this.finish(), REGRET_MS);
  }

  takeBack() {
    clearTimeout(this.timer);
    this.id = null;
    this.root.hidden = true;
    this.onBack();
  }

  /** Remove it for good. */
  finish() {
    const { id } = this;
    clearTimeout(this.timer);
    this.root.hidden = true;
    if (id === null) return;
    this.id = null;
    fetch(`../api/documents/${id}`, { method: "DELETE", keepalive: true })
      .then((answer) => answer.ok || this.fail())
      .catch(() => this.fail());
  }

  fail() {
    this.onFault(say("gallery.not_deleted"));
    this.onBack();
  }
}
