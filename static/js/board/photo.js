/** The photo under the board: kept by this browser for this document, never sent anywhere. */

import { say } from "../language/say.js";

const STORE = "photos";
const FIRST_WIDTH_M = 0.8;

/**
 * @typedef {{url: string, blob: Blob, x: number, y: number, scale: number, width: number, height: number}} Shown
 * Its top left corner (m), metres per pixel, its size in pixels.
 */

export class Photo {
  /** @param {string} id the document's @param {() => void} onChange @param {(sentence: string) => void} refuse */
  constructor(id, onChange, refuse) {
    this.id = id;
    this.onChange = onChange;
    this.refuse = refuse;
    /** @type {Shown|null} */
    this.shown = null;
    this.load();
  }

  async load() {
    const kept = await this.transact("readonly", (store) => store.get(this.id)).catch(() => undefined);
    if (!kept) return;
    this.shown = { ...kept, url: URL.createObjectURL(kept.blob) };
    this.onChange();
  }

  /** Ask for a picture. */
  choose() {
    const input = document.createElement("input");
    input.type = "file";
    input.accept = "image/*";
    input.addEventListener("change", () => input.files?.[0] && this.put(input.files[0]));
    input.click();
  }

  /** @param {Blob} blob */
  async put(blob) {
    const picture = await createImageBitmap(blob).catch(() => null);
    if (!picture) {
      this.refuse(say("photo.no_picture"));
      return;
    }
    const { width, height } = picture;
    const scale = FIRST_WIDTH_M / width;
    this.remove();
    this.shown = { url: URL.createObjectURL(blob), blob, x: 0, y: height * scale, scale, width, height };
    this.keep();
  }

  /** @param {Partial<Shown>} change */
  change(change) {
    if (!this.shown) return;
    this.shown = { ...this.shown, ...change };
    this.keep();
  }

  remove() {
    if (!this.shown) return;
    clearTimeout(this.timer);
    URL.revokeObjectURL(this.shown.url);
    this.shown = null;
    this.onChange();
    this.transact("readwrite", (store) => store.delete(this.id)).catch(() => {});
  }

  keep() {
    this.onChange();
    clearTimeout(this.timer);
    if (!this.shown) return;
    const { url: _, ...kept } = this.shown;
    this.timer = setTimeout(() => this.transact("readwrite", (store) => store.put(kept, this.id)).catch(() => {}), 200);
  }

  /** @param {import("./view.js").View} view */
  items(view) {
    if (!this.shown) return [];
    const { url, x, y, scale, width, height } = this.shown;
    const [left, top] = view.toPx([x, y]);
    const px = scale * view.scale;
    return [
      {
        key: "photo",
        tag: "image",
        class: "photo",
        href: url,
        x: left,
        y: top,
        width: width * px,
        height: height * px,
        preserveAspectRatio: "none",
      },
    ];
  }

  /** @param {IDBTransactionMode} mode @param {(store: IDBObjectStore) => IDBRequest} work @returns {Promise<any>} */
  transact(mode, work) {
    return new Promise((resolve, reject) => {
      const opening = indexedDB.open("pleat", 1);
      opening.onupgradeneeded = () => opening.result.createObjectStore(STORE);
      opening.onerror = () => reject(opening.error);
      opening.onsuccess = () => {
        const transaction = opening.result.transaction(STORE, mode);
        transaction.oncomplete = () => opening.result.close();
        const request = work(transaction.objectStore(STORE));
        request.onsuccess = () => resolve(request.result);
        request.onerror = () => reject(request.error);
      };
    });
  }
}
