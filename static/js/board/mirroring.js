/** The verb `Mirror`: what is selected, or else the outline's left half, over the garment's axis, which is shown meanwhile. */

import { inEnglish } from "../language/say.js";
import { mirrorCorners, mirrorEdges, mirrorOutline } from "./mirror.js";

/** So long the axis is seen after something was mirrored over it by a key (ms). */
const AXIS_MS = 1500;

export class Mirroring {
  /** @param {import("./board.js").Board} board */
  constructor(board) {
    this.board = board;
    this.isAxisShown = false;
    /** @type {number|undefined} */
    this.timer = undefined;
  }

  /** Show the axis over which things are mirrored, or not any more. @param {boolean} isShown */
  showAxis(isShown) {
    clearTimeout(this.timer);
    this.isAxisShown = isShown;
    this.board.render();
  }

  /** The folds that are meant, or the selected corners or edges, or the outline's left half. */
  mirror() {
    const { board } = this;
    if (!this.isAxisShown) {
      this.showAxis(true);
      this.timer = setTimeout(() => this.showAxis(false), AXIS_MS);
    }
    const { kind, ids = [] } = board.store.selection ?? {};
    if (!board.drawing.outline.length || board.paint.mirror()) return;
    if (kind === "vertex") board.store.edit(inEnglish("step.mirror_vertices"), (drawing) => mirrorCorners(drawing, ids));
    else if (kind === "edge") board.store.edit(inEnglish("step.mirror_edges"), (drawing) => mirrorEdges(drawing, ids));
    else board.store.edit(inEnglish("step.mirror_outline"), mirrorOutline);
  }
}
