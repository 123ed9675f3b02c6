"""Compile the numba kernels, or load them from the cache, so that no user's search pays for it."""

import gc
import sys
from dataclasses import replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from planner.cloth.garment import Garment
from planner.geometry.pose import BoolArray, FloatArray, Point3, Pose2
from planner.geometry.reach_query import ReachQuery
from planner.kernel_cache import are_kernels_kept, note_kernels_kept
from planner.motion.timeline import Timeline
from planner.planning.budget import Budget
from planner.planning.driving_bound import DrivingBound
from planner.planning.plan_search import Hints, quickest
from planner.planning.problem import Problem
from planner.planning.robot_task import default_scene, task_for
from planner.primitives.base_legs import legs, travel
from planner.robots.load_robot import compile_samples, needs_maps
from planner.robots.tool_path import ToolPath
from planner.task.task import DEFAULT_ROBOT

_SIDE_M, _SHARE = 0.3, 0.35
"""Side of the garment that is planned to use the kernels (m), and its largest share of the table's depth: a small
robot's table is small too.
"""

_PLACE = {"x_m": -0.75, "y_m": 0.15, "yaw_rad": -1.5707963267948966}
"""Where it lies for the default robot; for others it lies where their cards say."""

_FAR, _EDGE = np.array([1.2, 0.0, 0.8]), np.array([0.9, 0.2, 0.9])
"""Tool points that are out of reach, and at its edge, base frame (m)."""

_COMFORT_M = 0.2
"""A comfort radius that is hardly to be had where a tool point is in reach (m)."""

_AWAY = (("away", Pose2(-20.0, 0.0, 0.0)),)
"""A station out of reach of everything."""

_BESIDE_M = ((0.6, 0.2, 0.9), (0.6, -0.2, 0.9))
"""Tool points at which two arms stay while they are led past each other, base frame (m)."""


class _InTheWay:
    """A stand-in for collisions in which two arms never pass each other, although each posture is free by itself."""

    def arms_apart(self, _arms: tuple[int, ...], joints: FloatArray) -> BoolArray:
        """Return that the arms are apart at no joint values."""
        return np.zeros(len(joints), dtype=bool)

    def postures_apart(self, _arms: tuple[int, int], first: FloatArray, second: FloatArray) -> BoolArray:
        """Return that all pairs of postures are apart."""
        return np.ones((len(first), len(second)), dtype=bool)


_ALLOCATIONS = 10_000
"""Objects made and not dropped again after which the garbage collector looks at young ones. A search makes many that
stay: with Python's 700 a tenth of a plan's time goes into looking at them.
"""


EACH_KIND = (DEFAULT_ROBOT, "so101-pair")
"""A robot for each kind of kernels: those of arms in closed form and those of arms that are mapped share few."""

_used: set[str] = set()
"""The robots whose kernels this process has."""


def compile_kernels(name: str = DEFAULT_ROBOT, *, is_backwards: bool = False) -> None:
    """Compile the kernels for a robot, or load them from the cache, once per process; planning calls it too.

    Two processes at once take little more than half as long if one of them goes through the kernels backwards: each
    finds in the cache what the other has compiled.
    """
    _use_kernels(name, is_backwards)
    if name not in _used:
        _used.add(name)
        note_kernels_kept(_kind(name))


def must_compile(name: str = DEFAULT_ROBOT) -> bool:
    """Return whether kernels for a robot have to be compiled first, which takes a minute."""
    return name not in _used and not are_kernels_kept(_kind(name))


def _kind(name: str) -> str:
    """Return which kernels a robot uses: those of a closed form, or those of maps."""
    return "mapped" if needs_maps(name) else "closed-form"


@cache
def _use_kernels(name: str, is_backwards: bool) -> None:
    """Use every kernel for a robot.

    A napkin is planned and played, the reach is queried why places are out of reach, and the arms are led past each
    other: together these use every kernel. Objects that exist by then, above all modules, are hidden from the garbage
    collector, which is called less often from then on.
    """
    gc.set_threshold(max(_ALLOCATIONS, gc.get_threshold()[0]), *gc.get_threshold()[1:])
    gc.freeze()  # modules are no garbage, and scanning them stops the process for some hundredths of a second
    problem = Problem.of(task_for(napkin(name), robot=name, comfort_radius_m=0.0))
    uses = (_plan, _ask_why, _drive, _sample, _lead_past)
    for use in reversed(uses) if is_backwards else uses:
        use(problem)
    gc.freeze()  # compiled code is no garbage either


def _plan(problem: Problem) -> None:
    """Plan the napkin, and play the plan."""
    *_, end = quickest(problem, Budget.endless(), Hints())
    if end.found.plan.is_solved:
        Timeline.of(end.found.plan).at(0.0)


def _ask_why(problem: Problem) -> None:
    """Ask the reach why places are out of reach."""
    reach, approach = problem.context.reach, np.array([0])
    for point in (_FAR, _EDGE):
        place = ReachQuery(0, np.array([[point]]), approach)
        reach.shortfall(place)
        reach.shortfall(replace(place, points=np.array([[point], [point]])))
        reach.at_least_short(place)
        reach.from_anywhere(replace(place, points=np.array([point])))
    reach.standoffs(ReachQuery(0, np.array([_FAR, _EDGE]), approach, 2))
    beside = problem.robot.reach(problem.context.scene.torso_m, _COMFORT_M)
    beside.shortfall(ReachQuery(0, np.array([[_BESIDE_M[0]]]), approach))
    reach.shortfall(ReachQuery(0, np.array([[_FAR]]), approach), 0.01)


def _drive(problem: Problem) -> None:
    """Drive, and bound the driving.

    The bound is computed from where nothing is in reach: from the table it takes half a second, for some arms 17 s.
    """
    strips = np.ones((1, 2), dtype=np.uint32)
    travel(strips, 2)
    legs(strips[0], 0, 0, 1)
    robot = problem.task.robot
    scene = replace(default_scene(robot), stations=_AWAY)
    away = Problem.of(task_for(napkin(robot), scene, robot=robot, start_station=_AWAY[0][0]))
    DrivingBound(away.context, away.start)


def _sample(problem: Problem) -> None:
    """Sample joints, as maps of arms are made."""
    compile_samples(problem.task.robot)


def _lead_past(problem: Problem) -> None:
    """Lead the arms past each other."""
    robot = problem.robot
    beside = {arm: _staying(place) for arm, place in zip(range(len(robot.card.arms)), _BESIDE_M, strict=False)}
    robot.arm_paths(beside, problem.context.scene.torso_m, 0.0, dict.fromkeys(beside, _anywhere), _InTheWay())


def napkin(robot: str) -> Garment:
    """Return a small garment that a robot can fold."""
    side = min(_SIDE_M, _SHARE * default_scene(robot).table.depth_m)
    data = {
        "name": "napkin",
        "outline": [[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]],
        "folds": [{"name": "half", "kind": "blue", "start": [side, 0.5 * side], "end": [0.0, 0.5 * side]}],
        "placement": _PLACE,
    }
    return Garment.from_dict(data)


def _staying(place: Point3) -> ToolPath:
    return ToolPath(np.array([place, place]), np.array([np.eye(3), np.eye(3)]), np.array([np.inf]), (0, 2))


def _anywhere(_poses: NDArray[np.int64], joints: FloatArray) -> BoolArray:
    return np.ones(len(joints), dtype=bool)


if __name__ == "__main__":
    compile_kernels(sys.argv[1], is_backwards=sys.argv[2:] == ["backwards"])
