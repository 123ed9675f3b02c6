/** What part of the plane is seen: the whole garment at first, then what the reader chooses; no edit ever moves it. */

import { ringOf } from "./curves.js";
import { boxOf } from "./geometry.js";

/** @import { Point } from "pleat" */
/** @import { View } from "./view.js" */

/** What is seen of a board with nothing on it: room for a garment, wherever it begins (m). */
const BLANK = {
  low: /** @type {Point} */ ([-0.6, -0.45]),
  high: /** @type {Point} */ ([0.9, 0.85]),
};
const BESIDE_TABLE_M = 0.3;
const BEFORE_TABLE_M = 0.6;
const BEYOND_TABLE_M = 0.1;
const HINT_PX = 24;
/** A board narrower than this is only looked at: it shows the whole cloth. */
const INSET_PX = 160;

/** @typedef {Pick<View, "scale"|"origin">} Seen */

export class Framing {
  /** @param {import("./board.js").Board} board */
  constructor(board) {
    this.board = board;
    this.isFitted = false;
    /** The name of the garment that was fitted; whoever opens another, here or elsewhere, sees that whole. */
    this.name = "";
    /** What was seen when it was fitted last, and of what. @type {string|null} */
    this.fitted = null;
    /** The view of the large board while it is an inset. @type {Seen & Pick<View, "width"|"height">|null} */
    this.full = null;
    /** What was seen before the robot's way was to be seen as well. @type {Seen|null} */
    this.narrow = null;
    /** What was seen with the robot's way. */
    this.wide = "";
    /** What was seen before the table's axes were. @type {Seen|null} */
    this.before = null;
  }

  fit() {
    const { board } = this;
    board.view.fit(board.isPlacing ? this.tableBox() : (this.clothBox() ?? BLANK), { top: board.covered, bottom: HINT_PX });
    this.fitted = this.seen();
    board.render();
  }

  /** Fit again where nobody has moved the view since, once the upper edge is covered, so that no cloth is hidden. */
  uncover() {
    const { tool, state, store, covered, view } = this.board;
    const box = this.clothBox();
    const isUntouched = this.isFitted && this.fitted === this.seen() && !tool.isBusy && !state?.gesture && !store.selection;
    if (covered && box && isUntouched && view.toPx(box.high)[1] < covered) this.fit();
    this.board.render();
  }

  /** What is seen, and of what: the same as long as nobody has moved the view or pulled the cloth. */
  seen() {
    const { scale, origin } = this.board.view;
    return JSON.stringify([scale, origin, this.clothBox()]);
  }

  /** Fit once for each garment, when there is something to be fitted to a board that has a size. */
  fitFirst() {
    if (!this.board.state || this.board.view.width <= 1) return;
    const { name } = this.board.drawing;
    if (this.isFitted && this.name === name) return;
    this.isFitted = true;
    this.name = name;
    this.fit();
  }

  /** Another garment is coming: it shall be seen whole. */
  fitNext() {
    this.isFitted = false;
    this.board.render();
  }

  /** To the table's axes, and back to the article's as they were seen before. @param {boolean} isBack */
  turn(isBack) {
    const { view, drawing } = this.board;
    if (isBack && this.before) Object.assign(view, this.before);
    if (!isBack) this.before = { scale: view.scale, origin: view.origin };
    view.lay(isBack ? null : drawing.placement);
    if (!isBack) this.fit();
  }

  /**
   * See the robot's way as well, which mostly is beside the cloth; without one, what was seen before unless the view has
   * been moved since.
   * @param {Point[]|null} points article frame
   */
  showAlso(points) {
    const { view, svg } = this.board;
    if (points && !this.narrow && !this.board.isPlacing) {
      /** @param {Point} px */
      const isSeen = (px) => px[0] > 0 && px[1] > 0 && px[0] < svg.clientWidth && px[1] < svg.clientHeight;
      if (points.every((point) => isSeen(view.toPx(point)))) return;
      const { low, high } = this.clothBox() ?? BLANK;
      this.narrow = { scale: view.scale, origin: view.origin };
      const box = boxOf([low, high, ...points]);
      view.fit(/** @type {NonNullable<typeof box>} */ (box), { top: 0, bottom: HINT_PX });
      this.wide = this.seen();
      this.board.render();
    } else if (!points && this.narrow) {
      if (this.seen() === this.wide) Object.assign(view, this.narrow);
      this.narrow = null;
      this.board.render();
    }
  }

  clothBox() {
    const { drawing, shown } = this.board;
    return boxOf([...ringOf(drawing), ...shown.silhouette.flat()]);
  }

  tableBox() {
    const { depth_m: deep, width_m: wide } = this.board.drawing.scene.table;
    return {
      low: /** @type {Point} */ ([-wide / 2 - BESIDE_TABLE_M, -deep / 2 - BEFORE_TABLE_M]),
      high: /** @type {Point} */ ([wide / 2 + BESIDE_TABLE_M, deep / 2 + BEYOND_TABLE_M]),
    };
  }

  /** The middle stays in the middle; what was seen whole and has not been touched since is seen whole again. */
  resize() {
    const { svg, view, tool, state } = this.board;
    const { clientWidth: width, clientHeight: height } = svg;
    if (!width || !height) return;
    const isUntouched = state !== null && this.isFitted && !tool.isBusy && this.fitted === this.seen();
    const isInset = width < INSET_PX;
    if (isInset && !this.full) this.full = { ...view };
    if (!isInset && this.full) Object.assign(view, this.full, { pose: view.pose });
    if (!isInset) this.full = null;
    view.pan([(width - view.width) / 2, (height - view.height) / 2]);
    Object.assign(view, { width, height });
    if (isInset || isUntouched) this.fit();
    else this.fitFirst();
    this.board.render();
  }
}
