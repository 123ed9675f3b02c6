"""Which arm takes which grip, and from which directions it may."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, permutations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from planner.geometry.pose import Approach, BoolArray, FloatArray, Point2, wrapped_angle
from planner.geometry.tolerance import ANGLE_RAD, LENGTH_M
from planner.primitives.work import BACK_OFF_STEP_M, Work

GRIPS_APART_M = 0.10
"""Two grips nearer to each other than this cannot be taken by two hands (m)."""

_PREFERRED_PITCH_RAD = math.radians(30.0)


def nearest_pair_m(points: FloatArray) -> float:
    """The distance of the two nearest of some points, shape (n, 2), m; infinite for fewer than two."""
    pairs = combinations(points, 2)
    return min((float(np.hypot(*(a - b))) for a, b in pairs), default=math.inf)


def assignments(work: Work, station: int, points: FloatArray) -> Iterator[tuple[int, ...]]:
    """The ways to give grips to arms: an arm further left takes a grip further left.

    Args:
        work: the problem.
        station: where the robot stands.
        points: the grips in the table frame, shape (n, 2), m.

    Yields:
        For each grip the number of its arm. Where two grips are equally far left, both ways come.
    """
    lateral = work.station_pose(station).to_inner(points)[:, 1]
    for arms in permutations(range(len(work.reach.arm_names)), len(points)):
        is_ordered = all(
            lateral[i] >= lateral[j] - LENGTH_M
            for i in range(len(points))
            for j in range(len(points))
            if arms[i] < arms[j]
        )
        if is_ordered:
            yield arms


def approaches_from_outside(work: Work, done: int, heading_in_base: float, grip: Point2) -> NDArray[np.int64]:
    """The approaches that pinch the cloth from outside, best first.

    Args:
        work: the problem.
        done: the folds finished.
        heading_in_base: direction of the article's x axis in the base frame (rad).
        grip: a point of the stack, article frame (m).
    """
    inward = work.sequence.cloth(done).silhouette.inward_bisector(grip)
    cone = work.scene.approach_cone_rad
    heading = None if inward is None else heading_in_base + math.atan2(inward[1], inward[0])
    allowed = [
        (_discomfort(approach, heading), index)
        for index, approach in enumerate(work.reach.approaches)
        if approach.is_vertical
        or cone >= math.pi - ANGLE_RAD
        or (heading is not None and _off(approach, heading) <= cone + ANGLE_RAD)
    ]
    return np.array([index for _, index in sorted(allowed)], dtype=np.int64)


def all_approaches(work: Work, heading_in_base: float | None = None) -> NDArray[np.int64]:
    """Every approach, best first: what is held already may be held from anywhere."""
    scored = ((_discomfort(a, heading_in_base), i) for i, a in enumerate(work.reach.approaches))
    return np.array([i for _, i in sorted(scored)], dtype=np.int64)


def _off(approach: Approach, heading: float) -> float:
    return abs(wrapped_angle(approach.heading_rad - heading))


def _discomfort(approach: Approach, heading: float | None) -> float:
    """How far an approach is from the natural one: straight into the cloth, 30 degrees down."""
    turn = 0.0 if heading is None or approach.is_vertical else _off(approach, heading)
    return round(turn + abs(approach.pitch_rad - _PREFERRED_PITCH_RAD), 6)


@dataclass(frozen=True, slots=True)
class ArmOptions:
    """How one arm may follow its path: undominated approaches and, for each, the back-offs at each waypoint.

    Attributes:
        arm: the arm's number.
        approaches: indices of approaches, shape (k,), best first.
        masks: bit masks of back-offs, shape (k, n).
    """

    arm: int
    approaches: NDArray[np.int64]
    masks: NDArray[np.uint32]


def arm_options(
    work: Work,
    station: int,
    arm: int,
    tool_points: FloatArray,
    approaches: NDArray[np.int64],
    window: tuple[int, int],
    enough: int | None = None,
    start: int | None = None,
) -> ArmOptions:
    """Ask the robot along a path of one arm and keep what can matter.

    Args:
        work: the problem.
        station: where the robot stands.
        arm: the arm's number.
        tool_points: the path in the table frame, shape (n, 3), m.
        approaches: what may be tried, best first.
        window: the first and last back-off asked for.
        enough: how many approaches are enough; None: all are wanted.
        start: the back-off at which the hand is at the path's start already; None: the hand is free.
    """
    low, high = window
    points = work.in_base(station, tool_points) + np.array([low * BACK_OFF_STEP_M, 0.0, 0.0])
    first = None if start is None else start - low
    masks = work.reach.back_offs(arm, points, approaches, high - low + 1, BACK_OFF_STEP_M, enough, first)
    masks <<= np.uint32(low)
    kept = _undominated(masks)
    return ArmOptions(arm, approaches[kept], masks[kept])


def _undominated(masks: NDArray[np.uint32]) -> NDArray[np.int64]:
    """Rows that can be followed and that no other row allows at least as much as (the first of equals)."""
    alive = np.flatnonzero(masks.all(axis=1))
    rows = masks[alive]
    freedom = np.bitwise_count(rows).sum(axis=1, dtype=np.int64)
    order = np.argsort(-freedom, kind="stable")
    return np.sort(alive[order[_first_of_kind(rows[order])]])


@njit(cache=True)
def _first_of_kind(rows: NDArray[np.uint32]) -> BoolArray:
    """Which rows, sorted by falling freedom, are not contained in one before them."""
    is_kept = np.ones(len(rows), dtype=np.bool_)
    for i in range(len(rows)):
        for j in range(i):
            if is_kept[j] and not np.any(rows[i] & ~rows[j]):
                is_kept[i] = False
                break
    return is_kept


@dataclass(frozen=True, slots=True)
class Strips:
    """All combinations of the arms' approaches, and the back-offs that suit every arm.

    Attributes:
        masks: shape (combinations, n).
        approaches: for each combination each arm's approach index, shape (combinations, arms).
    """

    masks: NDArray[np.uint32]
    approaches: NDArray[np.int64]


def combined(options: list[ArmOptions]) -> Strips:
    """The combinations in which some back-off suits every arm at every waypoint."""
    masks = options[0].masks
    chosen = options[0].approaches[:, None]
    for option in options[1:]:
        both = masks[:, None, :] & option.masks[None, :, :]
        i, j = np.nonzero(both.all(axis=2))
        masks = both[i, j]
        chosen = np.column_stack([chosen[i], option.approaches[j]])
    return Strips(masks, chosen)
