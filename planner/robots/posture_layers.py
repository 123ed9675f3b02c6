"""reach maps made higher and deeper, layer by layer, when something above or below them is asked.

A map covers the heights at which most cloth is handled. Cloth that hangs far over an edge of the table is taken and
carried below them, a long part rises above them. Each layer is a map of its own, grown and cached alone, and then
becomes part of the whole: the postures that the map had stay as they are, so an answer does not depend on what was
asked before it.
"""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from planner.geometry.tolerance import LENGTH_M
from planner.robots.chain import Chain
from planner.robots.reach_map import Grid, ReachMap
from planner.robots.reach_maps import kept_map

LAYER_CELLS = 4
"""Cells across the height of a layer: 0.3 m for all arms but short and very long ones."""


def covered_heights(grid: Grid) -> tuple[float, float]:
    """Return the lowest and the highest point of a map, seen from the arm's root (m)."""
    low = float(grid.low[2])
    return low, low + float(grid.counts[2]) * grid.cell


def covering(chain: Chain, known: ReachMap, heights_m: tuple[float, float], directory: Path | None = None) -> ReachMap:
    """Return a map that covers heights, as far as the arm is long: the same map where it does already.

    Layers are read from the user's cache or built (in seconds).

    Args:
        chain: the arm.
        known: its map.
        heights_m: the lowest and the highest point that are asked, seen from the arm's root (m).
        directory: the cache directory; None: the platform's own.
    """
    reach = float(-known.grid.low[0])
    lowest, highest = max(heights_m[0], -reach), min(heights_m[1], reach)
    while covered_heights(known.grid)[0] > lowest + LENGTH_M:
        grid = known.grid
        layer = _layer(grid, float(grid.low[2]) - LAYER_CELLS * grid.cell)
        known = _stacked(kept_map(chain, layer, None, directory), known)
    while covered_heights(known.grid)[1] < highest - LENGTH_M:
        layer = _layer(known.grid, covered_heights(known.grid)[1])
        known = _stacked(known, kept_map(chain, layer, None, directory))
    return known


def _layer(grid: Grid, low_m: float) -> Grid:
    """Return the grid of a layer with the cells of a map, its lowest point given (m)."""
    counts = np.array([*grid.counts[:2], LAYER_CELLS], dtype=np.int64)
    return grid._replace(low=np.array([*grid.low[:2], low_m]), counts=counts)


def _stacked(lower: ReachMap, upper: ReachMap) -> ReachMap:
    """Return two maps as one; the second begins at the height where the first ends."""
    below, above = _by_column(lower), _by_column(upper)
    grid = lower.grid
    counts = np.concatenate([below, above], axis=1)
    starts = np.concatenate([[0], np.cumsum(counts)]).astype(np.int32)
    postures = np.empty((int(starts[-1]), lower.postures.shape[1]), dtype=np.int8)
    columns = np.concatenate([below.sum(axis=1)[:, None], above.sum(axis=1)[:, None]], axis=1)
    is_below = np.repeat(np.tile([True, False], len(columns)), columns.ravel())
    postures[is_below], postures[~is_below] = _own(lower), _own(upper)
    heights = np.array([*grid.counts[:2], grid.counts[2] + upper.grid.counts[2]], dtype=np.int64)
    return ReachMap(grid._replace(counts=heights), starts, postures)


def _by_column(known: ReachMap) -> NDArray[np.int64]:
    """Return the number of postures of each entry, one row for each column of cells."""
    counts: NDArray[np.int64] = np.diff(known.starts).astype(np.int64)
    return counts.reshape(int(known.grid.counts[0] * known.grid.counts[1]), -1)


def _own(known: ReachMap) -> NDArray[np.int8]:
    """Return the postures of a map, which may share its memory with other maps, of its arm's joints alone."""
    found: NDArray[np.int8] = known.postures[known.starts[0] : known.starts[-1], : len(known.grid.middle)]
    return found
