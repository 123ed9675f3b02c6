/** One sentence below the cloth on what to do next; it goes once there was time to read it. */

import { element } from "../dom.js";

const READING_MS = 5000;

export class HintLine {
  constructor() {
    this.root = element("p", "hint-line");
    this.timer = 0;
  }

  /** @param {string} text @param {boolean} stays */
  show(text, stays = false) {
    if (text === this.root.textContent) return;
    this.root.textContent = text;
    this.root.classList.remove("is-read");
    clearTimeout(this.timer);
    if (!stays) this.timer = setTimeout(() => this.root.classList.add("is-read"), READING_MS);
  }
}
