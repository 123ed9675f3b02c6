"""A place within the comfort radius of arms that have reach maps. Compiled.

The joints for the place itself are found from the map; those for the four places on the circle round it by Newton's
method from these, or else from the map too. Nothing is taken over from one question to the next, so that answers do not
depend on what was asked before.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.geometry.tolerance import LENGTH_M, grid_keys
from planner.kernels import kernel
from planner.robots.chain import Chain, Scratch, length_of, scratch_for
from planner.robots.newton import solve
from planner.robots.place import STANDOFF_STEP, Place
from planner.robots.reach_map import Grid, ReachMap, find_joints
from planner.robots.reach_technology import ReachTechnology

ARM_LABELS = 64
"""Labels of each arm in the memory: 0 is none, the others are the approaches'."""

_REST, _LENGTH, _SCALE, _CELL, _LOW, _TOOL, _OFFSET, _JOINTS = 0, 3, 4, 5, 6, 9, 18, 21
"""Indices of an arm's numbers: root's distance from the grid, the arm's length, the scale of angles, cell and lowest
corner of its map, its tool, and its joints, each array of `_PER_JOINT` numbers a joint after the other."""

_PER_JOINT = 16
"""Numbers of a joint: rotation, offset, limits, and the middle and half of its range."""

_COUNT, _ROWS, _CELLS, _START, _STARTS = 0, 1, 2, 5, 6
"""Indices of an arm's whole numbers: its joints, what it is asked of a pose, the cells of its map along three axes, and
where the starts of its map begin and how many there are."""


class MappedArms(NamedTuple):
    """The arms of a robot with their maps, in few arrays: passing many costs more than a query.

    Attributes:
        numbers: lengths and limits of each arm, shape (arms, n).
        whole: whole numbers of each arm, shape (arms, 7).
        flags: which joints of each arm slide, and which have whole turns, shape (arms, 2, joints).
        rotations: the approaches, which all maps share, shape (k, 3, 3).
        beside: the approaches nearest to each approach, shape (k, 4).
        starts: where the postures of each map's entries begin among all, see `ReachMap`.
        postures: the postures of all maps, shape (m, joints), those of fewer joints filled up.
    """

    numbers: FloatArray
    whole: NDArray[np.int64]
    flags: BoolArray
    rotations: FloatArray
    beside: NDArray[np.int64]
    starts: NDArray[np.int32]
    postures: NDArray[np.int8]


class MappedQuery(NamedTuple):
    """The constants of the queries of one arm in one approach.

    Attributes:
        chain: the arm.
        known: its map.
        rotation: the tool's axes, shape (3, 3).
        rest: the root's offset from the grid of `LENGTH_M` (m).
        length: how far from its root the arm may reach (m).
        approach: the approach's index in the map.
        label: its label in the memory.
        comfort: the comfort radius (m).
    """

    chain: Chain
    known: ReachMap
    rotation: FloatArray
    rest: tuple[float, float, float]
    length: float
    approach: int
    label: int
    comfort: float


class MappedSpace(NamedTuple):
    """Working memory for the queries of one thread, for arms of up to some joints.

    Attributes:
        point: a tool point (m), shape (3,).
        middle: the joints for a place, shape (joints,).
        beside: those for a place on the circle round it, shape (joints,).
        newton: the working memory of Newton's method.
    """

    point: FloatArray
    middle: FloatArray
    beside: FloatArray
    newton: Scratch


def mapped_arms(chains: Sequence[Chain], maps: Sequence[ReachMap]) -> MappedArms:
    """Return arms whose roots are on the grid in the form of the compiled queries; their maps have the same approaches.

    See `rooted`.
    """
    most = max(len(chain.low) for chain in chains)
    numbers, whole = np.zeros((len(chains), _JOINTS + _PER_JOINT * most)), np.zeros((len(chains), 7), dtype=np.int64)
    flags = np.zeros((len(chains), 2, most), dtype=np.bool_)
    postures: list[NDArray[np.int8]] = []
    starts: list[NDArray[np.int32]] = []
    for arm, (chain, known) in enumerate(zip(chains, maps, strict=True)):
        count, grid = len(chain.low), known.grid
        joints = (chain.rotations, chain.offsets, chain.low, chain.high, grid.middle, grid.half)
        size = (np.zeros(3), length_of(chain), chain.scale, grid.cell, grid.low)
        parts = (*size, chain.tool_rotation, chain.tool_offset, *joints)
        flat = np.concatenate([np.ravel(part) for part in parts])
        numbers[arm, : len(flat)] = flat
        at = sum(len(one) for one in starts)
        whole[arm] = (count, chain.rows, *grid.counts, at, len(known.starts))
        flags[arm, 0, :count], flags[arm, 1, :count] = chain.is_prismatic, chain.turns
        starts.append(known.starts + np.int32(sum(len(one) for one in postures)))
        postures.append(np.pad(known.postures, ((0, 0), (0, most - count))))
    grid = maps[0].grid
    return MappedArms(numbers, whole, flags, grid.rotations, grid.beside, np.concatenate(starts), np.vstack(postures))


