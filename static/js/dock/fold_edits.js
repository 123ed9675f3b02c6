/** What can be done to the folds of a drawing. Folds go by their ids, so a change holds on a newer drawing too. */

/** @import { Drawing, Fold, FoldKind } from "pleat" */

/**
 * @param {string} id
 * @param {(fold: Fold, drawing: Drawing) => void} alter
 * @returns {(drawing: Drawing) => void} nothing happens where the fold is gone
 */
function withFold(id, alter) {
  return (drawing) => {
    const fold = drawing.folds.find((candidate) => candidate.id === id);
    if (fold) alter(fold, drawing);
  };
}

/** @param {string} id @param {string} name */
export const renamed = (id, name) => withFold(id, (fold) => (fold.name = name));

/** @param {string} id @param {FoldKind} kind */
export const recoloured = (id, kind) => withFold(id, (fold) => (fold.kind = kind));

/** @param {string} id @param {number|null} radius metres; null: the garment's */
export const gripped = (id, radius) => withFold(id, (fold) => (fold.grip_radius_m = radius));

/** @param {string} id */
export const removed = (id) =>
  withFold(id, (fold, drawing) => {
    drawing.folds.splice(drawing.folds.indexOf(fold), 1);
    for (const other of drawing.folds) if (other.twin === id) other.twin = null;
  });

/** @param {string} id @param {number} to its place among the folds afterwards */
export const moved = (id, to) =>
  withFold(id, (fold, drawing) => {
    drawing.folds.splice(drawing.folds.indexOf(fold), 1);
    drawing.folds.splice(to, 0, fold);
  });
