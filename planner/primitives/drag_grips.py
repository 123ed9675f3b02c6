"""The direction, the length and the grips of a drag (paper, Theorem 2), and where drags can carry an article."""

import math
from itertools import product

import numpy as np

from planner.cloth.grip_candidates import distinct_rows
from planner.cloth.grips import GripCovers, grip_covers
from planner.cloth.must_hold import must_hold
from planner.cloth.trailing_strips import strip_tips
from planner.geometry.pose import FloatArray, Point2
from planner.geometry.tolerance import ANGLE_RAD, LENGTH_M, grid_key
from planner.primitives.context import DRAGS_PER_M, Context


def longest_drag(context: Context) -> int:
    """Return the length of the longest drag, in steps of the grid of drags.

    It is the article's length: the longer side of its smallest enclosing rectangle.
    """
    return math.floor(context.sequence.garment.pattern.length * DRAGS_PER_M + LENGTH_M)


def dragged(context: Context, offset: Point2, station: int, steps: int) -> Point2:
    """Return the article's offset from the start (m) after a drag from a station by `steps` of the grid of drags."""
    yaw = context.station_pose(station).yaw_rad
    distance = steps / DRAGS_PER_M
    return (offset[0] - distance * math.cos(yaw), offset[1] - distance * math.sin(yaw))


def arm_drag_steps(context: Context, station: int) -> tuple[Point2, ...]:
    """Return the article's displacement in one step of a drag by the arms in each direction, table frame (m).

    They lead to the eight neighbours on a grid along the axes of the station.
    """
    yaw, step = context.station_pose(station).yaw_rad, 1 / DRAGS_PER_M
    ahead, aside = (step * math.cos(yaw), step * math.sin(yaw)), (-step * math.sin(yaw), step * math.cos(yaw))
    return tuple(
        (x * ahead[0] + y * aside[0], x * ahead[1] + y * aside[1]) for x, y in product((-1, 0, 1), repeat=2) if x or y
    )


def arm_dragged(offset: Point2, step: Point2, steps: int) -> Point2:
    """Return the article's offset from the start (m) after a drag by the arms by some steps."""
    return (offset[0] + steps * step[0], offset[1] + steps * step[1])


def towards_robot(context: Context, station: int) -> Point2:
    """Return the direction of a drag from a station: a unit vector, article frame."""
    heading = context.station_pose(station).yaw_rad + math.pi - context.placement.yaw_rad
    return (math.cos(heading), math.sin(heading))


def along(context: Context, move: Point2) -> Point2:
    """Return the direction of a displacement in the table frame: a unit vector, article frame."""
    heading = math.atan2(move[1], move[0]) - context.placement.yaw_rad
    return (math.cos(heading), math.sin(heading))


def hangs_ahead(context: Context, done: int, offset: Point2, towards: Point2) -> bool:
    """Return whether cloth already hangs over an edge towards which a drag would go."""
    coordinates = context.sequence.cloth(done).silhouette.coordinates
    for edge in context.table_in_article(offset).edges:
        outwards = -(edge.left[0] * towards[0] + edge.left[1] * towards[1])
        if outwards > ANGLE_RAD and edge.left_distances(coordinates).min() < -LENGTH_M:
            return True
    return False


def drag_covers(context: Context, done: int, offset: Point2, towards: Point2) -> GripCovers:
    """Return the grips for what must be held of the part on the table: by Theorem 2, and the tips of trailing strips.

    Where that is all of it, they are the same wherever it lies, and kept.
    """
    where = None if context.is_all_on_table(done, offset) else offset
    key, known = (done, where, towards, len(context.reach.arm_names)), context.cloth.drag_covers
    found = known.get(key)
    if found is None:
        found = known[key] = _drag_covers(context, done, offset, towards)
    return found


def _drag_covers(context: Context, done: int, offset: Point2, towards: Point2) -> GripCovers:
    silhouette = context.sequence.cloth(done).silhouette
    lying = silhouette.intersection(context.table_in_article(offset).region)
    vertices = must_hold(lying, towards, (), context.scene.support_angle_rad)
    vertices = distinct_rows(np.concatenate([vertices, strip_tips(lying, towards)]))
    return grip_covers(lying, vertices, context.sequence.garment.grip_radius_m, len(context.reach.arm_names))


def drag_offsets(context: Context, most: int) -> FloatArray:
    """Return the offsets to which drags can carry the article with a part of it on the table, shape (n, 2), m.

    The search for offsets stops once there are more than `most`.
    """
    table, size = context.scene.table, context.sequence.garment.pattern.bounds
    corners = context.placement.to_outer(np.array([(size[i], size[j]) for i in (0, 2) for j in (1, 3)]))
    low, high = corners.min(axis=0), corners.max(axis=0)
    half = np.array([table.depth_m / 2, table.width_m / 2])
    (x0, y0), (x1, y1) = (-half - high).tolist(), (half - low).tolist()
    steps = [dragged(context, (0.0, 0.0), station, 1) for station in range(len(context.scene.stations))]
    if context.is_fixed:
        steps = list(arm_drag_steps(context, 0))
    found: dict[tuple[int, int], Point2] = {(0, 0): (0.0, 0.0)}
    front = [(0.0, 0.0)]
    while front and len(found) <= most:
        x, y = front.pop()
        for dx, dy in steps:
            after = (x + dx, y + dy)
            key = (grid_key(after[0]), grid_key(after[1]))
            if key not in found and x0 < after[0] < x1 and y0 < after[1] < y1:
                found[key] = after
                front.append(after)
    return np.array(list(found.values()))
