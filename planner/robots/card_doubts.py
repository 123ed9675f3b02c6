"""Parts of a robot's card that are allowed but probably not meant: found without the maps of its arms, in seconds.

Stations at which the base would stand in the table or its legs are among them.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise, product
from typing import Protocol, TypeAlias

import coal
import numpy as np
import pinocchio as pin

from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.table import Table
from planner.robots.chain import length_of, tool_poses
from planner.robots.collision.link_shapes import LinkShape, link_shapes
from planner.robots.collision.rigid_groups import BODY, Carrier, Skeleton
from planner.robots.described_robot import DescribedArm, DescribedRobot

TOGETHER_M = 0.05
"""Arms whose roots are nearer than this stand in each other (m)."""

_CROSSED_M = 0.05
"""Arms are in the wrong order if one stands further to the left than the one named before it, by more than this (m)."""

_NEAR_M = 0.1
"""A base that stands as near to the table's middle has no side on which the table is (m)."""

_AWAY_RAD = 2.0 * math.pi / 3.0
"""Arms that reach further than this off the way to the table face away from it: ready arms reach 50 degrees aside."""

_SMALL_M, _SMALL_LINK_M = 1e-3, 5e-3
"""A part of a robot whose every side is shorter is in the wrong unit; all parts of an arm's long link together (m)."""

_LONG = 10.0
"""A link is long if the next joint, or the tool, is so many times further away than its parts are large."""

_INSIDE_M = 5e-3
"""Arms stand in each other if they would still touch this much further apart (m)."""


@dataclass(frozen=True, slots=True)
class ArmsTogether:
    """Two arms that begin in one place, or whose first links lie inside each other.

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
    """A station at which the base has the table beside it or behind it.

    Attributes:
        station: its name.
        away_rad: the angle between where the base looks and the table's middle (rad).
    """

    station: str
    away_rad: float


@dataclass(frozen=True, slots=True)
class MountFacesAway:
    """A mount whose arms at home reach away from the table, at every station at which the base looks towards it.

    Attributes:
        mount: its name; empty for a card's only one.
        away_rad: the angle between where the arms reach and the table (rad).
    """

    mount: str
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


Doubt: TypeAlias = ArmsTogether | ArmsCrossed | StationFacesAway | MountFacesAway | OddPart


def card_doubts(robot: DescribedRobot) -> tuple[Doubt, ...]:
    """Return what of a robot's card is probably not meant.

    Raises:
        RobotError: a mesh cannot be read or is too large.
    """
    skeleton = Skeleton(robot)
    shapes = link_shapes(skeleton.model, robot.urdf)
    arms = _arms(robot, skeleton, shapes)
    scene = robot.card.scene
    away = tuple(_stations(scene.stations, scene.table))
    facing = [base for name, base in scene.stations if name not in {doubt.station for doubt in away}]
    return (*_odd_parts(robot, skeleton, shapes), *arms, *away, *_mounts(robot, facing))


def _odd_parts(robot: DescribedRobot, skeleton: Skeleton, shapes: Sequence[LinkShape]) -> Iterator[OddPart]:
    """Yield each link once that has an odd shape, its oddest."""
    longest = max(length_of(arm.chain) for arm in robot.arms)
    robot_m = longest + max(float(np.linalg.norm(arm.root)) for arm in robot.arms)
    found: dict[str, OddPart] = {}
    sizes = [float(np.ptp(shape.corners, axis=0).max()) for shape in shapes]
    carriers = [skeleton.carrier(shape.joint) for shape in shapes]
    largest: dict[Carrier, float] = {}
    for carrier, size_m in zip(carriers, sizes, strict=True):
        largest[carrier] = max(size_m, largest.get(carrier, 0.0))
    for shape, carrier, size_m in zip(shapes, carriers, sizes, strict=True):
        is_carried = carrier.arm != BODY
        is_small = size_m < _SMALL_M or (is_carried and _is_small(robot, carrier, largest[carrier]))
        if is_small or size_m > (longest if is_carried else robot_m):
            known = found.get(shape.link)
            if known is None or size_m > known.size_m:
                found[shape.link] = OddPart(shape.link, size_m, longest if is_carried else robot_m)
    yield from found.values()


def _is_small(robot: DescribedRobot, carrier: Carrier, size_m: float) -> bool:
    """Return whether the largest part of an arm's link is tiny, though the link reaches far."""
    chain = robot.arms[carrier.arm].chain
    beyond = (*chain.offsets[1:], chain.tool_offset)[carrier.joint]
    return not carrier.is_finger and size_m < _SMALL_LINK_M and float(np.linalg.norm(beyond)) > _LONG * size_m


