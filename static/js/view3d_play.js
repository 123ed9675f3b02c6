/** On a phone the large 3D view has a button of its own to play and pause: the timeline is under the sheet. */

import { icon } from "./dock/icons.js";
import { byId } from "./dom.js";
import { say } from "./language/say.js";

/** @param {import("./store.js").Store} store @param {() => void} togglePlay */
export function mountView3DPlay(store, togglePlay) {
  const made = /** @type {HTMLButtonElement} */ (byId("view3d-play"));
  const show = () => {
    const { playing = false, duration_s: duration = 0 } = store.playback ?? {};
    const name = playing ? say("play.pause") : say("play.play");
    made.replaceChildren(icon(playing ? "pause" : "play"));
    made.setAttribute("aria-label", say("play.in_view3d", { what: name }));
    made.disabled = duration <= 0 || !store.isLive;
  };
  made.addEventListener("click", togglePlay);
  for (const name of ["playback", "connection"]) store.addEventListener(name, show);
  show();
}
