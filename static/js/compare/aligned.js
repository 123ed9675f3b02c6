/** The steps of two plans side by side: those that do the same in one row, in the order of both. */

import { briefly } from "../dock/words.js";

/** @import { Primitive } from "pleat" */
/** @import { Compared } from "./compared_plan.js" */

/** @typedef {[Primitive|null, Primitive|null]} Row */

/** @param {Compared} compared @returns {{step: Primitive, what: string}[]} */
const stepsOf = ({ plan, drawing }) =>
  (plan?.primitives ?? []).map((step) => ({ step, what: `${step.kind} ${briefly(step, drawing?.folds ?? [])}` }));

/**
 * The longest sequence of steps that both have stands in common rows, the others in rows of their own.
 * @param {Compared} left
 * @param {Compared} right
 * @returns {Row[]}
 */
export function aligned(left, right) {
  const [a, b] = [stepsOf(left), stepsOf(right)];
  const common = Array.from({ length: a.length + 1 }, () => Array.from({ length: b.length + 1 }, () => 0));
  for (let i = a.length - 1; i >= 0; i -= 1)
    for (let j = b.length - 1; j >= 0; j -= 1)
      common[i][j] =
        a[i].what === b[j].what ? common[i + 1][j + 1] + 1 : Math.max(common[i + 1][j], common[i][j + 1]);
  /** @type {Row[]} */
  const rows = [];
  let [i, j] = [0, 0];
  while (i < a.length || j < b.length) {
    const isSame = i < a.length && j < b.length && a[i].what === b[j].what;
    const isLeft = isSame || j >= b.length || (i < a.length && common[i + 1][j] >= common[i][j + 1]);
    const isRight = isSame || !isLeft;
    rows.push([isLeft ? a[i].step : null, isRight ? b[j].step : null]);
    i += Number(isLeft);
    j += Number(isRight);
  }
  return rows;
}
