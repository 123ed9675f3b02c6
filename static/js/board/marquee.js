/** A frame pulled open round corners. */

/** @import { Point } from "pleat" */

/** @typedef {[Point, Point]} Frame two opposite corners (px) */

/** @param {Frame} frame */
export function marquee([[ax, ay], [bx, by]]) {
  return {
    key: "frame",
    tag: "rect",
    class: "marquee",
    x: Math.min(ax, bx),
    y: Math.min(ay, by),
    width: Math.abs(bx - ax),
    height: Math.abs(by - ay),
  };
}

/**
 * The corners within, or else the folds whose ends both are.
 * @param {import("./board.js").Board} board
 * @param {Frame} frame
 * @returns {import("../store.js").Selection|null}
 */
export function cornersWithin(board, [[ax, ay], [bx, by]]) {
  /** @param {Point} point */
  const isIn = (point) => {
    const [x, y] = board.view.toPx(point);
    return (x - ax) * (x - bx) <= 0 && (y - ay) * (y - by) <= 0;
  };
  const corners = board.isSpread ? board.drawing.outline.filter(({ point }) => isIn(point)) : [];
  if (corners.length) return { kind: "vertex", ids: corners.map(({ id }) => id) };
  const folds = board.drawing.folds.filter(
    ({ start, end }, index) => index >= board.step && isIn(start.point) && isIn(end.point),
  );
  return folds.length ? { kind: "fold", ids: folds.map(({ id }) => id) } : null;
}
