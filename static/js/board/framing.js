/**
 * What part of the plane is seen: the whole garment at first, then what the reader chooses. No edit ever moves it, but
 * what comes to lie over the board does, so that no cloth is hidden below it.
 */

import { ringOf } from "./curves.js";
import { boxOf } from "./geometry.js";

/** @import { Point } from "pleat" */
/** @import { View } from "./view.js" */

/** How wide a board with nothing on it is, and the middle of it (m). */
const BLANK_WIDE_M = 0.8;
const BLANK = {
  low: /** @type {Point} */ ([-0.05, 0.15]),
  high: /** @type {Point} */ ([0.55, 0.45]),
};
/** What is near the board's edge (a share of its size), and how much more is seen once an outline goes there. */
const EDGE = 0.1;
const WIDER = 1.4;
const BESIDE_TABLE_M = 0.3;
const BEFORE_TABLE_M = 0.6;
const BEYOND_TABLE_M = 0.1;
const HINT_PX = 24;
/** Between what covers the board's upper edge and the cloth (px). */
const GAP_PX = 12;
/** A board narrower than this is only looked at: it shows the whole cloth. */
const INSET_PX = 160;

/** @typedef {Pick<View, "scale"|"origin">} Seen */

/** @param {View} view @returns {Point} px */
const middleOf = ({ width, height }) => [width / 2, height / 2];

export class Framing {
  /** @param {import("./board.js").Board} board */
  constructor(board) {
    this.board = board;
    this.isFitted = false;
    /** The name of the garment that was fitted; whoever opens another, here or elsewhere, sees that whole. */
    this.name = "";
    /** What was seen when it was fitted last, and of what. @type {string|null} */
    this.fitted = null;
    /** Whether the board's upper edge is covered, and what was seen once room was made for that. */
    this.isCovered = false;
    this.roomMade = "";
    /** What was seen before it was covered, and whether that was all of the cloth. @type {(Seen & {isFit: boolean})|null} */
    this.free = null;
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
    const covered = { top: board.covered, bottom: HINT_PX, right: board.coveredSide };
    const box = board.isPlacing ? this.tableBox() : this.clothBox();
    board.view.fit(box ?? BLANK, covered);
    if (!box) board.view.zoomAt(middleOf(board.view), board.view.width / BLANK_WIDE_M / board.view.scale);
    this.fitted = this.seen();
    this.roomMade = this.where();
    if (this.free) this.free.isFit = true;
    board.render();
  }

  /**
   * The upper edge or the right side is covered, or more of it: make room for the cloth, unless somebody moves it or has
   * moved the view since it was free. What was seen whole is seen whole again; cloth drawn since is pushed as far as it
   * goes, or fitted.
   */
  uncover() {
    const { board } = this;
    const { covered, coveredSide: side, view, shown } = board;
    const isCovered = covered > 0 || side > 0;
    const isNew = isCovered && !this.isCovered;
    this.isCovered = isCovered;
    const isMoved = !isNew && this.roomMade !== this.where();
    const box = boxOf(shown.silhouette.flat()) ?? this.clothBox();
    const isFit = !this.isFitted || this.fitted === this.seen();
    if (isNew && !this.free) this.free = { scale: view.scale, origin: view.origin, isFit };
    if (isCovered && box && this.isFitted && !this.isInHand && !isMoved) {
      const { low, high } = this.onBoard(box);
      const isUnder = low[1] < covered || high[0] > view.width - side;
      const [down, most] = [covered + GAP_PX - low[1], view.height - HINT_PX - high[1]];
      const [left, room] = [high[0] + GAP_PX - (view.width - side), low[0]];
      const isAllSeen = Math.min(...low) >= 0 && high[0] <= view.width && high[1] <= view.height;
      if (isUnder && (isFit || (isAllSeen && most < down))) this.fit();
      else if (low[1] < covered && most > 0) view.pan([0, Math.min(down, most)]);
      else if (side && left > 0 && room > 0) view.pan([-Math.min(left, room), 0]);
    }
    if (!isMoved) this.roomMade = this.where();
    this.comeBack();
    board.render();
  }

  /** Nothing covers the board any more: show what was seen before, unless somebody has moved the view since. */
  comeBack() {
    const { board, free } = this;
    if (!free || this.isCovered || this.isInHand) return;
    this.free = null;
    if (this.roomMade !== this.where()) return;
    if (free.isFit) this.fit();
    else Object.assign(board.view, { scale: free.scale, origin: free.origin });
    this.roomMade = this.where();
    board.render();
  }

  /** Whether somebody is at work on the cloth. */
  get isInHand() {
    const { tool, state, store } = this.board;
    return Boolean(tool.isBusy || state?.gesture || store.selection);
  }

  /** A box of the garment frame as it lies on the board (px). @param {{low: Point, high: Point}} box */
  onBoard({ low, high }) {
    const corners = /** @type {Point[]} */ ([low, high, [low[0], high[1]], [high[0], low[1]]]);
    return /** @type {{low: Point, high: Point}} */ (boxOf(corners.map((corner) => this.board.view.toPx(corner))));
  }

  /** What part of the plane is seen. */
  where() {
    const { scale, origin } = this.board.view;
    return JSON.stringify([scale, origin]);
  }

  /** What is seen, and of what: the same as long as nobody has moved the view or pulled the cloth. */
  seen() {
    const { scale, origin } = this.board.view;
    return JSON.stringify([scale, origin, this.clothBox()]);
  }

  /** Show more of the plane around what is seen, at once. */
  widen() {
    const { board } = this;
    board.view.zoomAt([board.view.width / 2, (board.covered + board.view.height) / 2], 1 / WIDER);
    board.draw();
  }

  /** Show an outline whole whose last corner was put beside the board, as by a typed length. @param {Point[]} points */
  reveal(points) {
    const { board } = this;
    const { view, covered: top } = board;
    const [x, y] = view.toPx(points[points.length - 1]);
    if (x >= 0 && x <= view.width && y >= top && y <= view.height) return;
    view.fit(/** @type {{low: Point, high: Point}} */ (boxOf(points)), { top, bottom: HINT_PX });
    board.draw();
  }

  /** Whether a place on the board is near its edge. @param {Point} px */
  isAtEdge([x, y]) {
    const { covered, view } = this.board;
    const [across, down] = [x / view.width, (y - covered) / (view.height - covered)];
    return Math.min(across, 1 - across, down, 1 - down) < EDGE;
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

  /** To the table's axes, and back to the garment's as they were seen before. @param {boolean} isBack */
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
   * @param {Point[]|null} points garment frame
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
