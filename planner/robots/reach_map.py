"""A reach map from which Newton's method finds the joints for any tool pose nearby. Compiled.

A random start finds the joints for a pose in one of many tries; a start from a neighbouring pose nearly always. So the
map holds, for each cell of space and each approach, postures with the tool in the middle of the cell: up to some that
are far apart, because one family of postures may end within a cell where another goes on. A query that finds no posture
in its cell is answered no at once. `planner.robots.reach_map_building` makes the maps.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray
from planner.kernels import kernel
from planner.robots.chain import Chain, Scratch, scratch_for
from planner.robots.newton import solve

CODES = 127.0
"""Steps either way from the middle of a joint's range in a stored posture."""


class Grid(NamedTuple):
    """The cells and approaches of a map.

    Attributes:
        low: the lowest corner, seen from the arm's root (m), shape (3,).
        cell: the edge of a cell (m).
        counts: the number of cells along x, y and z, shape (3,).
        rotations: the tool's axes in each approach, as columns, shape (k, 3, 3).
        beside: the approaches nearest to each approach, shape (k, 4).
        middle: the middle of each joint's range, shape (n,).
        half: half of each joint's range, of a whole turn for joints that have one, shape (n,).
    """

    low: FloatArray
    cell: float
    counts: NDArray[np.int64]
    rotations: FloatArray
    beside: NDArray[np.int64]
    middle: FloatArray
    half: FloatArray


class ReachMap(NamedTuple):
    """A finished map.

    Attributes:
        grid: its cells and approaches.
        starts: where each entry's postures begin, shape (entries + 1,); see `entry_of`.
        postures: the joints in steps of their ranges, shape (m, n).
    """

    grid: Grid
    starts: NDArray[np.int32]
    postures: NDArray[np.int8]


@kernel
def cell_of(grid: Grid, point: FloatArray) -> int:
    """Return the number of the cell that holds a point; -1 outside the map."""
    found = 0
    for axis in range(3):
        at = math.floor((point[axis] - grid.low[axis]) / grid.cell)
        if not 0 <= at < grid.counts[axis]:
            return -1
        found = found * grid.counts[axis] + int(at)
    return found


@kernel
def approach_of(grid: Grid, axis: FloatArray) -> int:
    """Return the approach whose axis is nearest to a given one."""
    best, nearest = -2.0, 0
    for k in range(len(grid.rotations)):
        r = grid.rotations[k]
        along = r[0, 0] * axis[0] + r[1, 0] * axis[1] + r[2, 0] * axis[2]
        if along > best:
            best, nearest = along, k
    return nearest


@kernel
def decode(grid: Grid, codes: NDArray[np.int8], joints: FloatArray) -> None:
    """Set the joints that a stored posture has."""
    for i in range(len(joints)):
        joints[i] = grid.middle[i] + codes[i] / CODES * grid.half[i]


@kernel
def find_joints(
    chain: Chain,
    known: ReachMap,
    point: FloatArray,
    rotation: FloatArray,
    approach: int,
    joints: FloatArray,
    scratch: Scratch,
) -> bool:
    """Return whether the arm can take a tool pose; set the joints at which it does.

    Args:
        chain: the arm.
        known: its map.
        point: the tool's position, seen from the arm's root (m), shape (3,).
        rotation: the tool's axes as columns, shape (3, 3).
        approach: the map's approach nearest to the tool's.
        joints: set to the joints found, shape (n,).
        scratch: working memory.
    """
    cell = cell_of(known.grid, point)
    if cell < 0:
        return False
    entry = cell * len(known.grid.rotations) + approach
    for number in range(known.starts[entry], known.starts[entry + 1]):
        decode(known.grid, known.postures[number], joints)
        if solve(chain, point, rotation, chain.rows, joints, scratch):
            return True
    return False


@kernel
def reachable_poses(
    chain: Chain, known: ReachMap, points: FloatArray, rotations: FloatArray
) -> tuple[NDArray[np.bool_], FloatArray]:
    """Return which tool poses, shapes (m, 3) and (m, 3, 3), the arm can take, and joints for each, shape (m, n)."""
    scratch = scratch_for(len(chain.low))
    joints, found = np.empty((len(points), len(chain.low))), np.zeros(len(points), dtype=np.bool_)
    for i in range(len(points)):
        approach = approach_of(known.grid, rotations[i, :, 0])
        found[i] = find_joints(chain, known, points[i], rotations[i], approach, joints[i], scratch)
    return found, joints
