/**
 * The combobox `Garment`: the documents there are, and the garments of which a new one can be made. Choosing goes to the
 * document; what is open stays as it is, under its own address.
 */

import { ringOf } from "./board/curves.js";
import { goTo, goToNew } from "./dialogs/documents.js";
import { sentenceOf } from "./dialogs/dialog.js";
import { picture } from "./dialogs/picture.js";
import { byId, element } from "./dom.js";
import { drawGarment, titleOf, when } from "./gallery/tile.js";
import { say, translated } from "./language/say.js";
import { pictured } from "./picture_menu.js";
import { isViewOnly } from "./view_only.js";

/** @import { DocumentEntry as Entry, Drawing, GarmentEntry } from "pleat" */

const DOCUMENTS = "../api/documents?limit=500";
const DOCUMENT = "document:";
const GARMENT = "garment:";

/** @param {import("./store.js").Store} store */
export function mountGarments(store) {
  const select = /** @type {HTMLSelectElement} */ (byId("garment"));
  /** @type {Entry[]} */
  let documents = [];
  /** @type {GarmentEntry[]} */
  let garments = [];
  let shown = "";
  let isLookedAt = false; // only then are the garments' pictures fetched

  const show = () => {
    if (!store.state) return;
    const { drawing } = store.state;
    const { name, title } = drawing;
    const own = { id: store.id, title, name, changed_at: "", problem: null, picture: null };
    const drawn = [own, ...documents.filter((entry) => entry.id !== store.id && entry.problem === null)];
    select.value = DOCUMENT + store.id;
    const wanted = JSON.stringify([drawn, garments]);
    if (wanted === shown) return; // a list that somebody has open stays as it is
    shown = wanted;
    const counts = counted(drawn);
    select.replaceChildren(
      group(
        say("garments.documents"),
        drawn.map((entry) => pictured(entry === own ? pictureOf(drawing) : inSmall(entry), called(entry, counts), DOCUMENT + entry.id)),
      ),
      group(
        say("garments.new_of"),
        garments.map((entry) => pictured(picture([], []), translated(entry.title), GARMENT + entry.name)),
      ),
    );
    select.value = DOCUMENT + store.id;
    if (isLookedAt) illustrate();
  };
  const illustrate = () => {
    for (const { value, firstElementChild } of select.options)
      if (value.startsWith(GARMENT) && firstElementChild) drawGarment(value.slice(GARMENT.length), firstElementChild);
  };
  const look = () => {
    if (store.state) select.selectedOptions[0]?.firstElementChild?.replaceWith(pictureOf(store.state.drawing));
    if (!isLookedAt) illustrate();
    isLookedAt = true;
    load();
  };
  const load = async () => {
    [documents, garments] = await Promise.all([listed(DOCUMENTS, documents), listed("../api/garments", garments)]);
    show();
  };
  const choose = async () => {
    const wanted = select.value;
    show(); // until the page is another one, it shows this document
    if (wanted.startsWith(DOCUMENT)) goTo(wanted.slice(DOCUMENT.length));
    else await make(store, wanted.slice(GARMENT.length));
  };

  select.addEventListener("change", choose);
  for (const name of ["focus", "pointerenter"]) select.addEventListener(name, look);
  store.addEventListener("document", show);
  store.addEventListener("connection", () => store.isLive && load());
}

/** @param {string} label @param {HTMLOptionElement[]} options */
export function group(label, options) {
  const made = /** @type {HTMLOptGroupElement} */ (element("optgroup", "", ...options));
  made.label = label;
  return made;
}

/** @param {Drawing} drawing */
function pictureOf(drawing) {
  const folds = drawing.folds.map(({ kind, start, end }) => ({ kind, start: start.point, end: end.point }));
  return picture(ringOf(drawing), folds);
}

/** @param {Entry} entry */
const inSmall = (entry) => picture(entry.picture?.outline ?? [], entry.picture?.folds ?? []);

/** How many documents have each title. @param {Entry[]} entries */
export function counted(entries) {
  /** @type {Map<string, number>} */
  const counts = new Map();
  for (const entry of entries) counts.set(titleOf(entry), (counts.get(titleOf(entry)) ?? 0) + 1);
  return counts;
}

/**
 * A document's title; when it was changed, too, where several have it.
 * @param {Entry} entry
 * @param {Map<string, number>} counts
 */
export function called(entry, counts) {
  const shown = titleOf(entry);
  const isAlone = (counts.get(shown) ?? 0) < 2;
  return isAlone || !entry.changed_at ? shown : `${shown}, ${when(entry.changed_at)}`;
}

/**
 * What the server lists, page by page to the end, or what it listed before.
 * @template T
 * @param {string} address
 * @param {T[]} before
 * @returns {Promise<T[]>}
 */
export async function listed(address, before) {
  /** @type {T[]} */
  const found = [];
  if (isViewOnly) return before; // the server lists nothing there
  for (let page = /** @type {string|null} */ (address); page;) {
    /** @type {Response|null} */
    const answer = await fetch(page).catch(() => null);
    if (!answer?.ok) return before;
    found.push(...(await answer.json()));
    page = following(answer);
  }
  return found;
}

/** The address of the page after an answer's; null if it is the last. @param {Response} answer */
function following(answer) {
  const next = /<([^>]*)>; rel="next"/.exec(answer.headers.get("link") ?? "");
  return next && new URL(next[1], answer.url).href;
}

/**
 * A new document of a garment, and the page on it.
 * @param {import("./store.js").Store} store
 * @param {string} garment its name
 */
async function make(store, garment) {
  const answer = await goToNew({ garment }).catch(() => null);
  if (!answer) store.refuse(say("server.nothing_opened"));
  else if (answer.status !== 201) store.refuse(sentenceOf(await answer.json()));
}
