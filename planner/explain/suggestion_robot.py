"""Suggest that the robot stands elsewhere too, or that another robot folds the garment.

- **station**: one more place to stand: the far side, the middles of the sides, mirror images.
- **robot**: another robot, at the table and the place that suit it: the quickest of those that can fold the garment.
  The robots are tried one after the other, each proven by its plan; who asks says which there are.
"""

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace

from planner.errors import FoldingError
from planner.explain.suggestion import SuggestionTrial, each_cheaper
from planner.geometry.pose import Pose2, wrapped_angle
from planner.planning.robot_task import default_scene, near_placement, task_for
from planner.planning.warm_up import compile_kernels
from planner.robots.load_robot import prepare_robot, robot_card_file
from planner.robots.varied_card import split_changes
from planner.task.scene import STATIONS_MAX, Scene
from planner.task.task import DEFAULT_ROBOT, Task
from planner.words.catalogue import worded

BESIDE_TABLE_M = 0.15
"""Distance of the base's centre outside the table's edge (m)."""

_SAME_M = 0.05
"""Distance below which two stations can be the same (m)."""

_SAME_RAD = 0.1
"""Difference of headings below which two stations can be the same (rad)."""


@each_cheaper
def stations(task: Task) -> Iterator[SuggestionTrial]:
    """Yield trials of one more station each."""
    for name, pose in _others(task.scene):
        scene = replace(task.scene, stations=(*task.scene.stations, (name, pose)))
        says = worded("stand_also_at", {"station": name, "at": [pose.x_m, pose.y_m]})
        yield SuggestionTrial("station", says, 1.0, task, task.in_scene(scene))


def _others(scene: Scene) -> Iterator[tuple[str, Pose2]]:
    """Yield stations that the scene does not have, each under a name of its own."""
    taken = dict(scene.stations)
    room = STATIONS_MAX - len(taken)
    poses: list[Pose2] = list(taken.values())
    for wish, pose in (*_on_the_sides(scene), *_mirrored(scene)):
        if room and not any(_is_same(pose, other) for other in poses):
            name = _free(wish, taken)
            taken[name] = pose
            poses.append(pose)
            yield name, pose


def _on_the_sides(scene: Scene) -> Iterator[tuple[str, Pose2]]:
    x, y = scene.table.depth_m / 2 + BESIDE_TABLE_M, scene.table.width_m / 2 + BESIDE_TABLE_M
    yield "far", Pose2(x, 0.0, math.pi)
    yield "middle_left", Pose2(0.0, y, -math.pi / 2)
    yield "middle_right", Pose2(0.0, -y, math.pi / 2)
    yield "near", Pose2(-x, 0.0, 0.0)


def _mirrored(scene: Scene) -> Iterator[tuple[str, Pose2]]:
    """Yield every station mirrored to the other side of the table's axes."""
    for name, pose in scene.stations:
        yield f"{name}_mirrored", Pose2(pose.x_m, -pose.y_m, -pose.yaw_rad)
        yield f"{name}_opposite", Pose2(-pose.x_m, pose.y_m, math.pi - pose.yaw_rad)


def _is_same(one: Pose2, other: Pose2) -> bool:
    apart_m = math.hypot(one.x_m - other.x_m, one.y_m - other.y_m)
    return apart_m < _SAME_M and abs(wrapped_angle(one.yaw_rad - other.yaw_rad)) < _SAME_RAD


def _free(wish: str, taken: dict[str, Pose2]) -> str:
    name, number = wish, 2
    while name in taken:
        name, number = f"{wish}_{number}", number + 1
    return name


@each_cheaper
def robots(task: Task, names: Iterable[str], on_map: Callable[[float], None]) -> Iterator[SuggestionTrial]:
    """Yield trials of other robots.

    Args:
        task: the task; nothing is tried once a fold is done, since cloth is not carried to another table.
        names: the robots to try, each taken only when it is its turn. The task's own is left out, and so is one that
            cannot be loaded.
        on_map: called with how far the maps of a robot's arms are where they must be built, up to a minute;
            may raise `SpentError`, with which the search ends.
    """
    own = split_changes(task.robot)[0]
    for name in () if task.start.folds_done else names:
        if name == own:
            continue
        try:
            title = robot_card_file(name).title
            prepare_robot(name, on_map)
            compile_kernels(name)
            other = replace(task_for(task.garment, robot=name, placement=_placement(task, name)), limits=task.limits)
        except FoldingError:
            continue  # a robot of one's own whose files are gone helps nobody
        yield SuggestionTrial("robot", worded("other_robot", {"robot": name, "title": title}), 1.0, task, other)


def _placement(task: Task, robot: str) -> Pose2 | None:
    """Return where the garment would lie; None for the place in the robot's card."""
    if robot != DEFAULT_ROBOT:
        return None
    return near_placement(task.garment, default_scene(robot).table, task.start.placement.yaw_rad)
