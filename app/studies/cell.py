"""A cell of a study: its values on all axes, and the task they make."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np

from app.rehearsal.rehearse import RehearsalOptions
from app.studies.axis import Value
from planner.cloth.garment import Garment
from planner.errors import FoldingError
from planner.geometry.pose import Pose2
from planner.geometry.table import Table
from planner.planning.robot_task import default_placement, default_scene, task_for
from planner.robots.varied_card import changed
from planner.task.scene import Scene
from planner.task.task import DEFAULT_ROBOT, Task, TaskOptions

ROBOT, PLACEMENT, START = "robot", "placement", "start_station"
TABLE, SCENE, LIMITS, CARD = "table.", "scene.", "limits.", "card."
MOVED, MIDDLE = "placement.moved.", "placement.middle."
"""The prefixes of the axes' names."""


@dataclass(frozen=True, slots=True)
class GarmentCase:
    """A garment as one value of a study's garment axis.

    Attributes:
        label: its name in the table, unique in the study.
        garment: the garment; None where its measures do not fit each other.
        seed: the seed of a random garment.
        measures: the measures that its template was given (m).
        error: why there is no garment.
    """

    label: str
    garment: Garment | None
    seed: int | None = None
    measures: Mapping[str, float] = field(default_factory=dict)
    error: str | None = None


@dataclass(frozen=True, slots=True)
class Cell:
    """A cell.

    Attributes:
        index: its number in the product.
        case: its garment.
        values: its values on the other axes, by name.
        task: its task; None where the values make none.
        error: why there is none.
        has_comfort_margin: whether its answer is to tell the comfort margin.
        rehearsal: how its plan is rehearsed; None: not at all.
    """

    index: int
    case: GarmentCase
    values: Mapping[str, Value]
    task: Task | None
    error: str | None = None
    has_comfort_margin: bool = False
    rehearsal: RehearsalOptions | None = None


def cell_of(
    index: int,
    case: GarmentCase,
    values: Mapping[str, Value],
    scene: Scene,
    placements: Sequence[Pose2],
    has_stations: bool,
) -> Cell:
    """Return the cell of a garment and values; values that do not go together are its error."""
    if case.garment is None:
        return Cell(index, case, values, None, case.error)
    try:
        robot = _robot(values)
        usual = default_scene(robot)
        if has_stations:
            usual = replace(usual, stations=scene.stations)
        there = _scene(usual, values, has_stations)
        options: Any = _within(LIMITS, values)
        own = default_placement(case.garment, robot)
        options["placement"] = _placement(case.garment, own, values, placements, usual.table, there.table)
        options |= {START: values[START]} if START in values else {}
        options["robot"] = robot
        given: TaskOptions = options
        return Cell(index, case, values, task_for(case.garment, there, **given))
    except FoldingError as error:
        return Cell(index, case, values, None, str(error))


def _robot(values: Mapping[str, Value]) -> str:
    """Return the robot's name, with the changes of its card."""
    return changed(str(values.get(ROBOT, DEFAULT_ROBOT)), _within(CARD, values))


def _within(prefix: str, values: Mapping[str, Value]) -> dict[str, Value]:
    return {name.removeprefix(prefix): value for name, value in values.items() if name.startswith(prefix)}


def _scene(scene: Scene, values: Mapping[str, Value], has_stations: bool) -> Scene:
    """Return the scene with the values' numbers; stations keep their distance to the table unless they were given."""
    sides: Any = _within(TABLE, values)
    numbers: Any = _within(SCENE, values)
    table = replace(scene.table, **sides)
    if not has_stations:
        numbers["stations"] = tuple((name, _beside(pose, scene.table, table)) for name, pose in scene.stations)
    return replace(scene, table=table, **numbers)


def _beside(pose: Pose2, before: Table, table: Table) -> Pose2:
    """Return a station that is as far outside the table's edges as it was outside another table's."""

    def out(at_m: float, side_m: float, other_m: float) -> float:
        return 0.0 if abs(at_m) <= side_m / 2 else math.copysign(1.0, at_m) * (other_m - side_m) / 2

    return pose.moved(out(pose.x_m, before.depth_m, table.depth_m), out(pose.y_m, before.width_m, table.width_m))


def _placement(
    garment: Garment,
    usual: Pose2,
    values: Mapping[str, Value],
    placements: Sequence[Pose2],
    before: Table,
    table: Table,
) -> Pose2:
    """Return where the garment lies.

    Its usual placement keeps its distance to the table's near edge; a turn is about the middle of its bounding box.
    """
    if PLACEMENT in values:
        return placements[int(values[PLACEMENT])]
    own = usual.moved((before.depth_m - table.depth_m) / 2, 0.0)
    outline = np.array(garment.outline)
    middle = (outline.min(axis=0) + outline.max(axis=0)) / 2
    at = own.to_outer(middle)
    moved: Any = _within(MOVED, values)
    wanted: Any = {"x_m": at[0], "y_m": at[1], "yaw_rad": own.yaw_rad} | _within(MIDDLE, values)
    moves = [moved.get(field.name, 0.0) for field in fields(Pose2)]
    goal = Pose2(float(wanted["x_m"] + moves[0]), float(wanted["y_m"] + moves[1]), wanted["yaw_rad"] + moves[2])
    if goal.yaw_rad == own.yaw_rad:
        return own.moved(goal.x_m - float(at[0]), goal.y_m - float(at[1]))
    turned = Pose2(0.0, 0.0, goal.yaw_rad).to_outer(middle)
    return Pose2(goal.x_m - float(turned[0]), goal.y_m - float(turned[1]), goal.yaw_rad)
