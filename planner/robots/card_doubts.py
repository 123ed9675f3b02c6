"""Parts of a robot's card that are allowed but probably not meant: found without the maps of its arms, in seconds.

Stations at which the base would stand in the table or its legs are among them.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, pairwise
from typing import Protocol, TypeAlias

import numpy as np

from planner.geometry.pose import Pose2
from planner.geometry.table import Table
from planner.robots.chain import length_of
from planner.robots.collision.link_shapes import link_shapes
from planner.robots.collision.rigid_groups import BODY, Skeleton
from planner.robots.described_robot import DescribedRobot

TOGETHER_M = 0.05
"""Arms whose roots are nearer than this stand in each other (m)."""

_CROSSED_M = 0.05
"""Arms are in the wrong order if one stands further to the left than the one named before it, by more than this (m)."""

_NEAR_M = 0.1
"""A base that stands as near to the table's middle has no side on which the table is (m)."""

_SMALL_M = 1e-3
"""A part of a robot whose every side is shorter is in the wrong unit (m)."""


@dataclass(frozen=True, slots=True)
class ArmsTogether:
    """Two arms that begin in one place.

    Attributes:
        arms: their names.
        apart_m: the distance of their roots (m).
    """

    arms: tuple[str, str]
    apart_m: float


@dataclass(frozen=True, slots=True)
class ArmsCrossed:
    """Two arms that are not named from left to right.

    Attributes:
        arms: their names, in the card's order.
        left_m: how far the second stands to the left of the first (m).
    """

    arms: tuple[str, str]
    left_m: float


@dataclass(frozen=True, slots=True)
class StationFacesAway:
    """A station at which the base has the table behind it.

    Attributes:
        station: its name.
        away_rad: the angle between where the base looks and the table's middle (rad).
    """

    station: str
    away_rad: float


@dataclass(frozen=True, slots=True)
class OddPart:
    """A link with a shape that is larger than the whole robot, or hardly there: most often its unit is another.

    Attributes:
        link: its name.
        size_m: the longest side of the shape (m).
        most_m: the length of the arm that it is part of, or the reach of the robot from its base frame (m).
    """

    link: str
    size_m: float
    most_m: float


Doubt: TypeAlias = ArmsTogether | ArmsCrossed | StationFacesAway | OddPart


def card_doubts(robot: DescribedRobot) -> tuple[Doubt, ...]:
    """Return what of a robot's card is probably not meant.

    Raises:
        RobotError: a mesh cannot be read or is too large.
    """
    return (*_odd_parts(robot), *_arms(robot), *_stations(robot.card.scene.stations, robot.card.scene.table))


def _odd_parts(robot: DescribedRobot) -> Iterator[OddPart]:
    """Yield each link once that has an odd shape, its oddest."""
    skeleton = Skeleton(robot)
    longest = max(length_of(arm.chain) for arm in robot.arms)
    robot_m = longest + max(float(np.linalg.norm(arm.root)) for arm in robot.arms)
    found: dict[str, OddPart] = {}
    for shape in link_shapes(skeleton.model, robot.urdf):
        size_m = float(np.ptp(shape.corners, axis=0).max())
        is_carried = skeleton.carrier(shape.joint).arm != BODY
        if size_m < _SMALL_M or size_m > (longest if is_carried else robot_m):
            known = found.get(shape.link)
            if known is None or size_m > known.size_m:
                found[shape.link] = OddPart(shape.link, size_m, longest if is_carried else robot_m)
    yield from found.values()


def _arms(robot: DescribedRobot) -> Iterator[ArmsTogether | ArmsCrossed]:
    for one, other in combinations(robot.arms, 2):
        apart_m = float(np.linalg.norm(one.root - other.root))
        if apart_m < TOGETHER_M:
            yield ArmsTogether((one.card.name, other.card.name), apart_m)
    for one, other in pairwise(robot.arms):
        left_m = float(other.root[1] - one.root[1])
        if left_m > _CROSSED_M:
            yield ArmsCrossed((one.card.name, other.card.name), left_m)


def _stations(stations: tuple[tuple[str, Pose2], ...], table: Table) -> Iterator[StationFacesAway]:
    """Yield the stations from which the nearest point of the table, or its middle from within, lies behind the base."""
    for name, base in stations:
        x = min(max(base.x_m, -0.5 * table.depth_m), 0.5 * table.depth_m)
        y = min(max(base.y_m, -0.5 * table.width_m), 0.5 * table.width_m)
        is_within = math.hypot(x - base.x_m, y - base.y_m) < _NEAR_M
        to = (-base.x_m, -base.y_m) if is_within else (x - base.x_m, y - base.y_m)
        if math.hypot(*to) < _NEAR_M:
            continue
        away_rad = abs(math.remainder(math.atan2(to[1], to[0]) - base.yaw_rad, math.tau))
        if away_rad > 0.5 * math.pi + 1e-3:
            yield StationFacesAway(name, away_rad)


_STEP_M, _FURTHEST_M = 0.01, 1.0
"""Room further back is looked for in such steps, and so far back at most (m)."""


class Standing(Protocol):
    """A check of where a base may stand."""

    def body_free(self, base_in_table: Pose2) -> bool:
        """Return whether the robot without its arms stays clear of the table."""
        ...


@dataclass(frozen=True, slots=True)
class StationInTable:
    """A station at which the base touches the table.

    Attributes:
        station: its name.
        back_m: how much further back the base stands free (m); None where it does not within a metre.
    """

    station: str
    back_m: float | None


def stations_in_table(stations: tuple[tuple[str, Pose2], ...], table: Standing) -> tuple[StationInTable, ...]:
    """Return the stations at which the base touches the table.

    Args:
        stations: base poses in the table frame by name.
        table: the check of where the base may stand at the table.
    """
    return tuple(StationInTable(name, _back_m(pose, table)) for name, pose in stations if not table.body_free(pose))


def _back_m(pose: Pose2, table: Standing) -> float | None:
    steps = np.arange(1, round(_FURTHEST_M / _STEP_M) + 1)
    return next((float(step * _STEP_M) for step in steps if table.body_free(pose.ahead(-float(step) * _STEP_M))), None)
