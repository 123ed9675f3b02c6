/**
 * What a drawing takes for granted of the world beyond what is usual: that grips hold more, that cloth slips less, that
 * reach needs less slack. Each is marked beside the status and at the folds it is about, and taken off by a click.
 */

import { button, element } from "./dom.js";
import { length } from "./messages/lengths.js";
import { present } from "./present.js";

/** @import { Drawing, Fold } from "pleat" */

/** What is usual (see planner.primitives.scene, planner.planning.make_plan). */
export const USUAL = { friction: 1, comfort_m: 0.03, grip_radius_m: 0.127 };

const SAME = 1e-9;

/** @typedef {{kind: string, text: string, off: (drawing: Drawing) => void}} Assumption */

/** @param {Drawing} drawing @returns {Assumption[]} */
export function assumptions(drawing) {
  const { scene, comfort_radius_m: comfort, folds } = drawing;
  const wide = folds.filter((fold) => isWide(drawing, fold));
  const widest = Math.max(...wide.map((fold) => fold.grip_radius_m ?? 0));
  /** @type {(Assumption|false)[]} */
  const all = [
    wide.length > 0 && {
      kind: "grip_radius",
      text: `grip ${length(widest)}`,
      off: narrow,
    },
    scene.friction > USUAL.friction + SAME && {
      kind: "friction",
      text: `friction ${Number(scene.friction.toPrecision(3))}`,
      off: (changed) => void (changed.scene.friction = USUAL.friction),
    },
    comfort < USUAL.comfort_m - SAME && {
      kind: "comfort_radius",
      text: `comfort ${length(comfort)}`,
      off: (changed) => void (changed.comfort_radius_m = USUAL.comfort_m),
    },
  ];
  return present(all);
}

/**
 * Whether a grip at a fold is taken to hold more than the garment's own. Where drags need that too, the garment's is as
 * wide, and the fold says so for itself.
 * @param {Drawing} drawing
 * @param {Fold} fold
 */
export const isWide = (drawing, { grip_radius_m: radius }) =>
  radius !== null && (radius > drawing.grip_radius_m + SAME || isWideInDrags(drawing, radius));

/** @param {Drawing} drawing @param {number|null} radius */
const isWideInDrags = ({ grip_radius_m: own }, radius) =>
  radius !== null && Math.abs(radius - own) <= SAME && own > USUAL.grip_radius_m + SAME;

/** Have grips hold what they usually do. @param {Drawing} drawing */
function narrow(drawing) {
  const wide = drawing.folds.filter((fold) => isWide(drawing, fold));
  if (wide.some((fold) => isWideInDrags(drawing, fold.grip_radius_m))) drawing.grip_radius_m = USUAL.grip_radius_m;
  for (const fold of wide) fold.grip_radius_m = null;
}

/** A mark of an assumption, pressed to take it off. @param {string} text @param {() => void} onClick */
export function assumptionChip(text, onClick) {
  const made = button("chip assumed", onClick, text, element("span", "assumed-off", "\u2715"));
  made.setAttribute("aria-label", `Assumed: ${text}. Take it off`);
  made.title = `Assumed: ${text}. Click to take it off.`;
  return made;
}

/** @param {import("./store.js").Store} store @param {HTMLElement} root beside the status */
export function mountAssumptions(store, root) {
  let shown = "";
  const show = () => {
    const found = store.state ? assumptions(store.state.drawing) : [];
    const wanted = found.map(({ kind, text }) => `${kind} ${text}`).join();
    if (wanted === shown) return;
    shown = wanted;
    root.hidden = !found.length;
    root.replaceChildren(
      ...found.map(({ text, off }) => assumptionChip(text, () => store.edit(`Assume no ${text}`, off))),
    );
  };
  store.addEventListener("document", show);
  addEventListener("unit", show);
  show();
}
