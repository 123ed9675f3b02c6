/** What the overlays' shades and lines mean, in the corner of the board where the least cloth is. */

import { seconds } from "../dock/words.js";
import { element, svg } from "../dom.js";
import { say } from "../language/say.js";
import { armLetter } from "../messages/arms.js";
import { present } from "../present.js";
import { drawChecks } from "./draw_findings.js";
import { fullness } from "./draw_overlays.js";
import { isInside } from "./geometry.js";
import { length } from "./units.js";

/** @import { Overlays, Places, Point } from "pleat" */

/** The corners of the board, the best first where they are alike; on a phone the inset is in the last. */
const CORNERS = ["is-top is-right", "is-top is-left", "is-bottom is-left", "is-bottom is-right"];
const IS_PHONE = matchMedia("(max-width: 720px)");
/** So many places along each side of the legend are looked at for cloth. */
const LOOKS = 7;
/** No more of the board's height is taken. */
const MOST = 0.62;

export class Legend {
  /** @param {import("./board.js").Board} board */
  constructor(board) {
    this.board = board;
    this.root = element("ul", "legend");
    this.root.setAttribute("role", "list"); // a list without bullets is none to some readers otherwise
    this.root.setAttribute("aria-label", say("legend.title"));
    this.root.hidden = true;
    /** What is shown, on a board of which size. */
    this.shown = "";
    board.root.append(this.root);
  }

  draw() {
    const rows = legendRows(this.board);
    const { width, height } = this.board.place;
    const wanted = JSON.stringify([rows, width, height, this.over.length]);
    if (wanted === this.shown && !this.isUnder()) return;
    this.shown = wanted;
    this.root.hidden = !rows.length;
    this.root.replaceChildren(...rows.map(drawn));
    if (rows.length) this.settle();
  }

  /** What may lie over it: the fields of what is selected, and why there is no plan. */
  get over() {
    const why = /** @type {HTMLElement|null} */ (document.querySelector(".suggestion-strip"));
    return present([this.board.numbers.root, why ?? false]).filter(({ hidden }) => !hidden);
  }

  isUnder() {
    if (this.root.hidden) return false;
    const a = this.root.getBoundingClientRect();
    return this.over.some((part) => {
      const b = part.getBoundingClientRect();
      return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
    });
  }

  /**
   * In the corner with the least cloth and nothing over it; it stays there while the same is shown. Where only corners
   * with cloth are left it is read out alone.
   */
  settle() {
    const column = this.column();
    const covered = (IS_PHONE.matches ? CORNERS.slice(0, -1) : CORNERS).map((corner) => {
      this.root.className = `${column} ${corner}`;
      return { corner, cloth: this.isUnder() ? LOOKS ** 2 + 1 : this.cloth() };
    });
    const { corner, cloth } = covered.reduce((best, next) => (next.cloth < best.cloth ? next : best));
    const isFull = cloth > LOOKS && covered.some((one) => one.cloth > LOOKS ** 2);
    this.root.className = isFull ? "unseen" : `${column} ${corner}`;
  }

  /** Two columns where one is too high; where there is no room for them either, it is only read out. */
  column() {
    const most = MOST * this.board.place.height;
    /** @param {string} className */
    const fits = (className) => {
      this.root.className = className;
      return this.root.offsetHeight <= most;
    };
    return ["legend", "legend is-wide"].find(fits) ?? "unseen";
  }

  /** At how many of the places that are looked at there is cloth beneath. */
  cloth() {
    const { svg: sheet, view, shown } = this.board;
    const [here, there] = [this.root.getBoundingClientRect(), sheet.getBoundingClientRect()];
    /** @param {number} n */
    const share = (n) => n / (LOOKS - 1);
    const looks = Array.from({ length: LOOKS ** 2 }, (_, n) => [share(n % LOOKS), share(Math.floor(n / LOOKS))]);
    return looks.filter(([u, v]) => {
      const at = [here.x - there.x + u * here.width, here.y - there.y + v * here.height];
      return isInside(view.toM(/** @type {Point} */ (at)), shown.silhouette);
    }).length;
  }
}

/** @param {Row} row */
function drawn({ words, marks }) {
  const { width, height } = SWATCH;
  const swatch = svg("svg", { class: "legend-swatch", viewBox: `0 0 ${width} ${height}`, "aria-hidden": true });
  swatch.append(...marks.map(({ tag, ...attributes }) => svg(tag, attributes)));
  return element("li", "legend-row", swatch, words);
}

/** A swatch is so large, in the units that its marks are written in. */
const SWATCH = { width: 34, height: 18 };

/**
 * What a swatch is drawn of: an SVG element and its attributes.
 * @typedef {Record<string, unknown> & {tag: "path"|"rect"|"circle"}} Mark
 */
/** @typedef {{words: string, marks: Mark[]}} Row */

/**
 * A row for each kind of shade and line of the overlays that is drawn, and for no other.
 * @param {import("./board.js").Board} board
 * @returns {Row[]}
 */
function legendRows(board) {
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
