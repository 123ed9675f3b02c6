"""Find the base's route from one pose to another, round the table (paper, section 6, Move).

The base backs out until the circle round it is clear of the table and turns in place. It then drives the shortest
polyline outside the table grown by that circle (with square corners), turning at each bend. Finally it turns to the
goal's heading and drives in.
"""

import itertools
import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache

import networkx as nx

from planner.geometry.pose import Point2, Pose2, wrapped_angle
from planner.geometry.table import Table
from planner.geometry.tolerance import LENGTH_M
from planner.primitives.drive_time import DriveTime

_ROUTES_KEPT = 4096
"""Routes that are remembered, some 1 kB each: all plans at a table drive between the same places."""


@dataclass(frozen=True, slots=True)
class Route:
    """A route of the base.

    Attributes:
        waypoints: base poses from start to end, table frame; between two waypoints the base either drives straight or
            turns in place, from rest to rest.
    """

    waypoints: tuple[Pose2, ...]

    def durations_s(self, time: DriveTime) -> tuple[float, ...]:
        """Return the time that each leg takes (s)."""
        legs = zip(self.waypoints[:-1], self.waypoints[1:], strict=True)
        return tuple(
            time.driving_s(math.dist((a.x_m, a.y_m), (b.x_m, b.y_m)))
            + time.turning_s(abs(wrapped_angle(b.yaw_rad - a.yaw_rad)))
            for a, b in legs
        )


@lru_cache(_ROUTES_KEPT)
def route_round(start: Pose2, goal: Pose2, table: Table, circle_m: float) -> Route:
    """Return the route of a base from one pose to another, its circle clear of the table between the two."""
    out, outside = clear_of_table(start, table, circle_m), clear_of_table(goal, table, circle_m)
    return route_along(start, out, shortest_way(place_of(out), place_of(outside), table, circle_m), outside, goal)


def clear_of_table(pose: Pose2, table: Table, circle_m: float) -> Pose2:
    """Return the pose backed out, no further than needed, until its circle is clear of the table.

    A pose whose heading is such that backing out never clears the table is returned unchanged.
    """
    half_x, half_y = table.depth_m / 2 + circle_m, table.width_m / 2 + circle_m
    if abs(pose.x_m) >= half_x - LENGTH_M or abs(pose.y_m) >= half_y - LENGTH_M:
        return pose
    dx, dy = -math.cos(pose.yaw_rad), -math.sin(pose.yaw_rad)
    ways = [
        (math.copysign(half, step) - place) / step
        for place, step, half in ((pose.x_m, dx, half_x), (pose.y_m, dy, half_y))
        if abs(step) > LENGTH_M
    ]
    return pose.ahead(-min(ways))


def shortest_way(start: Point2, goal: Point2, table: Table, circle_m: float) -> tuple[Point2, ...]:
    """Return the bends of the shortest polyline between two points outside the grown table, ends included."""
    half_x, half_y = table.depth_m / 2 + circle_m, table.width_m / 2 + circle_m
    corners = [(-half_x, -half_y), (half_x, -half_y), (half_x, half_y), (-half_x, half_y)]
    graph: nx.Graph[Point2] = nx.Graph()
    places = [start, goal, *corners]
    for i, a in enumerate(places):
        for b in places[i + 1 :]:
            if a != b and not _crosses(a, b, half_x, half_y):
                graph.add_edge(a, b, weight=math.dist(a, b))
    if start == goal:
        return (start,)
    ways: list[list[Point2]] = list(nx.all_shortest_paths(graph, start, goal, weight="weight"))
    return tuple(min(ways, key=_turning))


def route_along(start: Pose2, out: Pose2, bends: tuple[Point2, ...], outside: Pose2, goal: Pose2) -> Route:
    """Return the route that backs out, drives from bend to bend, turns to the goal's heading and drives in."""
    poses = [start, out]
    for a, b in itertools.pairwise(bends):
        if math.dist(a, b) > LENGTH_M:
            heading = math.atan2(b[1] - a[1], b[0] - a[0])
            poses += [Pose2(*a, heading), Pose2(*b, heading)]
    poses += [Pose2(outside.x_m, outside.y_m, goal.yaw_rad), goal]
    distinct = [poses[0]]
    for pose in poses[1:]:
        if not _is_same(pose, distinct[-1]):
            distinct.append(pose)
    return Route(tuple(distinct) if len(distinct) > 1 else (start, goal))


def place_of(pose: Pose2) -> Point2:
    """Return the place of a pose."""
    return (pose.x_m, pose.y_m)


def _is_same(a: Pose2, b: Pose2) -> bool:
    is_same_place = math.dist(place_of(a), place_of(b)) <= LENGTH_M
    return is_same_place and abs(wrapped_angle(a.yaw_rad - b.yaw_rad)) <= LENGTH_M


def _turning(way: Iterable[Point2]) -> float:
    """Return the sum of the turns at the bends of a polyline (rad)."""
    headings = [math.atan2(b[1] - a[1], b[0] - a[0]) for a, b in itertools.pairwise(way)]
    return sum(abs(wrapped_angle(b - a)) for a, b in itertools.pairwise(headings))


def _crosses(a: Point2, b: Point2, half_x: float, half_y: float) -> bool:
    """Return whether a segment passes through the interior of the rectangle (Liang-Barsky)."""
    low, high = 0.0, 1.0
    for place, step, half in ((a[0], b[0] - a[0], half_x), (a[1], b[1] - a[1], half_y)):
        inner = half - LENGTH_M
        if abs(step) <= LENGTH_M:
            if abs(place) >= inner:
                return False
            continue
        first, second = sorted(((-inner - place) / step, (inner - place) / step))
        low, high = max(low, first), min(high, second)
    return low < high
