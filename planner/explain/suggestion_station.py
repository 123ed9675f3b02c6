"""Suggest one more place where the robot may stand: the far side, the middles of the sides, mirror images."""

import math
from collections.abc import Iterator
from dataclasses import replace

from planner.explain.suggestion_trial import Search, SuggestionTrial, each_cheaper
from planner.geometry.pose import Pose2, wrapped_angle
from planner.task.scene import STATIONS_MAX, Scene
from planner.task.task import Task
from planner.words.catalogue import worded

BESIDE_TABLE_M = 0.15
"""Distance of the base's centre outside the table's edge (m)."""

_SAME_M = 0.05
"""Distance below which two stations can be the same (m)."""

_SAME_RAD = 0.1
"""Difference of headings below which two stations can be the same (rad)."""


def stations(task: Task) -> Search:
    """Look for one more station that gives a plan; then for one that gives a cheaper plan."""
    return each_cheaper(_trial(task, name, pose) for name, pose in _others(task.scene))


def _trial(task: Task, name: str, pose: Pose2) -> SuggestionTrial:
    scene = replace(task.scene, stations=(*task.scene.stations, (name, pose)))
    says = worded("stand_also_at", {"station": name, "at": [pose.x_m, pose.y_m]})
    return SuggestionTrial("station", says, {"scene": scene.to_dict()}, 1.0, task.in_scene(scene))


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
