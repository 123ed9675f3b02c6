"""A place within the comfort radius of arms that have reach maps, and how far other places are from one. Compiled.

The joints for the place itself are found from the map; those for the four places on the circle round it by Newton's
method from these, or else from the map too. Nothing is taken over from one question to the next, so that answers do not
depend on earlier queries.

As for a closed form (`planner.robots.pr2.nearest_comfort`) the search for the nearest such place goes outwards in
shells, along all directions and approaches and from all places of the base at once, and ends in the first shell that
has one. Shells are thicker here, because each query takes longer, and what the arm's length rules out is not queried.
"""

import math
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
from planner.robots.reach_map import Grid, ReachMap, cell_of, decode, find_joints
from planner.robots.reach_technology import ReachTechnology

ARM_LABELS = 64
"""Labels of each arm in the memory: 0 is none, the others are the approaches'."""

_REST, _LENGTH, _SCALE, _CELL, _LOW, _TOOL, _OFFSET, _JOINTS = 0, 3, 4, 5, 6, 9, 18, 21
"""Indices of an arm's numbers: root's distance from the grid, the arm's length, the scale of angles, cell and lowest
corner of its map, its tool, and its joints, each array of `_PER_JOINT` numbers a joint after the other."""

_PER_JOINT = 16
"""Numbers of a joint: rotation, offset, limits, and the middle and half of its range."""

_COUNT, _ROWS, _CELLS, _START, _STARTS = 0, 1, 2, 5, 6
"""Indices of an arm's whole numbers: its joints, what of a pose it must take, the cells of its map along three axes,
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


_SHELL_M, _WIDENING = 0.01, 0.06
"""Thickness of a shell (m), or as a fraction of its distance where that is more."""

_FINEST_M = 0.001
"""Precision at which the bisection ends (m)."""

_AT_LIMIT_RAD = 1e-3


@kernel
def nearest_place(
    arms: MappedArms,
    labels: NDArray[np.int64],
    points: FloatArray,
    directions: FloatArray,
    comfort: float,
    furthest: float,
    queries_max: int,
) -> tuple[float, int, int, int, int]:
    """Return the smallest displacement that brings a tool point within the comfort radius.

    Args:
        arms: the arms.
        labels: the labels of one arm's approaches that are allowed, shape (k,).
        points: the point as seen from the arm's root, from each place of the base, shape (n, 3), m.
        directions: unit vectors, shape (m, 3).
        comfort: the comfort radius (m).
        furthest: the furthest displacement searched (m).
        queries_max: the most queries; then what is known counts.

    Returns:
        The displacement (m), rounded up to a millimetre; the point; the approach; the direction; queries made.
        Infinity, -1, -1, -1 where there is none.
    """
    space, at = mapped_space(arms), np.empty(3)
    best, best_place, best_approach, best_direction, queries = math.inf, -1, -1, -1, 0
    inner = 0.0
    while inner < furthest and best_place < 0 and queries < queries_max:
        limit = outer = inner + max(_SHELL_M, _WIDENING * inner)
        for approach in range(len(labels)):
            ask = mapped_query(arms, labels[approach], comfort)
            for place in range(len(points)):
                beyond = math.sqrt((points[place] ** 2).sum()) - ask.length
                if beyond >= limit:
                    continue
                for direction in range(len(directions)):
                    near, far = inner, limit
                    if far <= near:
                        break
                    at[:] = points[place] + far * directions[direction]
                    if math.sqrt((at**2).sum()) > ask.length:
                        continue
                    queries += 1
                    if not is_held_round(ask, space, at):
                        continue
                    while far - near > _FINEST_M:
                        middle = 0.5 * (near + far)
                        at[:] = points[place] + middle * directions[direction]
                        queries += 1
                        if is_held_round(ask, space, at):
                            far = middle
                        else:
                            near = middle
                    best, best_place, best_approach, best_direction = far, place, approach, direction
                    limit = far - _FINEST_M
        inner = outer
    return best, best_place, best_approach, best_direction, queries


@kernel
def widest_circle(
    arms: MappedArms, labels: NDArray[np.int64], points: FloatArray, comfort: float
) -> tuple[float, int, int]:
    """Return the radius of the largest circle, up to `comfort` (m), on which the tool is still within reach.

    Returns:
        The radius (m), rounded down to a millimetre; the point; the approach. 0, -1, -1 where no point is within reach.
    """
    space = mapped_space(arms)
    best, best_place, best_approach = 0.0, -1, -1
    for approach in range(len(labels)):
        for place in range(len(points)):
            near, far = best, comfort
            if best_place >= 0 and far - near <= _FINEST_M:
                break
            if not is_held_round(mapped_query(arms, labels[approach], near), space, points[place].copy()):
                continue
            while far - near > _FINEST_M:
                middle = 0.5 * (near + far)
                if is_held_round(mapped_query(arms, labels[approach], middle), space, points[place].copy()):
                    near = middle
                else:
                    far = middle
            best, best_place, best_approach = near, place, approach
    return best, best_place, best_approach


@kernel
def joint_at_limit(arms: MappedArms, label: int, point: FloatArray) -> int:
    """Return the joint that keeps the tool from a point: at its limit where Newton's method gets no nearer; -1 if none.

    Among the postures of the point's cell, that of the first which ends at a limit.
    """
    ask = mapped_query(arms, label, 0.0)
    space, count = mapped_space(arms), len(ask.chain.low)
    joints, cell = space.middle[:count], cell_of(ask.known.grid, point)
    if cell < 0:
        return -1
    entry = cell * len(ask.known.grid.rotations) + ask.approach
    for number in range(ask.known.starts[entry], ask.known.starts[entry + 1]):
        decode(ask.known.grid, ask.known.postures[number], joints)
        solve(ask.chain, point, ask.rotation, ask.chain.rows, joints, first_of(space.newton, count))
        for i in range(count):
            nearest = min(joints[i] - ask.chain.low[i], ask.chain.high[i] - joints[i])
            if not ask.chain.turns[i] and nearest <= _AT_LIMIT_RAD:
                return i
    return -1
