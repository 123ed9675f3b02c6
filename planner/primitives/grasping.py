"""Which arm takes which grip, and from which directions it may."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, permutations

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import Approach, FloatArray, Point2, wrapped_angle
from planner.geometry.tolerance import ANGLE_RAD, LENGTH_M
from planner.primitives.work import Work

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
    work: Work, station: int, arm: int, tool_points: FloatArray, approaches: NDArray[np.int64], step_m: float
) -> ArmOptions:
    """Ask the robot along a path of one arm, table frame, shape (n, 3), and keep what can matter."""
    points = work.in_base(station, tool_points)
    masks = work.reach.back_offs(arm, points, approaches, work.back_offs, step_m)
    kept = _undominated(masks)
    return ArmOptions(arm, approaches[kept], masks[kept])


def _undominated(masks: NDArray[np.uint32]) -> NDArray[np.int64]:
    """Rows that can be followed and that no other row allows at least as much as (the first of equals)."""
    alive = np.flatnonzero(masks.all(axis=1))
    kept: list[int] = []
    for row in sorted(alive, key=lambda i: (-int(np.bitwise_count(masks[i]).sum()), i)):
        if not any(np.all(masks[row] & ~masks[other] == 0) for other in kept):
            kept.append(int(row))
    return np.array(sorted(kept), dtype=np.int64)


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
