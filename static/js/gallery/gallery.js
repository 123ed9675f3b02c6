/** The gallery: one's documents, templates and examples as pictures; found by name, opened, copied, renamed, removed. */

import { ringOf } from "../board/curves.js";
import { OFFLINE, openDialog, sentenceOf } from "../dialogs/dialog.js";
import { goTo, goToNew } from "../dialogs/documents.js";
import { showNew } from "../dialogs/new.js";
import { askTitle, fileName } from "../dialogs/rename.js";
import { button, element, group, input, toldAloud } from "../dom.js";
import { listed } from "../garments.js";
import { icon } from "../icons.js";
import { inEnglish, say, translated } from "../language/say.js";
import { Menu } from "../menu.js";
import { garmentTile, tile, titleOf, when } from "./tile.js";

/** @import { DocumentEntry, DocumentState, DocumentVersion, GarmentEntry, Template } from "pleat" */

const DOCUMENTS = "../api/documents";

/** @param {import("../store.js").Store} store */
export function showGallery(store) {
  const gallery = new Gallery(store);
  gallery.load();
}

class Gallery {
  /** @param {import("../store.js").Store} store */
  constructor(store) {
    this.store = store;
    const find = say("gallery.find");
    this.search = input("field gallery-search", { type: "search", placeholder: find, ariaLabel: find });
    this.search.addEventListener("input", () => this.filter());
    this.own = row(say("gallery.yours"));
    this.templates = row(say("gallery.templates"));
    this.examples = row(say("gallery.examples"));
    this.said = toldAloud("dialog-problem", "alert");
    this.none = element("p", "dialog-text", say("gallery.nothing"));
    this.none.hidden = true;
    const rows = [this.own, this.templates, this.examples].map(({ root }) => root);
    this.removal = new Removal(
      (sentence) => this.say(sentence),
      () => this.loadOwn(),
    );
    const body = element("div", "gallery", this.search, this.removal.root, this.said, ...rows, this.none);
    this.dialog = openDialog(say("gallery.title"), "is-wide is-gallery", body);
    this.menu = new Menu();
    this.dialog.append(this.menu.root); // what is beside an open dialog can not be pressed
    this.dialog.addEventListener("close", () => this.removal.finish());
    this.dialog.addEventListener("keydown", (event) => this.onKey(event));
    this.search.focus();
  }

  async load() {
    const blank = tile(say("new.blank"), "", [], [], () => this.make({}, "outline"));
    await Promise.all([
      this.loadOwn(),
      fetched("../api/templates").then((/** @type {Template[]} */ found) =>
        this.templates.list.replaceChildren(
          blank,
          ...found.map(({ name, title, outline, folds }) =>
            tile(translated(title), "", outline, folds, () => this.fromTemplate(name)),
          ),
        ),
      ),
      fetched("../api/garments").then((/** @type {GarmentEntry[]} */ found) =>
        this.examples.list.replaceChildren(
          ...found.map((entry) => garmentTile(entry, () => this.make({ garment: entry.name }))),
        ),
      ),
    ]);
    this.filter();
  }

  async loadOwn() {
    /** @type {DocumentEntry[]} */
    const found = await listed(DOCUMENTS, []);
    const shown = found.filter(({ id, problem }) => problem === null && id !== this.removal.id);
    this.own.list.replaceChildren(...shown.map((entry) => this.ownTile(entry)));
    this.filter();
  }

  /** @param {DocumentEntry} entry */
  ownTile(entry) {
    const isOpen = entry.id === this.store.id;
    const { outline, folds } = entry.picture ?? { outline: [], folds: [] };
    const about = isOpen ? say("gallery.open_now") : when(entry.changed_at);
    const open = tile(titleOf(entry), about, outline, folds, () => (isOpen ? this.dialog.close() : goTo(entry.id)));
    const more = button("icon-button is-dense tile-more", () => this.openMenu(entry, more), icon("more"));
    more.setAttribute("aria-label", say("gallery.more_for", { title: titleOf(entry) }));
    more.setAttribute("aria-haspopup", "menu");
    open.addEventListener("contextmenu", (event) => {
      event.preventDefault();
      this.openMenu(entry, more);
    });
    const made = element("div", "tile-own", open, more);
    made.dataset.title = titleOf(entry);
    return made;
  }

  /** @param {DocumentEntry} entry @param {HTMLElement} opener */
  openMenu(entry, opener) {
    const isOpen = entry.id === this.store.id;
    const { left, bottom } = opener.getBoundingClientRect();
    /** @param {string} text @param {() => void} choose */
    const verb = (text, choose, isOff = false, hint = "") => ({ text, hint, isOff, choose });
    const verbs = [
      verb(say("gallery.duplicate"), () => this.duplicate(entry)),
      verb(say("rename.do"), () => this.rename(entry)),
      verb(say("gallery.versions"), () => showVersions(this.store, entry)),
      verb(say("gallery.delete"), () => this.remove(entry), isOpen, isOpen ? say("gallery.is_open") : ""),
    ];
    this.menu.open(titleOf(entry), verbs, opener, { x: left, y: bottom });
  }

  /** @param {DocumentEntry} entry */
  async duplicate({ id }) {
    const answer = await sent(DOCUMENTS, "POST", { copy_of: id });
    if (await this.isDone(answer)) this.loadOwn();
  }

  /** @param {DocumentEntry} entry */
  async rename(entry) {
    const answer = await renamed(entry);
    if (answer === undefined) return;
    if (await this.isDone(answer)) this.loadOwn();
  }

  /** @param {DocumentEntry} entry */
  remove(entry) {
    this.removal.begin(entry.id, titleOf(entry));
    this.loadOwn();
  }

