/**
 * The framed 3D view. Its own socket only looks for a lost server while it has the focus, so it is loaded anew. Until it
 * says that it is ready a quiet picture covers it.
 */

import { boxOf } from "./board/geometry.js";
import { Surface3D } from "./board/surface_3d.js";
import { seconds } from "./dock/words.js";
import { button, byId, element, svg } from "./dom.js";
import { smallIcon } from "./icons.js";
import { say } from "./language/say.js";
import { inWords } from "./proposals/cards.js";

/** What the frame says when it is ready, see app/api/view_3d_routes.py. */
const READY = "pleat-ready";
/** A table, and cloth on it. */
const TABLE = "M18 54L60 40L102 54L60 70ZM24 58V84M60 72V98M96 58V84";
const CLOTH = "M48 52L64 46L78 52L62 58Z";

const BY_SOFTWARE = /swiftshader|llvmpipe|softpipe|software|basic render/i;

/** Whether the browser has its processor draw 3-D, as far as it tells: the 3D view follows a hand less closely then. */
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
 * @param {(event: KeyboardEvent) => void} onKey keys pressed while the 3D view has the focus
 * @param {import("./board/board.js").Board} board whose tools act on the 3D view too
 */
export function mountView3D(store, onKey, board) {
  const frame = /** @type {HTMLIFrameElement} */ (byId("view3d"));
  new Surface3D(board, frame);
  const pace = isDrawnBySoftware() ? "by-software/" : "";
  const cover = picture();
  const views = new View3DViews(frame);
  frame.after(cover);
  addEventListener("message", ({ source, data }) => {
    if (source !== frame.contentWindow || data !== READY) return;
    cover.hidden = true;
    views.show(true);
  });
  const load = () => {
    cover.hidden = false;
    views.show(false);
    frame.src = `../viser/${store.id}/${pace}`;
  };
  frame.addEventListener("load", () => {
    frame.contentDocument?.addEventListener("keydown", onKey);
  });
  let wasLost = false;
  store.addEventListener("connection", () => {
    if (store.isLive && wasLost) load();
    wasLost = !store.isLive;
  });
  load();
}

function picture() {
  const drawn = svg("svg", { viewBox: "0 0 120 104", "aria-hidden": "true" });
  drawn.append(svg("path", { d: TABLE }), svg("path", { d: CLOTH, class: "view3d-cover-cloth" }));
  return element("div", "view3d-cover", drawn, element("p", "", say("view3d.being_set")));
}

const VIEWS = /** @type {const} */ (["preset.follow", "preset.robot", "preset.top", "preset.side", "preset.free"]);
const CHANNEL = "/session/";

/** @typedef {{nodeRefFromName: Record<string, unknown>, sendMessage: (message: object) => void}} Viser */

/**
 * The viewpoints, in the 3D view itself. The server moves the camera, as it rides along with the robot; which of its
 * sessions this page's frame is, a node of the frame's scene says (`app/ui/viewpoints/viewpoint_choice.py`).
 */
class View3DViews {
  /** @param {HTMLIFrameElement} frame */
  constructor(frame) {
    this.frame = frame;
    this.root = byId("viewpoints");
    this.root.replaceChildren(
      ...VIEWS.map((view) => {
        const made = button("viewpoint", () => this.look(view), say(view));
        made.title = say(`${view}_hint`);
        return made;
      }),
    );
  }

  /** @param {boolean} isThere whether it can be looked at */
  show(isThere) {
    this.root.hidden = !isThere;
  }

  /** @param {typeof VIEWS[number]} view */
  look(view) {
    const viser = /** @type {{__viserMutable?: Viser}} */ (this.frame.contentWindow ?? {}).__viserMutable;
    const node = Object.keys(viser?.nodeRefFromName ?? {}).find((name) => name.startsWith(CHANNEL));
    if (!viser || !node) return;
    viser.sendMessage({ type: "GuiUpdateMessage", uuid: node.slice(CHANNEL.length), updates: { value: view } });
  }
}

/**
 * On a phone the large 3D view has a button of its own to play and pause: the timeline is under the sheet.
 * @param {import("./store.js").Store} store
 * @param {() => void} togglePlay
 */
export function mountView3DPlay(store, togglePlay) {
  const made = /** @type {HTMLButtonElement} */ (byId("view3d-play"));
  const show = () => {
    const { playing = false, duration_s: duration = 0 } = store.playback ?? {};
    const name = playing ? say("play.pause") : say("play.play");
    made.replaceChildren(smallIcon(playing ? "pause" : "play"));
    made.setAttribute("aria-label", say("play.in_view3d", { what: name }));
    made.disabled = duration <= 0 || !store.isLive;
  };
  made.addEventListener("click", togglePlay);
  for (const name of ["playback", "connection"]) store.addEventListener(name, show);
  show();
}

/** So near to its end a plan counts as played: the timeline's slider goes in steps (s). */
const AT_END_S = 0.05;

/**
 * A card over the 3D view once the plan has been played to its end: the packet's size, the plan's time, a way to share it.
 * @param {import("./store.js").Store} store
 */
export function mountView3DEnd(store) {
  const words = element("span", "");
  const share = button("chip for-editors", () => byId("share").click(), say("bar.share"));
  const card = element("div", "view3d-end", words, share);
  card.setAttribute("role", "status");
  const show = () => {
    const { playing = false, t_s: now = 0, duration_s: duration = 0 } = store.playback ?? {};
    const plan = store.plan?.plan;
    const box = boxOf((plan?.final_layers ?? []).flatMap(({ polygon }) => polygon));
    card.hidden = !plan || !box || playing || duration <= 0 || now < duration - AT_END_S;
    if (card.hidden || !plan || !box) return;
    const size = inWords([box.high[0] - box.low[0], box.high[1] - box.low[1]]);
    words.textContent = `${size}, ${seconds(plan.cost_s ?? duration)}`;
  };
  byId("view3d-pane").append(card);
  for (const name of ["playback", "plan"]) store.addEventListener(name, show);
  show();
}
