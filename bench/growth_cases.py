"""Problems of any size that a PR2 can solve: many folds, many stations, a larger comfort radius.

All cloth lies lengthwise before the robot, the garment's x to the robot's right. A ribbon that is rolled up is a chain:
each fold waits for the one before. Tabs are independent, so every set of them may be done first; tabs along two sides
are out of reach from a single station, so that the order in which they are folded matters.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

from planner.cloth.garment import DEFAULT_DENSITY_KG_M2, DEFAULT_GRIP_RADIUS_M, DrawnFold, Garment
from planner.geometry.pose import Point2, Pose2
from planner.task.scene import Scene

LENGTH_M = 0.8
RIBBON_M = 0.2
"""Width of the ribbon (m): one grip holds both corners of its end."""

TAB_M, TAB_SHARE = 0.05, 0.6
"""The depth of a tab (m), and the fraction of a side that is tabs."""

NARROW_M, BROAD_M = 0.3, 0.5
"""Width of the cloth between the tabs (m) with tabs along one side, and along two."""

BESIDE_M = 0.15
"""Distance of a base from the table's edge (m)."""


def ribbon(folds: int) -> Garment:
    """Return a ribbon rolled up from its left end."""
    step = LENGTH_M / (folds + 1)
    outline = ((0.0, 0.0), (LENGTH_M, 0.0), (LENGTH_M, RIBBON_M), (0.0, RIBBON_M))
    lines = [((step * (i + 1), 0.0), (step * (i + 1), RIBBON_M)) for i in range(folds)]
    return _garment("ribbon", outline, lines, ahead_m=-0.45)


def tabs(folds: int) -> Garment:
    """Return cloth with tabs along the side next to the robot, each to be folded in."""
    side = _tabs(folds, 0.0)
    outline = ((0.0, 0.0), *(point for tab in side for point in tab), (LENGTH_M, 0.0))
    lines = [(tab[-1], tab[0]) for tab in side]
    return _garment("tabs", (*outline, (LENGTH_M, NARROW_M), (0.0, NARROW_M)), lines, ahead_m=-0.5)


def tabs_on_two_sides(folds: int) -> Garment:
    """Return cloth with half of the tabs next to the robot, the others opposite."""
    near, far = _tabs(folds // 2, 0.0), _tabs(folds - folds // 2, BROAD_M)
    outline = (
        (0.0, 0.0),
        *(point for tab in near for point in tab),
        (LENGTH_M, 0.0),
        (LENGTH_M, BROAD_M),
        *(point for tab in reversed(far) for point in reversed(tab)),
        (0.0, BROAD_M),
    )
    lines = [*((tab[-1], tab[0]) for tab in near), *((tab[0], tab[-1]) for tab in far)]
    return _garment("tabs-on-two-sides", outline, lines, ahead_m=-0.45)


def crowded(stations: int) -> Scene:
    """Return the default scene with more stations, evenly along the near, the left and the right edge."""
    scene = Scene()
    table, given = scene.table, scene.stations
    x, y = table.depth_m / 2 + BESIDE_M, table.width_m / 2 + BESIDE_M
    quarter = math.pi / 2
    sides = (
        ((table.depth_m / 2, y), (-table.depth_m / 2, y), -quarter),
        ((-x, table.width_m / 2), (-x, -table.width_m / 2), 0.0),
        ((-table.depth_m / 2, -y), (table.depth_m / 2, -y), quarter),
    )
    lengths = [math.dist(start, end) for start, end, _ in sides]
    more = []
    for number in range(stations - len(given)):
        along = (number + 0.5) / (stations - len(given)) * sum(lengths)
        side = 0
        while along > lengths[side]:
            along, side = along - lengths[side], side + 1
        start, end, yaw = sides[side]
        part = along / lengths[side]
        place = (start[0] + part * (end[0] - start[0]), start[1] + part * (end[1] - start[1]))
        more.append((f"station_{number}", Pose2(*place, yaw)))
    return replace(scene, stations=(*given, *more))


def _tabs(count: int, y: float) -> list[list[Point2]]:
    """Return the corners of tabs along a side, each from left to right; they point down at y = 0, else up."""
    pitch = LENGTH_M / count
    tip = y - TAB_M if y == 0.0 else y + TAB_M
    found = []
    for number in range(count):
        left = (number + 0.5 * (1.0 - TAB_SHARE)) * pitch
        right = left + TAB_SHARE * pitch
        found.append([(left, y), (left, tip), (right, tip), (right, y)])
    return found


def _garment(name: str, outline: Sequence[Point2], lines: Sequence[tuple[Point2, Point2]], ahead_m: float) -> Garment:
    """Return cloth centred before the robot, its lower side at a distance ahead of the table's middle (m)."""
    radius = DEFAULT_GRIP_RADIUS_M
    folds = tuple(DrawnFold(f"fold {i}", "blue", start, end, radius) for i, (start, end) in enumerate(lines))
    placement = Pose2(ahead_m, LENGTH_M / 2, -math.pi / 2)
    return Garment(name, name, tuple(outline), DEFAULT_DENSITY_KG_M2, folds, radius, placement)
