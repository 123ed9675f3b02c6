/** The combobox `Garment`. */

import { byId } from "./dom.js";

export class Garments {
  /** @param {(name: string) => void} onChoose */
  constructor(onChoose) {
    this.select = /** @type {HTMLSelectElement} */ (byId("garment"));
    this.chosen = "";
    this.select.addEventListener("change", () => onChoose(this.select.value));
  }

  /** Ask the server which garments there are. */
  async load() {
    const answer = await fetch("/api/garments");
    if (!answer.ok) return;
    const entries = await answer.json();
    this.select.replaceChildren(...entries.map((entry) => new Option(entry.title, entry.name)));
    this.show(this.chosen);
  }

  /** @param {string} name of the document's garment */
  show(name) {
    this.chosen = name;
    this.select.value = name;
  }
}
