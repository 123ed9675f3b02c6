"""Where the hand that falls short would not: the edge of its reach, near the point that it cannot have.

A reason says that an arm is so much short of a point, seen from a station; the point may be high over the table, and
the hand is turned as suits its whole way. So this is not the reach over flat cloth but another region: of the plane at
the point's own height, for the one orientation in which the point is short by what the reason says. Which that is the
reason does not tell. It is found again by asking each orientation how far the point is out of comfort in it; where none
answers with the reason's own number nothing is shown, for any region would be about something else.

The region is looked for on a grid round the point, the finer the less is missing; the point is a place of the grid.
"""

import math
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
from planner.plan.reason import Reason
from planner.primitives.obstacle import Code
from planner.primitives.reach import Reach
from planner.robot.nearest_comfort import FINEST_M
from planner.robot.pr2 import load_robot

_STEPS, _CORNERS = 40, 96
_LEAST_M, _MOST_M = 0.12, 0.4

_SAME_M = 2 * FINEST_M
"""Shortfalls that differ by no more are the same (m): each is settled to half of it."""


@dataclass(frozen=True, slots=True)
class Lack:
    """What a reason says is out of reach, as the robot sees it.

    Attributes:
        arm: the arm's index.
        seen: the point in the base frame, the base standing where it comes closest (m).
        towards: the unit direction in which the point would have to be displaced, base frame.
        short_by_m: and how far (m).
        base: that base, table frame.
    """

    arm: int
    seen: Point3
    towards: Point3
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
        approach: the orientation of the hand.
        beyond: what of a disc round the point is out of comfort.
        edge: the lines at which that ends.
    """

    approach: Approach
    beyond: Region
    edge: tuple[FloatArray, ...]


def shortfall_overlay(moment: Moment) -> dict[str, Any] | None:
    """The reach round the point of the first reason that has one, as JSON, article frame; None if it is not short."""
    reason = moment.reason
    lack = None if reason is None else _lack(moment, reason)
    if reason is None or lack is None:
        return None
    reach = (ROBOT, moment.scene.torso_m, moment.comfort_m)
    near = near_reach(*reach, lack)
    if near is None or reason.point is None:
        return None
    base = moment.in_article(lack.base)
    x, y = moment.to_article(np.array(reason.point[:2]))
    return {
        "fold": reason.fold,
        "arm": reason.arm,
        "station": reason.station,
        "back_off_m": reason.back_off_m,
        "comfort_m": moment.comfort_m,
        "point": [float(x), float(y), reason.point[2]],
        "heading_rad": near.approach.heading_rad,
        "pitch_rad": near.approach.pitch_rad,
        "radius_m": lack.radius_m,
        "beyond": [
            region_to_dict(part)
            for part in near.beyond.moved(Isometry.rotation(base.yaw_rad, base.x_m, base.y_m)).pieces
        ],
        "edge": [base.to_outer(line).tolist() for line in near.edge],
    }


@lru_cache(maxsize=16)
def near_reach(robot: str, torso_m: float, comfort_m: float, lack: Lack) -> NearReach | None:
    """The reach round a point in the orientation in which it lacks what is said; None where it lacks that in none.

    Args:
        robot: the robot's name.
        torso_m: how far the lift is raised (m).
        comfort_m: how much slack every reach has (m).
        lack: the point, and what it lacks.

    Raises:
        SceneError: the lift does not go there.
    """
    reach = load_robot(robot).reach(torso_m, comfort_m)
    approach = _approach(reach, lack)
    if approach is None:
        return None
    x, y, height_m = lack.seen
    can_have = partial(in_approach, reach, lack.arm, height_m, approach)
    had = region_where(can_have, Grid.about((x, y), lack.radius_m, _STEPS))
    disc = _disc((x, y), lack.radius_m)
    beyond = disc.difference(had)
    return NearReach(reach.approaches[approach], beyond, _edge(beyond, disc))


def _lack(moment: Moment, reason: Reason) -> Lack | None:
    """What a reason says is lacking; None if it is not about reach, or about a place that is not there any more."""
    if reason.code is not Code.OUT_OF_REACH or None in (reason.point, reason.towards, reason.short_by_m):
        return None
    assert reason.point is not None and reason.towards is not None and reason.short_by_m is not None
    arms = [arm.name for arm in load_robot(ROBOT).card.arms]
    stations = dict(moment.scene.stations)
    if reason.arm not in arms or reason.station not in stations:
        return None
    base = stations[reason.station].ahead(-(reason.back_off_m or 0.0))
    over_floor = np.array(reason.point) + np.array([0.0, 0.0, moment.scene.table.height_m])
    towards = Pose2(0.0, 0.0, base.yaw_rad).to_inner(np.array(reason.towards))
    return Lack(arms.index(reason.arm), _point(base.to_inner(over_floor)), _point(towards), reason.short_by_m, base)


def _approach(reach: Reach, lack: Lack) -> int | None:
    """The orientation in which a point lacks what is said, most nearly so; None if it does in none."""
    point, best, least = np.array([lack.seen]), None, _SAME_M
    for approach in range(len(reach.approaches)):
        found = reach.shortfall(lack.arm, point, np.array([approach]), lack.short_by_m + _SAME_M)
        if found is None or math.dist(found.towards, lack.towards) > LENGTH_M:
            continue
        differs = abs(found.short_by_m - lack.short_by_m)
        if differs <= least and not found.is_at_least:
            best, least = approach, differs
    return best


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
