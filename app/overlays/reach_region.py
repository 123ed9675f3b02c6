"""Where an arm can take cloth that lies flat: a region of the plane of the table, in the base frame.

Asked of the robot's own reach on a grid, all points at once for one approach after the other; where two neighbours
differ, the place between them at which it changes is found by halving. What is found depends on neither the table's
edges nor where the base stands, so one region serves for all of them.

Half of the grid is further away than an arm is long, and to find that out for each place in each approach takes long.
So a bound on how far it is out of reach is asked of one place in each block first: it says something of its neighbours.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import TypeAlias

import numpy as np

from planner.folds.fold_path import REST_HEIGHT_M
from planner.geometry.pose import BoolArray, FloatArray, Point2
from planner.geometry.region import Region
from planner.primitives.context import BACK_OFF_STEP_M
from planner.primitives.reach import Reach
from planner.robot.pr2 import load_robot

_BLOCK = 4
"""So many places along each side of a block."""

HALVINGS = 4
"""The border of the region is found to this many halvings of the grid."""


@dataclass(frozen=True, slots=True)
class Grid:
    """Places in rows and columns, base frame.

    Attributes:
        low: the first of them (m).
        counts: how many there are along x and along y.
        step_m: how far apart they are (m).
    """

    low: Point2
    counts: tuple[int, int]
    step_m: float

    @staticmethod
    def about(middle: Point2, radius_m: float, steps: int) -> "Grid":
        """A square with a place in its middle, from there to each side so many steps."""
        x, y = middle
        return Grid((x - radius_m, y - radius_m), (2 * steps + 1, 2 * steps + 1), radius_m / steps)

    @property
    def places(self) -> FloatArray:
        """All of them, shape (counts[0], counts[1], 2), m."""
        axes = (low + self.step_m * np.arange(count) for low, count in zip(self.low, self.counts, strict=True))
        return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)


ALL_IN_REACH = Grid((-1.0, -1.3), (106, 131), 0.02)
"""Further no arm reaches."""

CanTake: TypeAlias = Callable[[FloatArray], BoolArray]
"""Of points of the base frame, shape (n, 2), m: which of them an arm can take cloth at."""


@lru_cache(maxsize=16)
def reach_regions(robot: str, torso_m: float, comfort_m: float, table_height_m: float) -> tuple[Region, ...]:
    """For each arm, from left to right, where it can take cloth flat on a table, base frame.

    Args:
        robot: the robot's name.
        torso_m: how far the lift is raised (m).
        comfort_m: how much slack every reach has (m).
        table_height_m: how high the table's top is (m).

    Raises:
        SceneError: the lift does not go there.
    """
    reach = load_robot(robot).reach(torso_m, comfort_m)
    height_m = table_height_m + REST_HEIGHT_M
    return tuple(takeable_region(reach, arm, height_m) for arm in range(len(reach.arm_names)))


def takeable_region(reach: Reach, arm: int, height_m: float) -> Region:
    """Where an arm can take cloth so high over the floor (m), base frame."""
    return region_where(partial(takeable, reach, arm, height_m), is_open=_may_be_in_reach(reach, arm, height_m))


def region_where(can_take: CanTake, places: Grid = ALL_IN_REACH, is_open: BoolArray | None = None) -> Region:
    """The region of the grid's rectangle in which a question is answered with yes, base frame.

    Args:
        can_take: the question.
        places: where it is asked.
        is_open: at which of the places it need be, shape `places.counts`: at the others the answer is known to be no.
    """
    nx, ny = places.counts
    grid = places.places
    inside = np.zeros((nx, ny), dtype=np.bool_)
    asked = np.ones_like(inside) if is_open is None else is_open
    inside[asked] = can_take(grid[asked])
    along_x = _borders(can_take, grid[:-1], grid[1:], inside[:-1], inside[1:])
    along_y = _borders(can_take, grid[:, :-1], grid[:, 1:], inside[:, :-1], inside[:, 1:])
    whole = inside[:-1, :-1] & inside[1:, :-1] & inside[:-1, 1:] & inside[1:, 1:]
    some = inside[:-1, :-1] | inside[1:, :-1] | inside[:-1, 1:] | inside[1:, 1:]
    pieces = [_rectangle(grid, column, rows) for column in range(nx - 1) for rows in runs(whole[column])]
    for i, j in np.argwhere(some & ~whole):
        pieces.append(_cell(grid, inside, along_x, along_y, int(i), int(j)))
    return Region.union(pieces) if pieces else Region.empty()


def in_approach(reach: Reach, arm: int, height_m: float, approach: int, points: FloatArray) -> BoolArray:
    """At which points, shape (n, 2), so high over the floor (m) an arm is in comfort in one approach."""
    tools = np.column_stack([points, np.full(len(points), height_m)])
    return np.asarray(reach.from_anywhere(arm, tools, np.array([approach]), 1, BACK_OFF_STEP_M)[0])


def _may_be_in_reach(reach: Reach, arm: int, height_m: float) -> BoolArray:
    """At which places of the grid an arm may be in comfort in some approach, so high over the floor (m)."""
    first = ALL_IN_REACH.places[::_BLOCK, ::_BLOCK]
    tools = np.concatenate([first, np.full((*first.shape[:2], 1), height_m)], axis=-1).reshape(-1, 1, 3)
    every = np.arange(len(reach.approaches))
    short_by_m = reach.at_least_short(arm, tools, every, 1, BACK_OFF_STEP_M).reshape(first.shape[:2])
    to_last_m = math.sqrt(2.0) * (_BLOCK - 1) * ALL_IN_REACH.step_m
    blocks = short_by_m <= to_last_m
    nx, ny = ALL_IN_REACH.counts
    return np.asarray(blocks.repeat(_BLOCK, axis=0).repeat(_BLOCK, axis=1)[:nx, :ny])


def takeable(reach: Reach, arm: int, height_m: float, points: FloatArray) -> BoolArray:
    """At which points, shape (n, 2), an arm is in comfort in at least one approach."""
    found = np.zeros(len(points), dtype=np.bool_)
    left = np.arange(len(points))
    for approach in range(len(reach.approaches)):
        if not len(left):
            break
        can = in_approach(reach, arm, height_m, approach, points[left])
        found[left[can]] = True
        left = left[~can]
    return found


def _borders(can_take: CanTake, a: FloatArray, b: FloatArray, in_a: BoolArray, in_b: BoolArray) -> FloatArray:
    """Between neighbours of which one is inside, where the border is; elsewhere nothing that counts."""
    border = np.zeros_like(a)
    differ = in_a != in_b
    inner, outer = (np.where(in_a[differ][:, None], *pair) for pair in ((a[differ], b[differ]), (b[differ], a[differ])))
    for _ in range(HALVINGS):
        middle = (inner + outer) / 2.0
        is_in = can_take(middle)[:, None]
        inner, outer = np.where(is_in, middle, inner), np.where(is_in, outer, middle)
    border[differ] = inner
    return border


def runs(marked: BoolArray) -> list[tuple[int, int]]:
    """The stretches of a row that are marked: where each begins and where it has ended."""
    steps = np.flatnonzero(np.diff(np.concatenate([[False], marked, [False]]).astype(np.int8)))
    return [(int(start), int(end)) for start, end in zip(steps[::2], steps[1::2], strict=True)]


def _rectangle(grid: FloatArray, column: int, rows: tuple[int, int]) -> Region:
    start, end = rows
    return Region.polygon([grid[column, start], grid[column + 1, start], grid[column + 1, end], grid[column, end]])


def _cell(grid: FloatArray, inside: BoolArray, along_x: FloatArray, along_y: FloatArray, i: int, j: int) -> Region:
    """The part of a cell that is inside: its corners that are, and where the border crosses its sides."""
    corners = ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))
    crossings = (along_x[i, j], along_y[i + 1, j], along_x[i, j + 1], along_y[i, j])
    points = []
    for corner, crossing, following in zip(corners, crossings, (*corners[1:], corners[0]), strict=True):
        if inside[corner]:
            points.append(grid[corner])
        if inside[corner] != inside[following]:
            points.append(crossing)
    return Region.polygon(points)
