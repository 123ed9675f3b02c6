/** Plans in words. */

/** @param {number} seconds */
export const seconds = (seconds) => `${seconds.toFixed(1)} s`;

/** @param {string} station as in `front_left` */
export const place = (station) => station.replaceAll("_", " ");

/**
 * What a primitive does.
 * @param {any} primitive
 * @param {any[]} folds the garment's
 */
export function what(primitive, folds) {
  if (primitive.kind === "fold") return folds[primitive.fold]?.name || String(primitive.fold);
  if (primitive.kind === "drag") return `${Math.round(primitive.distance_m * 100)} cm towards the robot`;
  if (primitive.kind === "move") return `${place(primitive.from)} to ${place(primitive.to)}`;
  return primitive.kind;
}

/**
 * By what, from where.
 * @param {any} primitive
 */
export function how(primitive) {
  const { station, back_off_m: backOff } = primitive.base;
  const hands = primitive.grips.map((grip) => grip.arm[0].toUpperCase()).sort().join(" + ");
  const from = `at ${place(station)}${backOff > 0.001 ? `, ${Math.round(backOff * 100)} cm back` : ""}`;
  return [hands, from, primitive.holds ? "holds on" : ""].filter(Boolean).join(", ");
}

/** The heading over the reasons. */
export const WHY_NOT = "Why there is no plan";

export const KINDS = { fold: "Fold", drag: "Drag", move: "Drive" };
