/** The choice `Like`: a garment, shipped or of another document, whose folds are fitted to the one that is drawn. */

import { fetched } from "../dialogs/documents.js";
import { element } from "../dom.js";
import { called, counted, group, listed } from "../garments.js";
import { say, translated } from "../language/say.js";

/** @import { DocumentEntry, DocumentState, GarmentEntry } from "pleat" */
/** @import { Like } from "./target.js" */

export class LikePicker {
  /** @param {import("../store.js").Store} store @param {(like: Like) => void} onChosen */
  constructor(store, onChosen) {
    this.store = store;
    this.root = /** @type {HTMLSelectElement} */ (element("select", "proposal-like", new Option(say("proposal.like"), "")));
    this.root.setAttribute("aria-label", say("proposal.like_hint"));
    /** @type {Promise<void>|null} the lists being loaded, or loaded */
    this.loaded = null;
    this.root.addEventListener("change", async () => onChosen(await this.chosen()));
  }

  /** Have the garments that there are to choose from. */
  offer() {
    this.loaded ??= this.load();
  }

  async load() {
    const [documents, garments] = await Promise.all([
      listed("../api/documents?limit=500", /** @type {DocumentEntry[]} */ ([])),
      listed("../api/garments", /** @type {GarmentEntry[]} */ ([])),
    ]);
    const folded = documents.filter(({ id, picture }) => id !== this.store.id && picture?.folds.length);
    const counts = counted(folded);
    this.root.append(
      group(say("garments.documents"), folded.map((entry) => new Option(called(entry, counts), `/${entry.id}`))),
      group(say("proposal.garments"), garments.map(({ name, title }) => new Option(translated(title), name))),
    );
  }

  /** @returns {Promise<Like>} */
  async chosen() {
    const { value } = this.root;
    if (!value.startsWith("/")) return { like: value };
    /** @type {DocumentState} */
    const { garment } = await fetched(`../api/documents${value}`);
    return { like: garment ?? "" };
  }

  /** Show what is asked for; nothing if it is a size. @param {boolean} isLike */
  show(isLike) {
    if (!isLike) this.root.value = "";
    this.root.classList.toggle("is-chosen", isLike);
  }
}
