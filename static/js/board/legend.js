/** What the overlays' shades and lines mean, in the corner of the board where the least cloth is. */

import { element } from "../dom.js";
import { say } from "../language/say.js";
import { isInside } from "./geometry.js";
import { legendRows, SWATCH } from "./legend_rows.js";
import { svg } from "./sheet.js";

/** @import { Point } from "pleat" */

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
    const wanted = JSON.stringify([rows, width, height]);
    if (wanted === this.shown && !this.isUnder()) return;
    this.shown = wanted;
    this.root.hidden = !rows.length;
    this.root.replaceChildren(...rows.map(drawn));
    if (rows.length) this.settle();
  }

  /** Whether the fields of what is selected lie over it. */
  isUnder() {
    const fields = this.board.numbers.root;
    if (this.root.hidden || fields.hidden) return false;
    const [a, b] = [this.root.getBoundingClientRect(), fields.getBoundingClientRect()];
    return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
  }

  /** In the corner with the least cloth and no fields; it stays there while the same is shown. */
  settle() {
    const column = this.column();
    const covered = (IS_PHONE.matches ? CORNERS.slice(0, -1) : CORNERS).map((corner) => {
      this.root.className = `${column} ${corner}`;
      return { corner, cloth: this.isUnder() ? LOOKS ** 2 + 1 : this.cloth() };
    });
    const { corner } = covered.reduce((best, next) => (next.cloth < best.cloth ? next : best));
    this.root.className = `${column} ${corner}`;
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

/** @param {import("./legend_rows.js").Row} row */
function drawn({ words, marks }) {
  const { width, height } = SWATCH;
  const swatch = svg("svg", { class: "legend-swatch", viewBox: `0 0 ${width} ${height}`, "aria-hidden": true });
  swatch.append(...marks.map(({ tag, ...attributes }) => svg(tag, attributes)));
  return element("li", "legend-row", swatch, words);
}
