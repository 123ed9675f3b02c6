"""Computes where an arm can take cloth that lies flat: a region of the table's plane, in the base frame.

It samples the robot's reach on a grid, all points at once, one approach after the other. Between neighbours that differ
it locates the border by bisection. The region depends neither on the table's edges nor on the base's pose, so one
region serves for all of them.

Half of the grid is beyond the arm's length, but checking that for each point and approach takes long. So first, for one
point in each block, it gets a bound on the distance to the reach, which rules out the whole block if it is large.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import TypeAlias

import numpy as np
from pydantic import BaseModel

from planner.folds.fold_path import REST_HEIGHT_M
from planner.geometry.pose import BoolArray, FloatArray, Point2
from planner.geometry.reach_query import ReachQuery
from planner.geometry.region import Region
from planner.primitives.reach import Reach
from planner.robots.armed_robot import ArmedRobot

_STEP_M, _LONGEST_M = 0.02, 1.3
"""The spacing of the points tried, and how far from its shoulder any arm reaches at most (m)."""

_BLOCK = 4
"""Number of grid points along each side of a block."""

HALVINGS = 4
"""Number of bisection steps that locate the border between two grid points."""


@dataclass(frozen=True, slots=True)
class Grid:
    """Points in rows and columns, base frame.

    Attributes:
        low: the first point (m).
        counts: the numbers of points along x and y.
        step_m: the spacing (m).
    """

    low: Point2
    counts: tuple[int, int]
    step_m: float

    @staticmethod
    def about(middle: Point2, radius_m: float, steps: int) -> "Grid":
        """Return a square grid about a point, with `steps` steps to each side."""
        x, y = middle
        return Grid((x - radius_m, y - radius_m), (2 * steps + 1, 2 * steps + 1), radius_m / steps)

    @staticmethod
    def beside(shoulder: Point2) -> "Grid":
        """Return a grid that covers all that an arm reaches from its shoulder, points on multiples of the spacing."""
        low = [math.floor((at - _LONGEST_M) / _STEP_M) for at in shoulder]
        count = math.ceil(2 * _LONGEST_M / _STEP_M) + 2
        return Grid((low[0] * _STEP_M, low[1] * _STEP_M), (count, count), _STEP_M)

    @property
    def places(self) -> FloatArray:
        """The points, shape (counts[0], counts[1], 2), m."""
        axes = (low + self.step_m * np.arange(count) for low, count in zip(self.low, self.counts, strict=True))
        return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)


CanTake: TypeAlias = Callable[[FloatArray], BoolArray]
"""Tells at which points of the base frame, shape (n, 2), m, an arm can take cloth."""


@lru_cache(maxsize=16)
def reach_regions(robot: ArmedRobot, torso_m: float, comfort_m: float, table_height_m: float) -> tuple[Region, ...]:
    """Return for each arm, from left to right, where it can take cloth that lies flat on a table, base frame.

    Args:
        robot: the robot.
        torso_m: the height of the lift (m).
        comfort_m: the comfort radius (m).
        table_height_m: the height of the table top (m).

    Raises:
        SceneError: the lift does not reach this height.
    """
    reach = robot.reach(torso_m, comfort_m)
    height_m = table_height_m + REST_HEIGHT_M
    return tuple(takeable_region(reach, arm, height_m) for arm in range(len(reach.arm_names)))


def takeable_region(reach: Reach, arm: int, height_m: float) -> Region:
    """Return where an arm can take cloth at a height above the floor (m), base frame."""
    x, y, _ = reach.shoulders[arm]
    places = Grid.beside((x, y))
    return region_where(partial(takeable, reach, arm, height_m), places, _may_be_in_reach(reach, arm, height_m, places))


def region_where(can_take: CanTake, places: Grid, is_open: BoolArray | None = None) -> Region:
    """Return the region of the grid's rectangle in which a predicate holds, base frame.

    Args:
        can_take: the predicate.
        places: the grid on which to sample it.
        is_open: the points to sample, shape `places.counts`; at the others the predicate is known to be false.
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
    """Return at which points an arm has its reach margin in one approach.

    The points have the shape (n, 2) and lie at a height above the floor (m), base frame.
    """
    tools = np.column_stack([points, np.full(len(points), height_m)])
    return np.asarray(reach.from_anywhere(ReachQuery(arm, tools, np.array([approach])))[0])


def _may_be_in_reach(reach: Reach, arm: int, height_m: float, places: Grid) -> BoolArray:
    """Return at which grid points an arm may have its reach margin in some approach.

    The points lie at a height above the floor (m).
    """
    first = places.places[::_BLOCK, ::_BLOCK]
    tools = np.concatenate([first, np.full((*first.shape[:2], 1), height_m)], axis=-1).reshape(-1, 1, 3)
    every = np.arange(len(reach.approaches))
    short_by_m = reach.at_least_short(ReachQuery(arm, tools, every)).reshape(first.shape[:2])
    to_last_m = math.sqrt(2.0) * (_BLOCK - 1) * places.step_m
    blocks = short_by_m <= to_last_m
    nx, ny = places.counts
    return np.asarray(blocks.repeat(_BLOCK, axis=0).repeat(_BLOCK, axis=1)[:nx, :ny])


def takeable(reach: Reach, arm: int, height_m: float, points: FloatArray) -> BoolArray:
    """Return at which points, shape (n, 2), an arm has its reach margin in at least one approach."""
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
    """Return the border points between neighbours of which one is inside; elsewhere the values are meaningless."""
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
    """Return the marked stretches of a row as (start, end), end excluded."""
    steps = np.flatnonzero(np.diff(np.concatenate([[False], marked, [False]]).astype(np.int8)))
    return [(int(start), int(end)) for start, end in zip(steps[::2], steps[1::2], strict=True)]


def _rectangle(grid: FloatArray, column: int, rows: tuple[int, int]) -> Region:
    start, end = rows
    return Region.polygon([grid[column, start], grid[column + 1, start], grid[column + 1, end], grid[column, end]])


def _cell(grid: FloatArray, inside: BoolArray, along_x: FloatArray, along_y: FloatArray, i: int, j: int) -> Region:
    """Return the part of a cell that is inside: the polygon of its inner corners and the border points on its sides."""
    corners = ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))
    crossings = (along_x[i, j], along_y[i + 1, j], along_x[i, j + 1], along_y[i, j])
    points = []
    for corner, crossing, following in zip(corners, crossings, (*corners[1:], corners[0]), strict=True):
        if inside[corner]:
            points.append(grid[corner])
        if inside[corner] != inside[following]:
            points.append(crossing)
    return Region.polygon(points)


def rings_of(part: Region) -> tuple[FloatArray, ...]:
    """Return the rings of a connected region, shape (n, 2) each, m: the outer one, then those of its holes."""
    holes = Region.polygon(part.ring).difference(part)
    return (part.ring, *(hole.ring for hole in holes.pieces))


class RegionAnswer(BaseModel):
    """A connected region (m)."""

    outer: list[Point2]
    holes: list[list[Point2]]

    @staticmethod
    def of(part: Region) -> "RegionAnswer":
        """Return a connected region by its outer ring and those of its holes."""
        outer, *holes = (ring.tolist() for ring in rings_of(part))
        return RegionAnswer(outer=outer, holes=holes)
