"""Complete a task for a robot: scene, station or placement left out are those of the robot's card."""

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Unpack

import numpy as np

from planner.cloth.garment import Garment
from planner.errors import FoldingError
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.table import Table
from planner.robots.card_file import CardFile
from planner.robots.load_robot import robot_card_file
from planner.robots.varied_card import split_changes
from planner.task.scene import Scene
from planner.task.task import DEFAULT_ROBOT, Task, TaskOptions, require_options

INSIDE_M = 0.05
"""The distance of the cloth from the table's near edge, for a robot that has no placement of its own (m)."""

_DECIMALS = 6
"""The resolution at which two overhangs beyond the table count as equal (decimals of a metre)."""


def default_scene(robot: str = DEFAULT_ROBOT) -> Scene:
    """Return the scene that suits a robot; raises `UnknownRobotError` or `RobotError` where there is none."""
    return Scene() if robot == DEFAULT_ROBOT else _scene(robot_card_file(robot))


def _scene(card: CardFile) -> Scene:
    base, suits = card.base, card.scene
    whole = Scene(
        table=suits.table,
        stations=suits.stations,
        torso_m=suits.torso_m,
        base_speed_m_s=base.speed_m_s,
        base_turn_rad_s=base.turn_rad_s,
    )
    return replace(whole, back_off_max_m=0.0) if base.kind == "fixed" else whole


def with_robots_scene(request: Any) -> Any:  # noqa: ANN401
    """Return a request's JSON with a scene that is given in part filled up by that of the robot it names.

    A request for the default robot, and one that is wrong in these fields, is returned as it is.
    """
    if not isinstance(request, dict):
        return request
    robot, scene = request.get("robot", DEFAULT_ROBOT), request.get("scene")
    if not isinstance(robot, str) or not isinstance(scene, dict) or robot == DEFAULT_ROBOT:
        return request
    try:
        filled = default_scene(robot).to_dict()
    except FoldingError:
        return request
    return {**request, "scene": scene_filled_up(scene, filled)}


def scene_filled_up(scene: Mapping[str, Any], whole: Mapping[str, Any]) -> dict[str, Any]:
    """Return a scene's JSON with the fields that it leaves out, or that are null, taken from another one."""
    given = {name: value for name, value in scene.items() if value is not None}
    table = given.get("table")
    if isinstance(table, dict):
        given["table"] = {**whole["table"], **{name: value for name, value in table.items() if value is not None}}
    return {**whole, **given}


def default_placement(garment: Garment, robot: str = DEFAULT_ROBOT) -> Pose2:
    """Return where a garment lies at the start for a robot, table frame.

    It is the garment's own placement for the default robot, for whose table garments are made. For another robot the
    middle of the bounding box lies where the card says, or as near to that as leaves no edge beyond the table. It is
    turned as the garment's own placement and the card say, or by quarter turns from there if the table is too small for
    it that way.
    """
    if split_changes(robot)[0] == DEFAULT_ROBOT:
        return garment.placement
    suits = robot_card_file(robot).scene
    usual_rad = garment.placement.yaw_rad + suits.placement.yaw_rad
    turns = [Pose2(0.0, 0.0, usual_rad + quarters * math.pi / 2) for quarters in (0, 1, -1, 2)]
    top = np.array([suits.table.depth_m, suits.table.width_m])
    turned = min(turns, key=lambda one: round(float(np.maximum(_size(garment, one) - top, 0.0).sum()), _DECIMALS))
    room = np.maximum(top - _size(garment, turned), 0.0) / 2
    corners = turned.to_outer(np.array(garment.outline))
    middle = (corners.min(axis=0) + corners.max(axis=0)) / 2
    x_m, y_m = (np.clip([suits.placement.x_m, suits.placement.y_m], -room, room) - middle).tolist()
    return turned.moved(x_m, y_m)


def near_placement(garment: Garment, table: Table, yaw_rad: float) -> Pose2:
    """Return the placement of a garment turned by an angle whose near edge lies just inside the table's (m)."""
    turned = Pose2(0.0, 0.0, yaw_rad)
    corners = turned.to_outer(np.array(garment.outline))
    (x0, y0), (_, y1) = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
    return turned.moved(INSIDE_M - table.depth_m / 2 - x0, -(y0 + y1) / 2)


def _size(garment: Garment, turned: Pose2) -> FloatArray:
    """Return how long and wide a turned garment is (m)."""
    return np.asarray(np.ptp(turned.to_outer(np.array(garment.outline)), axis=0))


def task_for(garment: Garment, scene: Scene | None = None, **options: Unpack[TaskOptions]) -> Task:
    """Return the task of folding a garment; what is left out suits the robot.

    Args:
        garment: the garment.
        scene: the scene; None for the one that suits the robot.
        options: those of `Task.of`. A robot whose scene has no station of the default name starts at the first one.

    Raises:
        UnknownRobotError: there is no such robot.
        RequestError: there is no such station or option, an option is of the wrong kind or a limit is out of range.
    """
    require_options(scene, options)
    robot = options.get("robot", DEFAULT_ROBOT)
    where = scene or default_scene(robot)
    if options.get("placement") is None and options.get("start") is None:
        options["placement"] = default_placement(garment, robot)
    if "start_station" not in options and robot != DEFAULT_ROBOT:
        options["start_station"] = where.stations[0][0]
    return Task.of(garment, where, **options)
