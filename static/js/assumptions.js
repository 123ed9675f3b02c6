/**
 * What a drawing takes for granted of the world beyond what is usual: that grips hold more, that cloth slips less, that
 * reach needs less slack, that the robot can also stand elsewhere. Each is marked beside the status and at the folds it is about, and taken off by a click.
 */

import { button, element } from "./dom.js";
import { inEnglish, say } from "./language/say.js";
import { short } from "./messages/changes.js";
import { length } from "./messages/lengths.js";
import { place } from "./messages/names.js";
import { present } from "./present.js";
import { ownStations } from "./robots.js";
import { isViewOnly } from "./view_only.js";

/** @import { Drawing, Fold } from "pleat" */

/** What is usual (see planner.primitives.scene, planner.planning.make_plan). */
export const USUAL = { friction: 1, comfort_m: 0.03, grip_radius_m: 0.127 };

const SAME = 1e-9;

/** @typedef {[import("./language/say.js").Key, Record<string, string>]} Words */
/** @typedef {{kind: string, words: Words, off: (drawing: Drawing) => void}} Assumption */

/**
 * @param {Drawing} drawing
 * @param {string[]|null} own the stations of the robot's own scene; null while they are not known
 * @returns {Assumption[]}
 */
export function assumptions(drawing, own = null) {
  const { scene, comfort_radius_m: comfort, folds } = drawing;
  const wide = folds.filter((fold) => isWide(drawing, fold));
  const widest = Math.max(...wide.map((fold) => fold.grip_radius_m ?? 0));
  /** @type {(Assumption|false)[]} */
  const all = [
    wide.length > 0 && {
      kind: "grip_radius",
      words: ["assumption.grip", { radius: length(widest) }],
      off: narrow,
    },
    scene.friction > USUAL.friction + SAME && {
      kind: "friction",
      words: ["assumption.friction", { friction: short(scene.friction) }],
      off: (changed) => void (changed.scene.friction = USUAL.friction),
    },
    comfort < USUAL.comfort_m - SAME && {
      kind: "comfort_radius",
      words: ["assumption.comfort", { radius: length(comfort) }],
      off: (changed) => void (changed.comfort_radius_m = USUAL.comfort_m),
    },
    ...(own ? Object.keys(scene.stations).filter((name) => !own.includes(name)) : []).map(station),
  ];
  return present(all);
}

/** That the robot can also stand there. @param {string} name @returns {Assumption} */
const station = (name) => ({
  kind: "station",
  words: ["assumption.station", { station: place(name) }],
  off: (drawing) => {
    delete drawing.scene.stations[name];
    if (drawing.start_station === name) drawing.start_station = Object.keys(drawing.scene.stations)[0];
  },
});

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
  const made = button("chip assumed", onClick, text, element("span", "assumed-off for-editors", "\u2715"));
  made.setAttribute("aria-label", say("assumption.label", { what: text }));
  made.title = say("assumption.hint", { what: text });
  made.inert = isViewOnly;
  return made;
}

/** @param {import("./store.js").Store} store @param {HTMLElement} root beside the status */
export function mountAssumptions(store, root) {
  let shown = "";
  const show = () => {
    const { drawing } = store.state ?? {};
    const own = drawing ? ownStations(drawing.robot, show) : null;
    const found = drawing ? assumptions(drawing, own) : [];
    const wanted = found.map(({ words }) => say(...words)).join();
    if (wanted === shown) return;
    shown = wanted;
    root.hidden = !found.length;
    root.replaceChildren(
      ...found.map(({ words, off }) => {
        const step = inEnglish("step.assume_no", { what: inEnglish(...words) });
        return assumptionChip(say(...words), () => store.edit(step, off));
      }),
    );
  };
  store.addEventListener("document", show);
  addEventListener("unit", show);
  show();
}
