/**
 * The viewpoints, in the 3D view itself. The server moves the camera, as it rides along with the robot; which of its
 * sessions this page's frame is, a node of the frame's scene says (`app/ui/viewpoints/viewpoint_choice.py`).
 */

import { button, byId } from "./dom.js";
import { say } from "./language/say.js";

const VIEWS = /** @type {const} */ (["preset.follow", "preset.robot", "preset.top", "preset.side", "preset.free"]);
const CHANNEL = "/session/";

/** @typedef {{nodeRefFromName: Record<string, unknown>, sendMessage: (message: object) => void}} Viser */

export class View3DViews {
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
