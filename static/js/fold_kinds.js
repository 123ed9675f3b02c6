/**
 * The kinds of folds on the page. Their words stand in the catalogues (`colour.…`, `step.make_…`), their colours in
 * `css/kinds.css`.
 */

/** @import { FoldKind } from "pleat" */

/**
 * @typedef {object} Kind
 * @property {string} key the letter on the keyboard that chooses it
 * @property {boolean} takesFlap whether it takes only the layers that the fold before it moved
 */

/** @type {Record<FoldKind, Kind>} */
export const FOLD_KINDS = {
  blue: { key: "b", takesFlap: false },
  red: { key: "r", takesFlap: true },
  turn: { key: "o", takesFlap: false },
};

export const KIND_NAMES = /** @type {FoldKind[]} */ (Object.keys(FOLD_KINDS));
