/** The framed stage. Its own socket only looks for a lost server while it has the focus, so it is loaded anew. */

import { byId } from "./dom.js";

export class StageFrame {
  /**
   * @param {string} name the document
   * @param {(event: KeyboardEvent) => void} onKey keys pressed while the stage has the focus
   */
  constructor(name, onKey) {
    this.frame = /** @type {HTMLIFrameElement} */ (byId("stage"));
    this.name = name;
    this.frame.addEventListener("load", () => this.frame.contentWindow?.addEventListener("keydown", onKey));
  }

  load() {
    this.frame.src = `/viser/${this.name}/`;
  }
}
