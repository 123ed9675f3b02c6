"""Grow a reach map: a posture found in one cell is the start in the cells beside it. Compiled.

Cells whose middle is out of reach, but that lie beside one whose is not, take over postures of their neighbours, and so
do cells with few of their own. Where reach is a thin shell there are cells beside none whose middle is in reach: these
take over from such fringe cells what leads to some corner of theirs.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray
from planner.kernels import kernel
from planner.robots.chain import PITCH, Chain, Scratch, forward, scratch_for
from planner.robots.hand_roll import gives_roll
from planner.robots.newton import solve
from planner.robots.reach_map import CODES, Grid, approach_of, cell_of, decode

APART = 0.25
"""Postures of one cell differ by at least this in some joint (rad, m)."""

FRINGE = 8
"""Postures that a cell has at most once it has taken over those of its neighbours."""

FEW = 4
"""Own postures from which on a cell takes over none."""

OUTER = 2
"""Postures that a cell beside fringe cells alone takes over: each makes all answers of no slower."""

_CORNERS = 8
"""Corners of a cell."""


class ReachMapBuilding(NamedTuple):
    """A map that grows.

    Attributes:
        postures: the joints in steps of their ranges, shape (entries, families, n).
        known: the number of postures of each entry, shape (entries,).
        queue: the postures whose neighbours are still to be tried, as entry * families + family.
        ends: the first and the last of the queue, shape (2,).
    """

    postures: NDArray[np.int8]
    known: NDArray[np.int8]
    queue: NDArray[np.int32]
    ends: NDArray[np.int64]


@kernel
def _encode(grid: Grid, turns: NDArray[np.bool_], joints: FloatArray, codes: NDArray[np.int8]) -> None:
    for i in range(len(joints)):
        off = joints[i] - grid.middle[i]
        if turns[i]:
            off -= math.tau * math.floor(off / math.tau + 0.5)
        codes[i] = round(min(max(off / grid.half[i], -1.0), 1.0) * CODES)


@kernel
def _is_known(chain: Chain, grid: Grid, building: ReachMapBuilding, entry: int, codes: NDArray[np.int8]) -> bool:
    """Return whether an entry has a posture near to a given one; a last joint that gives the roll does not count."""
    count = len(codes) - 1 if gives_roll(chain) else len(codes)
    for family in range(building.known[entry]):
        is_near = True
        for i in range(count):
            off = abs(float(building.postures[entry, family, i]) - float(codes[i])) / CODES * grid.half[i]
            if chain.turns[i]:
                off = min(off, math.tau - off)
            if off > APART:
                is_near = False
                break
        if is_near:
            return True
    return False


@kernel
def _try(
    chain: Chain,
    grid: Grid,
    building: ReachMapBuilding,
    cell: int,
    approach: int,
    codes: NDArray[np.int8],
    joints: FloatArray,
    scratch: Scratch,
) -> None:
    """Add the posture that a cell's middle has near to a given one, if it is new there."""
    entry, families = cell * len(grid.rotations) + approach, building.postures.shape[1]
    if building.known[entry] >= families or _is_known(chain, grid, building, entry, codes):
        return
    ny, nz = grid.counts[1], grid.counts[2]
    middle = np.empty(3)
    middle[0] = grid.low[0] + (cell // (ny * nz) + 0.5) * grid.cell
    middle[1] = grid.low[1] + (cell // nz % ny + 0.5) * grid.cell
    middle[2] = grid.low[2] + (cell % nz + 0.5) * grid.cell
    decode(grid, codes, joints)
    if not solve(chain, middle, grid.rotations[approach], chain.rows, joints, scratch):
        return
    family = building.known[entry]
    found = building.postures[entry, family]
    _encode(grid, chain.turns, joints, found)
    if not _is_known(chain, grid, building, entry, found):
        building.known[entry] += 1
        building.queue[building.ends[1]] = entry * families + family
        building.ends[1] += 1


@kernel
def sow(chain: Chain, grid: Grid, building: ReachMapBuilding, samples: FloatArray) -> None:
    """Add what random joints, shape (m, n), lead to."""
    scratch, joints = scratch_for(samples.shape[1]), np.empty(samples.shape[1])
    codes = np.empty(samples.shape[1], dtype=np.int8)
    for i in range(len(samples)):
        forward(chain, samples[i], scratch)
        cell = cell_of(grid, scratch.point)
        if cell < 0:
            continue
        approach = approach_of(grid, scratch.frame[:, 0])
        r = grid.rotations[approach]
        along = scratch.frame[0, 0] * r[0, 0] + scratch.frame[1, 0] * r[1, 0] + scratch.frame[2, 0] * r[2, 0]
        if along > 0.9 or chain.rows == PITCH:
            _encode(grid, chain.turns, samples[i], codes)
            _try(chain, grid, building, cell, approach, codes, joints, scratch)


@kernel
def grow(chain: Chain, grid: Grid, building: ReachMapBuilding, most: int) -> bool:
    """Try the neighbours of the next postures in the queue, `most` at the most; return whether any are left."""
    count, families = building.postures.shape[2], building.postures.shape[1]
    scratch, joints = scratch_for(count), np.empty(count)
    approaches, nx, ny, nz = len(grid.rotations), grid.counts[0], grid.counts[1], grid.counts[2]
    for _ in range(most):
        if building.ends[0] >= building.ends[1]:
            return False
        entry, family = divmod(building.queue[building.ends[0]], families)
        building.ends[0] += 1
        cell, approach = divmod(entry, approaches)
        codes = building.postures[entry, family]
        if cell // (ny * nz) + 1 < nx:
            _try(chain, grid, building, cell + ny * nz, approach, codes, joints, scratch)
        if cell // (ny * nz) > 0:
            _try(chain, grid, building, cell - ny * nz, approach, codes, joints, scratch)
        if cell // nz % ny + 1 < ny:
            _try(chain, grid, building, cell + nz, approach, codes, joints, scratch)
        if cell // nz % ny > 0:
            _try(chain, grid, building, cell - nz, approach, codes, joints, scratch)
        if cell % nz + 1 < nz:
            _try(chain, grid, building, cell + 1, approach, codes, joints, scratch)
        if cell % nz > 0:
            _try(chain, grid, building, cell - 1, approach, codes, joints, scratch)
        for other in grid.beside[approach]:
            _try(chain, grid, building, cell, other, codes, joints, scratch)
    return bool(building.ends[0] < building.ends[1])


@kernel
def finished(chain: Chain, grid: Grid, building: ReachMapBuilding) -> tuple[NDArray[np.int32], NDArray[np.int8]]:
    """Return the starts and postures of a grown map, those of the fringe included; see `ReachMap`."""
    entries = len(building.known)
    _give_neighbours(chain, grid, building, FEW, FRINGE)
    of_fringe = building.known == 0
    _give_neighbours(chain, grid, building, 1, OUTER)
    for entry in range(entries):
        if of_fringe[entry] and building.known[entry] > 0:
            _drop_useless(chain, grid, building, entry)
    starts = np.zeros(entries + 1, dtype=np.int32)
    for entry in range(entries):
        starts[entry + 1] = starts[entry] + building.known[entry]
    postures = np.empty((starts[entries], building.postures.shape[2]), dtype=np.int8)
    for entry in range(entries):
        for family in range(building.known[entry]):
            postures[starts[entry] + family] = building.postures[entry, family]
    return starts, postures


@kernel
def _give_neighbours(chain: Chain, grid: Grid, building: ReachMapBuilding, few: int, most: int) -> None:
    """Let entries of fewer than `few` postures take over those of their neighbours, until they have `most`."""
    approaches, nx, ny, nz = len(grid.rotations), grid.counts[0], grid.counts[1], grid.counts[2]
    within = building.known.copy()
    for entry in range(len(within)):
        if within[entry] >= few:
            continue
        cell, approach = divmod(entry, approaches)
        x, y, z = cell // (ny * nz), cell // nz % ny, cell % nz
        for reach in range(1, 4):
            for dx in range(-1, 2):
                for dy in range(-1, 2):
                    for dz in range(-1, 2):
                        if abs(dx) + abs(dy) + abs(dz) != reach or building.known[entry] >= most:
                            continue
                        if 0 <= x + dx < nx and 0 <= y + dy < ny and 0 <= z + dz < nz:
                            other = (((x + dx) * ny + y + dy) * nz + z + dz) * approaches + approach
                            if within[other] > 0:  # a call that does nothing takes as long as all before it
                                _take_over(chain, grid, building, within, entry, other, most)
        for beside in grid.beside[approach]:
            if building.known[entry] == 0:
                _take_over(chain, grid, building, within, entry, cell * approaches + beside, most)


@kernel
def _drop_useless(chain: Chain, grid: Grid, building: ReachMapBuilding, entry: int) -> None:
    """Drop the postures of an entry that lead to no corner of its cell."""
    joints, scratch, kept = np.empty(len(chain.low)), scratch_for(len(chain.low)), 0
    (cell, approach), (ny, nz), point = divmod(entry, len(grid.rotations)), grid.counts[1:], np.empty(3)
    x, y, z = cell // (ny * nz), cell // nz % ny, cell % nz
    for number in range(building.known[entry]):
        for corner in range(_CORNERS):
            point[0] = grid.low[0] + (x + corner // 4) * grid.cell
            point[1] = grid.low[1] + (y + corner // 2 % 2) * grid.cell
            point[2] = grid.low[2] + (z + corner % 2) * grid.cell
            decode(grid, building.postures[entry, number], joints)
            if solve(chain, point, grid.rotations[approach], chain.rows, joints, scratch):
                building.postures[entry, kept] = building.postures[entry, number]
                kept += 1
                break
    building.known[entry] = kept


@kernel
def _take_over(
    chain: Chain, grid: Grid, building: ReachMapBuilding, within: NDArray[np.int8], entry: int, other: int, most: int
) -> None:
    """Give an entry the postures of another that are new to it, until it has `most`."""
    for family in range(within[other]):
        codes = building.postures[other, family]
        known = building.known[entry]
        if known < most and not _is_known(chain, grid, building, entry, codes):
            building.postures[entry, known] = codes
            building.known[entry] += 1