def rooted(arms: MappedArms, roots: Sequence[FloatArray]) -> MappedArms:
    """Return arms with their roots elsewhere, base frame (m), each of shape (3,)."""
    numbers, places = arms.numbers.copy(), np.array(roots)
    numbers[:, _REST:_LENGTH] = places - LENGTH_M * grid_keys(places)
    return arms._replace(numbers=numbers)


@kernel
def mapped_space(arms: MappedArms) -> MappedSpace:
    """Return working memory for queries."""
    most = arms.flags.shape[2]
    return MappedSpace(np.empty(3), np.empty(most), np.empty(most), scratch_for(most))


@kernel
def mapped_query(arms: MappedArms, label: int, comfort: float) -> MappedQuery:
    """Return the query in the approach, and of the arm, of a label."""
    arm, approach = label // ARM_LABELS, label % ARM_LABELS - 1
    n, whole, count = arms.numbers[arm], arms.whole[arm], arms.whole[arm, _COUNT]
    at = _JOINTS
    ends = np.empty(7, dtype=np.int64)
    ends[0] = at
    for number, size in enumerate((9, 3, 1, 1, 1, 1)):
        at += size * count
        ends[number + 1] = at
    low, high = n[ends[2] : ends[3]], n[ends[3] : ends[4]]
    chain = Chain(
        n[ends[0] : ends[1]].reshape((count, 3, 3)),
        n[ends[1] : ends[2]].reshape((count, 3)),
        arms.flags[arm, 0, :count],
        low,
        high,
        arms.flags[arm, 1, :count],
        n[_TOOL:_OFFSET].reshape((3, 3)),
        n[_OFFSET:_JOINTS],
        whole[_ROWS],
        n[_SCALE],
    )
    grid = Grid(
        n[_LOW:_TOOL],
        n[_CELL],
        whole[_CELLS:_START],
        arms.rotations,
        arms.beside,
        n[ends[4] : ends[5]],
        n[ends[5] : ends[6]],
    )
    known = ReachMap(grid, arms.starts[whole[_START] : whole[_START] + whole[_STARTS]], arms.postures)
    rest = (n[_REST], n[_REST + 1], n[_REST + 2])
    return MappedQuery(chain, known, arms.rotations[approach], rest, n[_LENGTH], approach, label, comfort)


@kernel
def _is_in_height(ask: MappedQuery, place: Place) -> bool:
    return abs(place.z * LENGTH_M - ask.rest[2]) <= ask.length


@kernel
def _is_in_length(ask: MappedQuery, place: Place, standoff: int) -> bool:
    x = (place.x + standoff * STANDOFF_STEP) * LENGTH_M - ask.rest[0]
    y, z = place.y * LENGTH_M - ask.rest[1], place.z * LENGTH_M - ask.rest[2]
    return x * x + y * y + z * z <= ask.length * ask.length


@kernel
def _is_within_margin(ask: MappedQuery, _arms: MappedArms, space: MappedSpace, place: Place, standoff: int) -> bool:
    point = space.point
    point[0] = (place.x + standoff * STANDOFF_STEP) * LENGTH_M - ask.rest[0]
    point[1], point[2] = place.y * LENGTH_M - ask.rest[1], place.z * LENGTH_M - ask.rest[2]
    return is_held_round(ask, space, point)


@kernel
def is_held_round(ask: MappedQuery, space: MappedSpace, point: FloatArray) -> bool:
    """Return whether a point, seen from the arm's root (m), is within the comfort radius; `point` may be changed."""
    count, chain, rotation = len(ask.chain.low), ask.chain, ask.rotation
    middle, beside = space.middle[:count], space.beside[:count]
    scratch = first_of(space.newton, count)
    if not find_joints(chain, ask.known, point, rotation, ask.approach, middle, scratch):
        return False
    if ask.comfort <= 0.0:
        return True
    for number in range(4):
        axis, side = number // 2, ask.comfort if number % 2 == 0 else -ask.comfort
        before = point[axis]
        point[axis] = before + side
        beside[:] = middle
        found = solve(chain, point, rotation, chain.rows, beside, scratch)
        found = found or find_joints(chain, ask.known, point, rotation, ask.approach, beside, scratch)
        point[axis] = before
        if not found:
            return False
    return True


@kernel
def first_of(scratch: Scratch, joints: int) -> Scratch:
    """Return the working memory of Newton's method for an arm of fewer joints."""
    return Scratch(
        scratch.axes,
        scratch.places,
        scratch.frame,
        scratch.point,
        scratch.rows,
        scratch.errors,
        scratch.normal,
        scratch.solution,
        scratch.step[:joints],
        scratch.is_held[:joints],
    )


REACH_MAPS = ReachTechnology(
    MappedArms, MappedQuery, mapped_space, mapped_query, _is_in_height, _is_in_length, _is_within_margin
)
