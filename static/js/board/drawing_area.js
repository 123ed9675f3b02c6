/** The element that the board draws on, and its layers. */

import { svg } from "../dom.js";
import { say } from "../language/say.js";
import { LAYERS } from "./draw_all.js";
import { Sheet } from "./sheet.js";

/** @import { LayerName } from "./draw_all.js" */

/** The events of the store after which the board is drawn anew. */
export const REDRAWN_AT = [
  "document",
  "plan",
  "playback",
  "selection",
  "step",
  "overlays",
  "preview",
  "hover-time",
  "connection",
  "held",
];

/** The element that is drawn on. */
export function drawingArea() {
  return svg("svg", {
    class: "board",
    id: "drafting-board",
    role: "application",
    "aria-label": say("board.label"),
    "aria-busy": "true",
    tabindex: 0,
  });
}

/** Layers of what a hand takes hold of. @type {Set<LayerName>} */
const HANDLED = new Set(["handles", "tool", "cursor"]);

/** A sheet for each layer, the lowest first. @param {SVGElement} scene */
export function sheetsOf(scene) {
  const sheets = LAYERS.map((name) => {
    const sheet = new Sheet(scene, HANDLED.has(name) ? `layer-${name} for-editors` : `layer-${name}`);
    sheet.root.id = `board-${name}`; // the 3D view shows some of them too
    return [name, sheet];
  });
  return /** @type {Record<LayerName, Sheet>} */ (Object.fromEntries(sheets));
}

const WIDTH_PX = 7;

/**
 * Stripes at 45 degrees: on the backs of cloth, and where cloth will land; the other way where a hand cannot go or no
 * table is.
 * @returns {SVGElement}
 */
export function hatches() {
  const defs = svg("defs");
  for (const [name, turn_deg] of Object.entries({ back: 45, ghost: 45, beyond: -45 })) {
    const pattern = svg("pattern", {
      id: `hatch-${name}`,
      width: WIDTH_PX,
      height: WIDTH_PX,
      patternUnits: "userSpaceOnUse",
      patternTransform: `rotate(${turn_deg})`,
    });
    pattern.append(svg("path", { class: `hatch-${name}`, d: `M0 0V${WIDTH_PX}` }));
    defs.append(pattern);
  }
  return defs;
}
