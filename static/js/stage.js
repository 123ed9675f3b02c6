/** The framed stage. Its own socket only looks for a lost server while it has the focus, so it is loaded anew. */

import { byId } from "./dom.js";

/**
 * @param {import("./store.js").Store} store
 * @param {(event: KeyboardEvent) => void} onKey keys pressed while the stage has the focus
 */
export function mountStage(store, onKey) {
  const frame = /** @type {HTMLIFrameElement} */ (byId("stage"));
  const load = () => {
    frame.src = `/viser/${store.id}/`;
  };
  frame.addEventListener("load", () => frame.contentDocument?.addEventListener("keydown", onKey));
  let wasLost = false;
  store.addEventListener("connection", () => {
    if (store.isLive && wasLost) load();
    wasLost = !store.isLive;
  });
  load();
}