def _arms(
    robot: DescribedRobot, skeleton: Skeleton, shapes: Sequence[LinkShape]
) -> Iterator[ArmsTogether | ArmsCrossed]:
    # Arms of one URDF stand where their maker has put them, and their housings may reach into each other.
    is_mounted = len(robot.card.mounts) > 1
    first = [_first_links(number, arm, skeleton, shapes) if is_mounted else [] for number, arm in enumerate(robot.arms)]
    for (one, its), (other, others) in combinations(zip(robot.arms, first, strict=True), 2):
        apart = other.root - one.root
        apart_m = float(np.linalg.norm(apart))
        if apart_m < TOGETHER_M or _are_inside(its, others, _INSIDE_M / apart_m * apart):
            yield ArmsTogether((one.card.name, other.card.name), apart_m)
    for one, other in pairwise(robot.arms):
        left_m = float(other.root[1] - one.root[1])
        if left_m > _CROSSED_M:
            yield ArmsCrossed((one.card.name, other.card.name), left_m)


_Placed: TypeAlias = tuple[str, coal.CollisionGeometry, pin.SE3]
"""A shape in the base frame: its link, the shape, its place."""


def _first_links(number: int, arm: DescribedArm, skeleton: Skeleton, shapes: Sequence[LinkShape]) -> list[_Placed]:
    """Return the shapes of the link that an arm stands on, and of the first that moves, all joints of arms at 0."""
    model = skeleton.model
    joint = model.frames[model.getFrameId(arm.card.joints[0], pin.FrameType.JOINT)]
    foot, frame = model.frames[joint.parentFrame].name, skeleton.frames[number][0]
    found = []
    for shape in shapes:
        carrier = skeleton.carrier(shape.joint)
        if shape.link == foot and carrier.arm == BODY:
            found.append((shape.link, shape.geometry, skeleton.placement(shape)))
        elif carrier == Carrier(number, 0):
            found.append((shape.link, shape.geometry, frame * skeleton.placement(shape)))
    return found


def _are_inside(some: Sequence[_Placed], others: Sequence[_Placed], away: FloatArray) -> bool:
    """Return whether shapes of two arms would still touch if the others stood further away by a vector (m)."""
    for (link, shape, place), (other_link, other, other_place) in product(some, others):
        moved = pin.SE3(other_place.rotation, other_place.translation + away)
        if link != other_link and coal.collide(
            shape, place, other, moved, coal.CollisionRequest(), coal.CollisionResult()
        ):
            return True
    return False


def _stations(stations: tuple[tuple[str, Pose2], ...], table: Table) -> Iterator[StationFacesAway]:
    """Yield the stations whose base has the nearest point of the table, or its middle from within, beside or behind."""
    for name, base in stations:
        away_rad = _away_rad(base, table)
        if away_rad is not None and away_rad > 0.5 * math.pi - 1e-3:
            yield StationFacesAway(name, away_rad)


def _away_rad(place: Pose2, table: Table) -> float | None:
    """Return the angle between where something looks and the table (rad); None if it stands on the table's middle."""
    x = min(max(place.x_m, -0.5 * table.depth_m), 0.5 * table.depth_m)
    y = min(max(place.y_m, -0.5 * table.width_m), 0.5 * table.width_m)
    is_within = math.hypot(x - place.x_m, y - place.y_m) < _NEAR_M
    to = (-place.x_m, -place.y_m) if is_within else (x - place.x_m, y - place.y_m)
    if math.hypot(*to) < _NEAR_M:
        return None
    return abs(math.remainder(math.atan2(to[1], to[0]) - place.yaw_rad, math.tau))


def _mounts(robot: DescribedRobot, facing: Sequence[Pose2]) -> Iterator[MountFacesAway]:
    """Yield the mounts whose arms together reach away from the table at home, from base poses that look towards it."""
    for mount in robot.card.mounts:
        prefix = f"{mount.name}_" if mount.name else ""
        arms = [arm for arm in robot.arms if arm.card.joints[0].startswith(prefix)]
        reach = [tool_poses(arm.chain, np.array([arm.card.home]))[0][0, :2] for arm in arms]
        ahead_m = np.mean(reach, axis=0) if reach else np.zeros(2)
        if float(np.hypot(*ahead_m)) < _NEAR_M:
            continue
        x_m, y_m = np.mean([arm.root[:2] for arm in arms], axis=0).tolist()
        yaw_rad = math.atan2(ahead_m[1], ahead_m[0])
        found = (_away_rad(_placed(base, x_m, y_m, yaw_rad), robot.card.scene.table) for base in facing)
        angles = [away_rad for away_rad in found if away_rad is not None]
        if angles and min(angles) > _AWAY_RAD:
            yield MountFacesAway(mount.name, min(angles))


def _placed(base: Pose2, x_m: float, y_m: float, yaw_rad: float) -> Pose2:
    """Return a pose in the base frame as one in the table frame."""
    x, y = base.to_outer(np.array([x_m, y_m])).tolist()
    return Pose2(x, y, math.remainder(base.yaw_rad + yaw_rad, math.tau))


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
