/** Marks that come and go: the snap in force by its name, and what a suggestion would change. */

import { dimension } from "./draw_dimension.js";
import { foldItems } from "./draw_folds.js";
import { path } from "./sheet.js";
import { distance, toInner, toOuter } from "./geometry.js";
import { middleOf } from "./edits.js";
import { length } from "./units.js";

/** @param {import("./board.js").Board} board */
export function drawCursor({ snapped, view, said }) {
  if (!snapped) return [];
  const [x, y] = view.toPx(snapped.at);
  const text = said || snapped.name;
  if (!text) return [];
  const isRight = x > view.width - 120;
  return [
    snapped.key !== "" && { key: "snap", tag: "rect", class: "snap-mark", x: x - 5, y: y - 5, width: 10, height: 10 },
    {
      key: "name",
      tag: "text",
      class: said ? "snap-name is-said" : "snap-name",
      x: x + (isRight ? -12 : 12),
      y: y < 30 ? y + 22 : y - 12,
      "text-anchor": isRight ? "end" : "start",
      text,
    },
  ];
}

/**
 * A suggestion that is pointed at: where the cloth would lie, how the folds would run.
 * @param {import("./board.js").Board} board
 */
export function drawPreview({ store, view, drawing }) {
  const { placement, garment } = store.preview ?? {};
  /** @type {import("./sheet.js").Item[]} */
  const items = [];
  if (placement) {
    const ring = drawing.outline.map(({ point }) => view.toPx(toInner(drawing.placement, toOuter(placement, point))));
    const middle = middleOf(drawing);
    const wanted = toInner(drawing.placement, toOuter(placement, middle));
    items.push({ key: "placed", tag: "path", class: "preview", d: path(ring) });
    items.push(...dimension("moved", view.toPx(middle), view.toPx(wanted), length(distance(middle, wanted))));
  }
  for (const [index, fold] of (garment?.folds ?? []).entries()) {
    items.push(
      ...foldItems({
        key: `p${index}`,
        kind: fold.kind,
        ends: [view.toPx(fold.start), view.toPx(fold.end)],
        state: " is-preview",
        number: null,
      }),
    );
  }
  return items;
}