  /** @param {string} name of a template */
  fromTemplate(name) {
    this.dialog.close();
    showNew(name);
  }

  /** @param {{garment?: string}} wanted */
  async make(wanted, tool = "") {
    const answer = await goToNew(wanted, tool).catch(() => null);
    await this.isDone(answer);
  }

  /** @param {Response|null} answer */
  async isDone(answer) {
    this.say(!answer ? OFFLINE : answer.ok ? "" : sentenceOf(await answer.json()));
    return Boolean(answer?.ok);
  }

  /** @param {string} sentence */
  say(sentence) {
    this.said.textContent = sentence;
  }

  /** Show what has the words of the search in its title. */
  filter() {
    const words = this.search.value.toLowerCase().split(/\s+/).filter(Boolean);
    let count = 0;
    for (const { root, list } of [this.own, this.templates, this.examples]) {
      const tiles = /** @type {HTMLElement[]} */ ([...list.children]);
      for (const one of tiles) one.hidden = !words.every((word) => one.dataset.title?.toLowerCase().includes(word));
      const shown = tiles.filter((one) => !one.hidden).length;
      root.hidden = shown === 0;
      count += shown;
    }
    this.none.hidden = count > 0;
  }

  /** Arrow keys lead from tile to tile, Enter in the search opens the first that is found. @param {KeyboardEvent} event */
  onKey(event) {
    const tiles = /** @type {HTMLElement[]} */ ([...this.dialog.querySelectorAll(".tile")]).filter(
      (one) => one.offsetParent,
    );
    if (event.key === "Enter" && event.target === this.search) return tiles[0]?.click();
    const by = { ArrowRight: 1, ArrowLeft: -1, ArrowDown: 1, ArrowUp: -1 }[event.key];
    const index = tiles.indexOf(/** @type {HTMLElement} */ (document.activeElement));
    const isFromSearch = event.target === this.search && event.key === "ArrowDown";
    if (!by || (index < 0 && !isFromSearch)) return;
    event.preventDefault();
    tiles[(index + by + tiles.length) % tiles.length]?.focus();
  }
}

/** A row of tiles under a heading. @param {string} title */
function row(title) {
  const list = element("div", "tiles");
  const root = element("section", "gallery-row", element("h3", "", title), list);
  group(list, title);
  return { root, list };
}

/** @param {string} address */
const fetched = (address) =>
  fetch(address)
    .then((answer) => (answer.ok ? answer.json() : []))
    .catch(() => []);

/** @param {string} address @param {string} method @param {any} body @returns {Promise<Response|null>} */
export const sent = (address, method, body) =>
  fetch(address, { method, headers: { "content-type": "application/json" }, body: JSON.stringify(body) }).catch(
    () => null,
  );

/**
 * The versions of a document by the step that led to each and its time; one of them is gone back to as one step.
 * @param {import("../store.js").Store} store
 * @param {DocumentEntry} entry
 */
async function showVersions(store, entry) {
  const said = element("p", "dialog-problem");
  const list = element("div", "tiles");
  const note = element("p", "dialog-text", say("versions.note"));
  const dialog = openDialog(say("versions.title", { title: titleOf(entry) }), "is-wide", note, said, list);
  const answer = await fetch(`../api/documents/${entry.id}/versions`).catch(() => null);
  if (!answer?.ok) {
    said.textContent = answer ? sentenceOf(await answer.json()) : OFFLINE;
    return;
  }
  /** @type {DocumentVersion[]} */
  const versions = await answer.json();
  if (!versions.length) note.textContent = say("versions.none");
  /** @param {DocumentVersion} version */
  const goBack = async ({ label, drawing }) => {
    const name = inEnglish("step.back_to", { step: label || inEnglish("step.first_drawing") });
    const done = await edited(entry.id, name, () => drawing);
    if (!done?.ok) said.textContent = done ? sentenceOf(await done.json()) : OFFLINE;
    else if (entry.id === store.id) for (const open of document.querySelectorAll("dialog")) open.close();
    else goTo(entry.id);
  };
  list.append(
    ...versions.map((version) => {
      const outline = ringOf(version.drawing);
      const folds = version.drawing.folds.map(({ kind, start, end }) => ({ kind, start: start.point, end: end.point }));
      const title = translated(version.label) || say("versions.first");
      return tile(title, when(version.changed_at), outline, folds, () => goBack(version));
    }),
  );
  /** @type {HTMLElement|null} */ (dialog.querySelector(".tile"))?.focus();
}

/** How long it can be had back (ms). */
const REGRET_MS = 8000;

/** A document that is deleted: for a while it can be had back, and only then it is removed for good. */
class Removal {
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

/** @param {DocumentEntry} entry @returns {Promise<Response|null|undefined>} the server's answer; undefined if it was not wanted */
async function renamed(entry) {
  const title = await askTitle(titleOf(entry));
  if (!title) return undefined;
  return edited(entry.id, inEnglish("step.rename_garment"), (drawing) => ({
    ...drawing,
    title,
    name: fileName(title),
  }));
}

/**
 * Change the drawing of any document as one step.
 * @param {string} id
 * @param {string} label
 * @param {(drawing: DocumentState["drawing"]) => DocumentState["drawing"]} change
 * @returns {Promise<Response|null>}
 */
async function edited(id, label, change) {
  const address = `../api/documents/${id}`;
  const found = await fetch(address).catch(() => null);
  if (!found?.ok) return found;
  /** @type {DocumentState} */
  const { version, drawing } = await found.json();
  const body = JSON.stringify({ base_version: version, label, drawing: change(drawing) });
  const headers = { "content-type": "application/json" };
  return fetch(`${address}/drawing`, { method: "PUT", headers, body }).catch(() => null);
}
