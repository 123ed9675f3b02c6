/** The versions of a document by the step that led to each and its time; one of them is gone back to as one step. */

import { goTo } from "../dialogs/documents.js";
import { openDialog, OFFLINE, sentenceOf } from "../dialogs/dialog.js";
import { element } from "../dom.js";
import { edited } from "./rename_document.js";
import { tile, titleOf, when } from "./tile.js";

/** @import { DocumentEntry, DocumentVersion } from "pleat" */

/** @param {import("../store.js").Store} store @param {DocumentEntry} entry */
export async function showVersions(store, entry) {
  const said = element("p", "dialog-problem");
  const list = element("div", "tiles");
  const note = element("p", "dialog-text", "Each step is kept. To go back is a step too, and can be undone.");
  const dialog = openDialog(`Versions of ${titleOf(entry)}`, "is-wide", note, said, list);
  const answer = await fetch(`../api/documents/${entry.id}/versions`).catch(() => null);
  if (!answer?.ok) {
    said.textContent = answer ? sentenceOf(await answer.json()) : OFFLINE;
    return;
  }
  /** @type {DocumentVersion[]} */
  const versions = await answer.json();
  if (!versions.length) note.textContent = "Nothing has been changed yet.";
  /** @param {DocumentVersion} version */
  const goBack = async ({ label, drawing }) => {
    const name = `Back to \u201C${label || "the first drawing"}\u201D`;
    const done = await edited(entry.id, name, () => drawing);
    if (!done?.ok) said.textContent = done ? sentenceOf(await done.json()) : OFFLINE;
    else if (entry.id === store.id) for (const open of document.querySelectorAll("dialog")) open.close();
    else goTo(entry.id);
  };
  list.append(
    ...versions.map((version) => {
      const outline = version.drawing.outline.map(({ point }) => point);
      const folds = version.drawing.folds.map(({ kind, start, end }) => ({ kind, start: start.point, end: end.point }));
      const title = version.label || "First drawing";
      return tile(title, when(version.changed_at), outline, folds, () => goBack(version));
    }),
  );
  /** @type {HTMLElement|null} */ (dialog.querySelector(".tile"))?.focus();
}
