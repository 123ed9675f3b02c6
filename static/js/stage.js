/** The framed stage. Its own socket only looks for a lost server while it has the focus, so it is loaded anew. */

import { byId } from "./dom.js";

const BY_SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;

/** Whether the browser has its processor draw 3-D, as far as it tells: the stage follows a hand less closely then. */
function isDrawnBySoftware() {
  const gl = document.createElement("canvas").getContext("webgl");
  if (!gl) return false;
  const told = gl.getExtension("WEBGL_debug_renderer_info")?.UNMASKED_RENDERER_WEBGL ?? gl.RENDERER;
  const isSlow = BY_SOFTWARE.test(String(gl.getParameter(told)));
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return isSlow;
}

/**
 * @param {import("./store.js").Store} store
 * @param {(event: KeyboardEvent) => void} onKey keys pressed while the stage has the focus
 */
export function mountStage(store, onKey) {
  const frame = /** @type {HTMLIFrameElement} */ (byId("stage"));
  const pace = isDrawnBySoftware() ? "by-software/" : "";
  const load = () => {
    frame.src = `../viser/${store.id}/${pace}`;
  };
  frame.addEventListener("load", () => frame.contentDocument?.addEventListener("keydown", onKey));
  let wasLost = false;
  store.addEventListener("connection", () => {
    if (store.isLive && wasLost) load();
    wasLost = !store.isLive;
  });
  load();
}
