/** `Undo` and `Redo`, each with the name of the step that it would take. */

import { byId } from "./dom.js";
import { icon } from "./icons.js";
import { say, translated } from "./language/say.js";

/** @param {import("./store.js").Store} store @param {{undo: () => void, redo: () => void}} verbs what they do */
export function mountHistory(store, verbs) {
  const undo = /** @type {HTMLButtonElement} */ (byId("undo"));
  const redo = /** @type {HTMLButtonElement} */ (byId("redo"));
  undo.append(icon("undo"));
  redo.append(icon("redo"));
  undo.addEventListener("click", verbs.undo);
  redo.addEventListener("click", verbs.redo);
  const show = () => {
    const { can_undo: step = null, can_redo: again = null } = store.state?.history ?? {};
    const back = store.begun || (step && translated(step));
    undo.disabled = !back;
    redo.disabled = again === null;
    undo.title = back ? say("history.undo_step", { step: back }) : say("history.nothing_to_undo");
    redo.title =
      again === null ? say("history.nothing_to_redo") : say("history.redo_step", { step: translated(again) });
  };
  for (const name of ["document", "begun"]) store.addEventListener(name, show);
}
