/** The versions of a document by the step that led to each and its time; one of them is gone back to as one step. */

import { ringOf } from "../board/curves.js";
import { goTo } from "../dialogs/documents.js";
import { openDialog, OFFLINE, sentenceOf } from "../dialogs/dialog.js";
import { element } from "../dom.js";
import { inEnglish, say, translated } from "../language/say.js";
import { edited } from "./rename_document.js";
import { tile, titleOf, when } from "./tile.js";

/** @import { DocumentEntry, DocumentVersion } from "pleat" */

/** @param {import("../store.js").Store} store @param {DocumentEntry} entry */
export async function showVersions(store, entry) {
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
