/** `Undo` and `Redo`, each with the name of the step that it would take. */

import { byId } from "./dom.js";
import { icon } from "./icons.js";

/**
 * @param {import("./store.js").Store} store
 * @param {{undo: () => void, redo: () => void}} verbs what they do
 */
export function mountHistory(store, verbs) {
  const undo = /** @type {HTMLButtonElement} */ (byId("undo"));
  const redo = /** @type {HTMLButtonElement} */ (byId("redo"));
  undo.append(icon("undo"));
  redo.append(icon("redo"));
  undo.addEventListener("click", verbs.undo);
  redo.addEventListener("click", verbs.redo);
  store.addEventListener("document", () => {
    const { can_undo: back, can_redo: again } = store.state.history;
    undo.disabled = back === null;
    redo.disabled = again === null;
    undo.title = back === null ? "Nothing to undo" : `Undo: ${back} (Ctrl+Z)`;
    redo.title = again === null ? "Nothing to redo" : `Redo: ${again} (Ctrl+Shift+Z)`;
  });
}
