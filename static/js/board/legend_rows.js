/** What the shades and lines of the overlays mean: a row for each kind of them that is drawn, and for no other. */

import { seconds } from "../dock/words.js";
import { say } from "../language/say.js";
import { present } from "../present.js";
import { drawChecks } from "./draw_findings.js";
import { fullness } from "./draw_overlays.js";
import { length } from "./units.js";
import { armLetter } from "../messages/arms.js";

/** @import { Overlays, Places } from "pleat" */

/** A swatch is so large, in the units that its marks are written in. */
export const SWATCH = { width: 34, height: 18 };

/**
 * What a swatch is drawn of: an SVG element and its attributes.
 * @typedef {Record<string, unknown> & {tag: "path"|"rect"|"circle"}} Mark
 */
/** @typedef {{words: string, marks: Mark[]}} Row */

/** @param {import("./board.js").Board} board @returns {Row[]} */
export function legendRows(board) {
  const { overlays, store } = board;
  const grips = store.overlays.has("grips") ? drawChecks(board) : [];
  const drawn = new Set([...overlays.drawn, ...grips].filter(isSeen).map((item) => String(item.class)));
  return [
    ...reach(overlays.found, drawn),
    ...PLAIN.filter(({ marks }) => marks.every((mark) => drawn.has(mark.class))),
    ...costs(overlays.places),
  ];
}

/** A path of one point leaves no trace. @param {import("./sheet.js").Item} item */
const isSeen = ({ tag, d }) => tag !== "path" || /[Lh]/.test(String(d));

/** @param {string} className @param {string} d */
const line = (className, d = "M1 9L33 9") => /** @type {const} */ ({ tag: "path", class: className, d });
/** @param {string} className @param {number} x @param {number} width */
const cell = (className, x, width = 15) =>
  /** @type {const} */ ({ tag: "rect", class: className, x, y: 2, width, height: 14 });

/** What means the same at every moment. @type {{words: string, marks: (Mark & {class: string})[]}[]} */
const PLAIN = [
  { words: say("legend.slip"), marks: [line("slip")] },
  { words: say("legend.base"), marks: [cell("robot-base", 9)].map((mark) => ({ ...mark, rx: 1 })) },
  { words: say("legend.base_way"), marks: [line("base-way")] },
  { words: say("legend.base_stand"), marks: [line("base-stand", "M8 9a4 4 0 1 0 8 0a4 4 0 1 0 -8 0M12 9L28 9")] },
  {
    words: say("legend.hand_now"),
    marks: [line("hand-path is-now", "M1 9L20 9"), end("hand-end is-now")],
  },
  { words: say("legend.hand_other"), marks: [line("hand-path", "M1 9L20 9"), end("hand-end")] },
  { words: say("legend.must_hold"), marks: [line("must-hold", "M17 2L24 9L17 16L10 9Z")] },
  { words: say("legend.grip"), marks: [{ tag: "circle", class: "grip", cx: 17, cy: 9, r: 8 }] },
];

/** @param {string} className */
function end(className) {
  return /** @type {const} */ ({ tag: "circle", class: className, cx: 26, cy: 9, r: 6 });
}

/**
 * Shades with comfort, where they overlap twice as strong; and a line round what is within reach at all.
 * @param {Overlays|null} found
 * @param {Set<string>} drawn
 * @returns {Row[]}
 */
function reach(found, drawn) {
  const arms = (found?.reach ?? []).filter(({ arm }) => drawn.has(`reach is-${arm}`));
  const letters = arms.map(({ arm }) => armLetter(arm));
  const comfort = found?.reach?.[0]?.comfort_m ?? 0;
  const shades = arms.flatMap((_, n) => [cell("reach", 2 + 10 * n, 20), cell("reach-line", 2 + 10 * n, 20)]);
  const told = { hands: letters.join(", "), comfort: length(comfort) };
  const words = say(`legend.can_grip${comfort > 0 ? "_comfort" : ""}${arms.length > 1 ? "_both" : ""}`, told);
  return present([
    arms.length > 0 && { words, marks: shades },
    comfort > 0 &&
      drawn.has("reach-line is-bare") && { words: say("legend.bare"), marks: [line("reach-line is-bare")] },
  ]);
}

/** @param {Places|null} places @returns {Row[]} */
function costs(places) {
  const known = (places?.cells ?? []).map(({ cost_s }) => cost_s).filter((cost) => cost !== null);
  const [least, most] = [Math.min(...known), Math.max(...known)].map((cost) => seconds(cost).replace(" ", "\u00A0"));
  const shades = [0, 1, 2, 3].map((n) => ({ ...cell("cost", 1 + 8 * n, 8), "fill-opacity": fullness(1 - n / 3) }));
  const words = say(least === most ? "legend.cost" : "legend.costs", { least, most });
  return present([
    known.length > 0 && { words, marks: shades },
    places && known.length < places.cells.length && { words: say("legend.no_plan"), marks: [cell("cost is-none", 9)] },
    places && !places.complete && { words: say("legend.untried"), marks: [] },
  ]);
}
