"""Build reach maps, and keep them in the user's cache.

A map covers the heights at which most cloth is handled. Cloth that hangs far over an edge of the table is taken and
carried below them, a long part rises above them. So maps are made higher and deeper, layer by layer, when something
above or below them is queried. Each layer is a map of its own, grown and cached alone, and then becomes part of the
whole: the postures that the map had stay as they are, so an answer does not depend on earlier queries.
"""

from collections.abc import Callable, Sequence
from hashlib import blake2b
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from planner.deadline import left_out
from planner.geometry.pose import Approach
from planner.geometry.tolerance import LENGTH_M
from planner.robots.chain import Chain
from planner.robots.kept_arrays import kept
from planner.robots.reach_map import Grid, ReachMap
from planner.robots.reach_map_building import APART, FEW, FRINGE, OUTER, ReachMapBuilding, finished, grow, sow
from planner.user_cache import cache_folder

CELL_M = 0.075
"""The largest edge of a cell (m), but for arms that are longer than any person's."""

CELLS_ACROSS = 26
"""Cells across the reach of a small arm, whose cells are smaller."""

CELLS_ACROSS_MAX = 60
"""Cells across the reach of a long arm, whose cells are larger: the map's size and the time for it stay bounded."""

SEEDS = 200_000
"""Random postures from which a map is begun; a family that none of them is in is not found."""

_FAMILIES = 8
"""Postures of a cell: an arm of six joints has up to eight that are apart, an arm of seven has curves of them.

At least `FRINGE`: the cells out of reach take over that many.
"""

_SLICE = 50_000
"""Postures between two reports of progress."""

_FORMAT = 5
"""Version of the cache; raise it whenever maps are made or stored differently."""


Progress = Callable[[float], None]
"""Called from time to time with the share of the work that is done (0 to 1)."""


def reach_map(
    chain: Chain,
    approaches: Sequence[Approach],
    heights_m: tuple[float, float],
    progress: Progress | None = None,
    directory: Path | None = None,
) -> ReachMap:
    """Return an arm's map, read from the cache or built (in seconds) and kept.

    A cache that cannot be read is built again; one that cannot be written is ignored.

    Args:
        chain: the arm.
        approaches: the approaches that will mostly be queried.
        heights_m: the lowest and the highest point that will be queried, seen from the arm's root (m).
        progress: called with the share of the work that is done.
        directory: the cache directory; None: the platform's own.
    """
    return kept_map(chain, grid_of(chain, approaches, heights_m), progress, directory)


def kept_map(chain: Chain, grid: Grid, progress: Progress | None = None, directory: Path | None = None) -> ReachMap:
    """Return an arm's map of some cells, read from the cache or built and kept; see `reach_map`."""
    path = (directory or cache_folder()) / "postures" / f"{_digest(chain, grid)}.npz"

    def made() -> ReachMap:
        with left_out():  # a map is built once
            return build_map(chain, grid, progress)

    return kept(
        path,
        lambda arrays: ReachMap(grid, arrays["starts"], arrays["postures"]),
        made,
        lambda known: {"starts": known.starts, "postures": known.postures},
    )


def build_map(chain: Chain, grid: Grid, progress: Progress | None = None) -> ReachMap:
    """Return an arm's map, grown from random postures."""
    joints = len(chain.low)
    entries = int(np.prod(grid.counts)) * len(grid.rotations)
    building = ReachMapBuilding(
        np.zeros((entries, _FAMILIES, joints), dtype=np.int8),
        np.zeros(entries, dtype=np.int8),
        np.empty(entries * _FAMILIES, dtype=np.int32),
        np.zeros(2, dtype=np.int64),
    )
    rng = np.random.default_rng(0)
    sow(chain, grid, building, grid.middle + grid.half * rng.uniform(-1.0, 1.0, (SEEDS, joints)))
    while grow(chain, grid, building, _SLICE):
        if progress is not None:
            done, known = building.ends
            progress(0.98 * float(done / known))
    made = ReachMap(grid, *finished(chain, grid, building))
    if progress is not None:
        progress(1.0)
    return made


def grid_of(chain: Chain, approaches: Sequence[Approach], heights_m: tuple[float, float]) -> Grid:
    """Return the cells and approaches of an arm's map; see `reach_map`."""
    reach = float(np.linalg.norm(chain.offsets[1:], axis=1).sum() + np.linalg.norm(chain.tool_offset))
    reach += float(np.abs(np.concatenate([chain.low, chain.high])[np.tile(chain.is_prismatic, 2)]).sum())
    cell = min(max(CELL_M, 2.0 * reach / CELLS_ACROSS_MAX), 2.0 * reach / CELLS_ACROSS)
    low = np.array([-reach, -reach, max(heights_m[0], -reach)])
    high = np.array([reach, reach, max(min(heights_m[1], reach), low[2] + cell)])
    rotations = np.array([approach.rotation for approach in approaches])
    along = rotations[:, :, 0] @ rotations[:, :, 0].T
    np.fill_diagonal(along, -2.0)
    beside = np.argsort(-along, axis=1, kind="stable")[:, : min(4, len(approaches) - 1)]
    half = np.where(chain.turns, np.pi, 0.5 * (chain.high - chain.low))
    middle = np.where(chain.turns, 0.0, 0.5 * (chain.high + chain.low))
    counts = np.ceil((high - low) / cell).astype(np.int64)
    return Grid(low, cell, counts, rotations, np.ascontiguousarray(beside), middle, half)


def _digest(chain: Chain, grid: Grid) -> str:
    """Return a digest of all that a map depends on: the arm as its card and URDF make it, the cells, the approaches."""
    digest = blake2b(f"{_FORMAT} {SEEDS} {_FAMILIES} {FRINGE} {FEW} {OUTER} {APART}".encode(), digest_size=12)
    for part in (*chain, *grid):
        digest.update(np.ascontiguousarray(part).tobytes())
    return digest.hexdigest()


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
        heights_m: the lowest and the highest point that are queried, seen from the arm's root (m).
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
