/** Another name for a document of the gallery, which need not be the one that is open. */

import { askTitle, fileName } from "../dialogs/rename.js";
import { inEnglish } from "../language/say.js";
import { titleOf } from "./tile.js";

/** @import { DocumentEntry, DocumentState } from "pleat" */

/** @param {DocumentEntry} entry @returns {Promise<Response|null|undefined>} the server's answer; undefined if it was not wanted */
export async function renamed(entry) {
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
export async function edited(id, label, change) {
  const address = `../api/documents/${id}`;
  const found = await fetch(address).catch(() => null);
  if (!found?.ok) return found;
  /** @type {DocumentState} */
  const { version, drawing } = await found.json();
  const body = JSON.stringify({ base_version: version, label, drawing: change(drawing) });
  const headers = { "content-type": "application/json" };
  return fetch(`${address}/drawing`, { method: "PUT", headers, body }).catch(() => null);
}
