"""The base's way round the table for the checker: back out, drive outside the grown table, drive in."""

import math
from itertools import pairwise, permutations
from typing import Any

from shapely import LineString, Point, box

from tests.replay.flat import Place

Pose = tuple[float, float, float]
CIRCLE_M = 0.47
DRIVE_M_S2, TURN_RAD_S2 = 0.5, 1.0
SLACK = 1e-4


def require_way_round(primitive: dict[str, Any], start: Pose, goal: Pose, scene: dict[str, Any]) -> None:
    """Fail unless a move's way-points are a shortest legal way and its duration is theirs."""
    poses: list[Pose] = [tuple(p) for p in primitive["waypoints"]]
    assert _is_same(poses[0], start), f"a move begins at {poses[0]}, the base is at {start}"
    assert _is_same(poses[-1], goal), f"a move ends at {poses[-1]}, the station is at {goal}"
    half_x = scene["table"]["depth_m"] / 2 + CIRCLE_M
    half_y = scene["table"]["width_m"] / 2 + CIRCLE_M
    inside = box(SLACK - half_x, SLACK - half_y, half_x - SLACK, half_y - SLACK)
    seconds = 0.0
    for one, other in pairwise(poses):
        drive, turn = math.dist(one[:2], other[:2]), abs(math.remainder(other[2] - one[2], math.tau))
        seconds += from_rest_to_rest_s(drive, scene["base_speed_m_s"], DRIVE_M_S2)
        seconds += from_rest_to_rest_s(turn, scene["base_turn_rad_s"], TURN_RAD_S2)
        assert drive < SLACK or turn < SLACK, f"the base turns while it drives from {one} to {other}"
        if turn > SLACK:
            assert not inside.contains(Point(one[:2])), f"the base turns at {one[:2]}, too near the table"
    assert abs(seconds - primitive["duration_s"]) < 1e-6, f"the way takes {seconds} s, the plan says otherwise"
    first, last = _backed_out(poses, inside), _backed_out(poses[::-1], inside)
    middle = [p[:2] for p in poses[first : len(poses) - last]]
    for a, b in pairwise(middle):
        is_through = inside.intersection(LineString([a, b])).length > SLACK
        assert not is_through, f"the base drives through the grown table from {a} to {b}"
    driven = sum(math.dist(a, b) for a, b in pairwise(middle))
    best = _shortest(middle[0], middle[-1], half_x, half_y)
    assert abs(driven - best) < 10 * SLACK, f"the way round is {driven:.3f} m, the shortest {best:.3f} m"


def from_rest_to_rest_s(way: float, speed: float, acceleration: float) -> float:
    """Return the time of a way as twice that to its middle, reached at the speed there or at top speed."""
    there = min(speed, math.sqrt(acceleration * way))
    ramp = there * there / (2.0 * acceleration)
    return 2.0 * (there / acceleration + (way / 2.0 - ramp) / speed)


def _backed_out(poses: list[Pose], inside: Any) -> int:
    """Return the index of the waypoint where the base is clear of the table, having gone straight back."""
    if not inside.contains(Point(poses[0][:2])):
        return 0
    (ax, ay, yaw), (bx, by, _) = poses[0], poses[1]
    length = math.dist((ax, ay), (bx, by))
    back = (ax - length * math.cos(yaw), ay - length * math.sin(yaw))
    assert math.dist(back, (bx, by)) < SLACK, f"the base leaves or enters {(ax, ay)} otherwise than along its x axis"
    assert not inside.contains(Point(bx, by)), f"the base is still too near the table at {(bx, by)}"
    assert inside.distance(Point(bx, by)) < 3 * SLACK, f"the base backs out further than it must, to {(bx, by)}"
    return 1


def _shortest(start: Place, goal: Place, half_x: float, half_y: float) -> float:
    """Return the length of the shortest way round a rectangle, by trying every sequence of its corners."""
    corners = [(-half_x, -half_y), (half_x, -half_y), (half_x, half_y), (-half_x, half_y)]
    inside = box(SLACK - half_x, SLACK - half_y, half_x - SLACK, half_y - SLACK)
    best = math.inf
    for count in range(4):
        for bends in permutations(corners, count):
            way = [start, *bends, goal]
            legs = list(pairwise(way))
            length = sum(math.dist(a, b) for a, b in legs)
            if length < best and not any(
                a != b and inside.intersection(LineString([a, b])).length > SLACK for a, b in legs
            ):
                best = length
    return best


def _is_same(a: Pose, b: Pose) -> bool:
    return math.dist(a[:2], b[:2]) < SLACK and abs(math.remainder(a[2] - b[2], math.tau)) < SLACK
