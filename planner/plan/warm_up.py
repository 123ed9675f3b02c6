"""Compile all that is compiled, or load it from the cache, so that no user's search is charged for it."""

import gc
from collections.abc import Callable
from functools import cache

import numpy as np
from numpy.typing import NDArray

from planner.cloth.garment import Garment
from planner.geometry.pose import BoolArray, FloatArray, Point3
from planner.plan.driving_bound import DrivingBound
from planner.plan.found_plan import FoundPlan
from planner.plan.timeline import Timeline
from planner.primitives.base_legs import travel
from planner.robot.tool_path import ToolPath

_NAPKIN = {
    "name": "napkin",
    "outline": [[0.0, 0.0], [0.3, 0.0], [0.3, 0.3], [0.0, 0.3]],
    "folds": [{"name": "half", "kind": "blue", "start": [0.3, 0.15], "end": [0.0, 0.15]}],
    "placement": {"x_m": -0.75, "y_m": 0.15, "yaw_rad": -1.5707963267948966},
}

_FAR, _EDGE = np.array([1.2, 0.0, 0.8]), np.array([0.9, 0.2, 0.9])

_LEFT_M, _RIGHT_M = (0.6, 0.2, 0.9), (0.6, -0.2, 0.9)


class _InTheWay:
    """Arms that never pass each other, though there seems to be room at every pose."""

    def arms_apart(self, joints: FloatArray) -> BoolArray:
        """Nowhere."""
        return np.zeros(len(joints), dtype=bool)

    def postures_apart(self, left: FloatArray, right: FloatArray) -> BoolArray:
        """All."""
        return np.ones((len(left), len(right)), dtype=bool)


@cache
def warm_up(plan: Callable[[Garment], FoundPlan]) -> None:
    """Plan a napkin, play it, ask why places are out of reach, lead arms past each other: that touches all.

    Args:
        plan: makes a plan for a garment.
    """
    gc.freeze()  # modules are no garbage, and to look through them stops everything for some hundredths of a second
    found = plan(Garment.from_dict(_NAPKIN))
    Timeline.of(found.plan).at(0.0)
    reach = found.problem.work.reach
    for point in (_FAR, _EDGE):
        reach.shortfall(0, point, np.array([0]))
        reach.from_anywhere(0, point[None], np.array([0]), 1, 0.05)
        reach.shortfall_together(0, point[None, None], np.array([0]))
        reach.at_least_short(0, point[None, None], np.array([0]), 1, 0.05)
    travel(np.ones((1, 2), dtype=np.uint32), 2)
    DrivingBound(found.problem.work, found.problem.start)
    robot, torso_m = found.problem.robot, found.problem.work.scene.torso_m
    left, right = (_staying(place) for place in (_LEFT_M, _RIGHT_M))
    robot.arm_pair_path((left, right), torso_m, 0.0, (_anywhere, _anywhere), _InTheWay())
    gc.freeze()  # nor is what has been compiled


def _staying(place: Point3) -> ToolPath:
    return ToolPath(np.array([place, place]), np.array([np.eye(3), np.eye(3)]), np.array([np.inf]), (0, 2))


def _anywhere(_poses: NDArray[np.int64], joints: FloatArray, _is_certain: bool) -> BoolArray:
    return np.ones(len(joints), dtype=bool)
