/** What a suggestion changes, made to a drawing. */

const SAME_M = 1e-9;

/**
 * @param {any} drawing is altered
 * @param {any} change fields of a plan request, or the whole drawing as it is to be
 * @returns {any} another drawing in place of the altered one, if there is one
 */
export function applyChange(drawing, change) {
  if (change.drawing) return structuredClone(change.drawing);
  for (const field of ["placement", "scene", "start_station", "comfort_radius_m"]) {
    if (change[field] !== undefined) drawing[field] = change[field];
  }
  if (change.garment) drawing.folds = changedFolds(drawing, change.garment.folds);
}

/** The drawing's folds in the order and along the lines of a garment's; those that stay keep their ties. */
function changedFolds(drawing, wanted) {
  const left = [...drawing.folds];
  const taken = wanted.map((fold, index) => take(left, fold, drawing.folds[index]));
  const isReordered = taken.some((fold, index) => fold !== drawing.folds[index]);
  return wanted.map((fold, index) => ({
    ...taken[index],
    start: end(taken[index].start, fold.start, isReordered),
    end: end(taken[index].end, fold.end, isReordered),
    grip_radius_m: fold.grip_radius_m === drawing.grip_radius_m ? null : fold.grip_radius_m,
  }));
}

/** The fold that is meant: the same line, else the one at the same place, else any that is left. */
function take(left, fold, atSamePlace) {
  const isSame = (own) => own.name === fold.name && is(own.start.point, fold.start) && is(own.end.point, fold.end);
  const found = left.find(isSame) ?? left.find((own) => own === atSamePlace) ?? left[0];
  left.splice(left.indexOf(found), 1);
  return found;
}

/** An end; where the line or what comes before it has changed, the server ties it anew. */
function end(own, point, isReordered) {
  return !isReordered && is(own.point, point) ? own : { point };
}

const is = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]) <= SAME_M;
