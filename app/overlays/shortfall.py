"""Where the hand that falls short would not: the edge of its reach, near the point that it cannot have.

A reason says that an arm is so much short of a point, seen from a station; the point may be high over the table, and
the hand is turned as suits its whole way. So this is not the reach over flat cloth but another region: of the plane at
the point's own height, for the orientation in which the reason measured what is missing.

The robot may have dragged the cloth by then, and the board shows it as it is drawn. So all is moved back by the drag,
and lies over the cloth there as it does where the cloth would be.

The region is looked for on a grid round the point, the finer the less is missing; the point is a place of the grid.
"""

from dataclasses import dataclass
from functools import lru_cache, partial
from typing import Any

import numpy as np

from app.open_document import ROBOT
from app.overlays.moment import Moment
from app.overlays.reach_region import Grid, in_approach, region_where, runs
from app.overlays.region_json import region_to_dict, rings_of
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Approach, FloatArray, Point2, Point3, Pose2
from planner.geometry.region import Region
from planner.geometry.tolerance import LENGTH_M
from planner.robot.pr2 import load_robot
from planner.task.reason import Reason

_STEPS, _CORNERS = 40, 96
_LEAST_M, _MOST_M = 0.12, 0.4


@dataclass(frozen=True, slots=True)
class Lack:
    """What a reason says is out of reach, as the robot sees it.

    Attributes:
        arm: the arm's index.
        seen: the point in the base frame, the base standing where it comes closest (m).
        approach: how the hand is turned.
        short_by_m: how far the point would have to be displaced (m).
        base: that base in the table frame, moved back by what the cloth had been dragged.
    """

    arm: int
    seen: Point3
    approach: Approach
    short_by_m: float
    base: Pose2

    @property
    def radius_m(self) -> float:
        """How far round the point the reach is worth showing (m): with what is missing, and some more."""
        return min(max(_LEAST_M, 1.5 * self.short_by_m + 0.05), _MOST_M)


@dataclass(frozen=True, slots=True)
class NearReach:
    """The reach round a point, base frame.

    Attributes:
        beyond: what of a disc round the point is out of comfort.
        edge: the lines at which that ends.
    """

    beyond: Region
    edge: tuple[FloatArray, ...]


def shortfall_overlay(moment: Moment) -> dict[str, Any] | None:
    """The reach round the point of the first reason that has one, as JSON, article frame; None if it is not short."""
    reason = moment.reason
    lack = None if reason is None else _lack(moment, reason)
    if reason is None or lack is None:
        return None
    near = near_reach(ROBOT, moment.scene.torso_m, moment.comfort_m, lack)
    base = moment.in_article(lack.base)
    to_article = Isometry.rotation(base.yaw_rad, base.x_m, base.y_m)
    x, y = base.to_outer(np.array(lack.seen[:2]))
    return {
        "fold": reason.fold,
        "arm": reason.arm,
        "station": reason.station,
        "back_off_m": reason.back_off_m,
        "comfort_m": moment.comfort_m,
        "point": [float(x), float(y), lack.seen[2] - moment.scene.table.height_m],
        "heading_rad": lack.approach.heading_rad,
        "pitch_rad": lack.approach.pitch_rad,
        "radius_m": lack.radius_m,
        "beyond": [region_to_dict(part) for part in near.beyond.moved(to_article).pieces],
        "edge": [base.to_outer(line).tolist() for line in near.edge],
    }


@lru_cache(maxsize=16)
def near_reach(robot: str, torso_m: float, comfort_m: float, lack: Lack) -> NearReach:
    """The reach round a point, the hand turned as it is.

    Args:
        robot: the robot's name.
        torso_m: how far the lift is raised (m).
        comfort_m: how much slack every reach has (m).
        lack: the point, and how the hand is turned.

    Raises:
        SceneError: the lift does not go there.
    """
    reach = load_robot(robot).reach(torso_m, comfort_m)
    x, y, height_m = lack.seen
    can_have = partial(in_approach, reach, lack.arm, height_m, reach.approaches.index(lack.approach))
    had = region_where(can_have, Grid.about((x, y), lack.radius_m, _STEPS))
    disc = _disc((x, y), lack.radius_m)
    beyond = disc.difference(had)
    return NearReach(beyond, _edge(beyond, disc))


def _lack(moment: Moment, reason: Reason) -> Lack | None:
    """What a reason says is lacking; None if it is not about reach, or about a place that is not there any more."""
    point, approach, offset_m, short_by_m = reason.point, reason.approach, reason.offset_m, reason.short_by_m
    if point is None or approach is None or offset_m is None or short_by_m is None:
        return None
    arms = [arm.name for arm in load_robot(ROBOT).card.arms]
    stations = dict(moment.scene.stations)
    if reason.arm not in arms or reason.station not in stations:
        return None
    base = stations[reason.station].ahead(-(reason.back_off_m or 0.0))
    over_floor = np.array(point) + np.array([0.0, 0.0, moment.scene.table.height_m])
    dx, dy = offset_m
    return Lack(arms.index(reason.arm), _point(base.to_inner(over_floor)), approach, short_by_m, base.moved(-dx, -dy))


def _disc(middle: Point2, radius_m: float) -> Region:
    angles = np.linspace(0.0, 2.0 * np.pi, _CORNERS, endpoint=False)
    return Region.polygon(np.array(middle) + radius_m * np.column_stack([np.cos(angles), np.sin(angles)]))


def _edge(beyond: Region, disc: Region) -> tuple[FloatArray, ...]:
    """Where what is beyond ends, but for where merely the disc ends in which it was looked for."""
    lines: list[FloatArray] = []
    for ring in (ring for part in beyond.pieces for ring in rings_of(part)):
        middles = (ring + np.roll(ring, -1, axis=0)) / 2.0
        is_edge = np.array([disc.boundary_distance((float(x), float(y))) > LENGTH_M for x, y in middles])
        first = int(np.argmin(is_edge))
        closed = np.roll(ring, -first, axis=0)
        lines += [np.vstack([closed, closed[:1]])[start : end + 1] for start, end in runs(np.roll(is_edge, -first))]
    return tuple(lines)


def _point(row: FloatArray) -> Point3:
    return (float(row[0]), float(row[1]), float(row[2]))
