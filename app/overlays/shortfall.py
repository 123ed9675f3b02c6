"""The overlay of a shortfall: the edge of a hand's reach near a point beyond it.

A reason says by how much an arm falls short of a point, seen from a station. The point may be high above the table, and
the hand's orientation is that for its whole path. So the overlay cannot use the reach over flat cloth. It uses the
plane at the point's height and the orientation in which the reason measured the shortfall.

By then the robot may have dragged the cloth, while the board shows it as drawn. So the overlay moves everything back by
the drag.

The region comes from a grid about the point, finer for a smaller shortfall; the point is a grid point.
"""

from dataclasses import dataclass
from functools import lru_cache, partial

import numpy as np
from pydantic import BaseModel

from app.overlays.moment import Moment
from app.overlays.reach_region import Grid, RegionAnswer, in_approach, region_where, rings_of, runs
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Approach, FloatArray, Point2, Point3, Pose2, point3
from planner.geometry.region import Region
from planner.geometry.tolerance import LENGTH_M
from planner.robots.armed_robot import ArmedRobot
from planner.robots.load_robot import load_robot
from planner.task.reason import Reason

_STEPS, _CORNERS = 40, 96
"""Grid steps from the point to each side, and corners of the disc about it."""

_LEAST_M, _MOST_M = 0.12, 0.4
"""Range of the disc's radius (m)."""


@dataclass(frozen=True, slots=True)
class Lack:
    """A point that a reason says is out of reach, seen by the robot.

    Attributes:
        arm: the arm's index.
        seen: the point in the base frame, with the base where it comes closest (m).
        approach: the orientation of the hand.
        short_by_m: the distance by which to move the point into reach (m).
        base: that base in the table frame, moved back by the drag of the cloth.
    """

    arm: int
    seen: Point3
    approach: Approach
    short_by_m: float
    base: Pose2

    @property
    def radius_m(self) -> float:
        """The radius about the point in which to show the reach (m): the shortfall and a margin."""
        return min(max(_LEAST_M, 1.5 * self.short_by_m + 0.05), _MOST_M)


@dataclass(frozen=True, slots=True)
class NearReach:
    """The reach near a point, base frame.

    Attributes:
        beyond: the part of a disc about the point that lacks reach margin.
        edge: the lines at which that part ends.
    """

    beyond: Region
    edge: tuple[FloatArray, ...]


class ShortfallAnswer(BaseModel):
    """The part of the surroundings of a point out of reach that the hand, in its orientation, cannot reach (m, rad).

    `beyond` is a part of a disc of `radius_m` at the point's height, `edge` the lines at which it ends; heading and
    pitch are in the base frame. A robot that stands fast has no station, and none from which to stand back.
    """

    fold: int | None
    arm: str
    station: str | None
    back_off_m: float | None
    comfort_m: float
    point: Point3
    heading_rad: float
    pitch_rad: float
    radius_m: float
    beyond: list[RegionAnswer]
    edge: list[list[Point2]]


def shortfall_overlay(moment: Moment) -> ShortfallAnswer | None:
    """Return the reach near the point of the moment's reason, garment frame; None if it is not about reach."""
    reason = moment.reason
    lack = None if reason is None else _lack(moment, reason)
    if reason is None or lack is None:
        return None
    robot = load_robot(moment.robot)
    near = near_reach(robot, moment.scene.torso_m, moment.comfort_m, lack)
    base = moment.in_garment(lack.base)
    to_garment = Isometry.rotation(base.yaw_rad, base.x_m, base.y_m)
    x, y = base.to_outer(np.array(lack.seen[:2]))
    return ShortfallAnswer(
        fold=reason.fold,
        arm=robot.card.arms[lack.arm].name,
        station=reason.station,
        back_off_m=reason.back_off_m,
        comfort_m=moment.comfort_m,
        point=(float(x), float(y), lack.seen[2] - moment.scene.table.height_m),
        heading_rad=lack.approach.heading_rad,
        pitch_rad=lack.approach.pitch_rad,
        radius_m=lack.radius_m,
        beyond=[RegionAnswer.of(part) for part in near.beyond.moved(to_garment).pieces],
        edge=[base.to_outer(line).tolist() for line in near.edge],
    )


@lru_cache(maxsize=16)
def near_reach(robot: ArmedRobot, torso_m: float, comfort_m: float, lack: Lack) -> NearReach:
    """Return the reach near a point with a fixed orientation of the hand.

    Args:
        robot: the robot.
        torso_m: the height of the lift (m).
        comfort_m: the comfort radius (m).
        lack: the point, and the orientation of the hand.

    Raises:
        SceneError: the lift does not reach this height.
    """
    reach = robot.reach(torso_m, comfort_m)
    x, y, height_m = lack.seen
    can_have = partial(in_approach, reach, lack.arm, height_m, reach.approaches.index(lack.approach))
    had = region_where(can_have, Grid.about((x, y), lack.radius_m, _STEPS))
    disc = _disc((x, y), lack.radius_m)
    beyond = disc.difference(had)
    return NearReach(beyond, _edge(beyond, disc))


def _lack(moment: Moment, reason: Reason) -> Lack | None:
    """Return the point out of reach; None if a reason is not about reach, or its arm or station no longer exists."""
    point, approach, offset_m, short_by_m = reason.point, reason.approach, reason.offset_m, reason.short_by_m
    if point is None or approach is None or offset_m is None or short_by_m is None:
        return None
    card = load_robot(moment.robot).card
    stations: dict[str | None, Pose2] = dict(moment.scene.stations)
    if card.is_fixed:  # its base is at no station that has a name
        stations = {None: moment.scene.stations[0][1]}
    arms = [arm.name for arm in card.arms]
    if reason.arm not in arms or reason.station not in stations:
        return None
    base = stations[reason.station].ahead(-(reason.back_off_m or 0.0))
    over_floor = np.array(point) + np.array([0.0, 0.0, moment.scene.table.height_m])
    dx, dy = offset_m
    return Lack(arms.index(reason.arm), point3(base.to_inner(over_floor)), approach, short_by_m, base.moved(-dx, -dy))


def _disc(middle: Point2, radius_m: float) -> Region:
    angles = np.linspace(0.0, 2.0 * np.pi, _CORNERS, endpoint=False)
    return Region.polygon(np.array(middle) + radius_m * np.column_stack([np.cos(angles), np.sin(angles)]))


def _edge(beyond: Region, disc: Region) -> tuple[FloatArray, ...]:
    """Return the boundary lines of the part out of reach, without the disc's own boundary."""
    lines: list[FloatArray] = []
    for ring in (ring for part in beyond.pieces for ring in rings_of(part)):
        middles = (ring + np.roll(ring, -1, axis=0)) / 2.0
        is_edge = np.array([disc.boundary_distance((float(x), float(y))) > LENGTH_M for x, y in middles])
        first = int(np.argmin(is_edge))
        closed = np.roll(ring, -first, axis=0)
        lines += [np.vstack([closed, closed[:1]])[start : end + 1] for start, end in runs(np.roll(is_edge, -first))]
    return tuple(lines)
