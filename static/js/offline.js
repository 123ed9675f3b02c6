/** Without a server what changes the document is at rest; the board says why, and what has been done is kept. */

import { byId } from "./dom.js";
import { say } from "./language/say.js";

const PARTS = "#rail, .strip [aria-label=Fold], .bar-group, #garment, #new, #import, #export, .fold-list, .suggestions";

/** What the board says then. @param {import("./store.js").Store} store */
export const offlineHint = (store) => (store.queue.isHeld ? say("offline.kept") : say("offline.wait"));

/** @param {import("./store.js").Store} store */
export function mountOffline(store) {
  const show = () => {
    document.body.classList.toggle("is-offline", store.isLost);
    for (const part of document.querySelectorAll(PARTS)) part.toggleAttribute("inert", store.isLost);
    byId("board").setAttribute("aria-disabled", String(store.isLost));
  };
  store.addEventListener("connection", show);
}
