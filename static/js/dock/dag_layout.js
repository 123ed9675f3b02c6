/**
 * Where the folds of a Fold-DAG stand: in columns by depth, in each near what they wait for.
 *
 * An edge that passes columns by is given a place in each of them, so that it runs between the folds there and not
 * under them.
 */

/**
 * A fold's place, or (`to` >= 0) that of an edge from it that passes by.
 * @typedef {{fold: number, to: number, depth: number, row: number}} Place
 */

/** @typedef {[from: number, to: number]} Edge */

/**
 * @param {number} count of folds
 * @param {Edge[]} edges from a fold to one that waits for it; from lower to higher numbers
 * @returns {Place[][]} the places of each column, from top to bottom
 */
export function columns(count, edges) {
  const depth = depths(count, edges);
  const found = Array.from({ length: Math.max(-1, ...depth) + 1 }, () => /** @type {Place[]} */ ([]));
  for (let fold = 0; fold < count; fold += 1) found[depth[fold]].push({ fold, to: -1, depth: depth[fold], row: 0 });
  for (const [from, to] of edges) {
    for (let at = depth[from] + 1; at < depth[to]; at += 1) found[at].push({ fold: from, to, depth: at, row: 0 });
  }
  found.forEach((column, at) => arrange(column, found[at - 1] ?? [], edges));
  return found;
}

/**
 * The places that an edge runs through, its ends included.
 * @param {Place[][]} laid
 * @param {number} from
 * @param {number} to
 */
export function wayOf(laid, from, to) {
  const places = laid.flat();
  /** @param {number} fold */
  const own = (fold) => places.filter((place) => place.fold === fold && place.to < 0);
  return [...own(from), ...places.filter((place) => place.fold === from && place.to === to), ...own(to)];
}

/** The length of the longest way to each fold. @param {number} count @param {Edge[]} edges @returns {number[]} */
function depths(count, edges) {
  const depth = new Array(count).fill(0);
  const inOrder = edges.toSorted(([a], [b]) => a - b);
  for (const [from, to] of inOrder) depth[to] = Math.max(depth[to], depth[from] + 1);
  return depth;
}

/**
 * Put a column in the order of what leads to it, and count its rows from the middle.
 * @param {Place[]} column
 * @param {Place[]} before
 * @param {Edge[]} edges
 */
function arrange(column, before, edges) {
  const wish = new Map(column.map((place) => [place, middle(place, before, edges)]));
  column.sort((a, b) => (wish.get(a) ?? 0) - (wish.get(b) ?? 0) || a.fold - b.fold || a.to - b.to);
  column.forEach((place, row) => (place.row = row - (column.length - 1) / 2));
}

/**
 * The mean row of what leads to a place from the column before.
 * @param {Place} place
 * @param {Place[]} before
 * @param {Edge[]} edges
 */
function middle(place, before, edges) {
  /** @param {Place} other */
  const passes = (other) => (other.to < 0 || other.to === place.to) && other.fold === place.fold;
  /** @param {Place} other */
  const arrives = (other) =>
    other.to < 0 ? edges.some(([from, to]) => from === other.fold && to === place.fold) : other.to === place.fold;
  const rows = before.filter(place.to < 0 ? arrives : passes).map((other) => other.row);
  return rows.length ? rows.reduce((sum, row) => sum + row, 0) / rows.length : 0;
}
