"""Towels whose last flap is folded again, by red folds.

The towel is 0.4 x 0.6 m. At yaw -90 degrees its upper edge lies away from `front`: garment (x, y) is at table
(y - 0.75, 0.2 - x). Its near part, y < 0.25, comes over first: its free edge, y = 0 before, lands at y = 0.5.
"""

import math

from planner.cloth.garment import DrawnFold, Garment
from planner.geometry.pose import Pose2
from tests.builders import fold, garment, rectangle_points

WIDTH_M = 0.4
OVER = fold((WIDTH_M, 0.25), (0.0, 0.25), name="over")
# Of the flap, 0.25 < y < 0.5, the outer part goes back: y > 0.4 lands at 0.3 < y < 0.4. Of that y < 0.35 goes out
# again.
BACK = fold((0.0, 0.4), (WIDTH_M, 0.4), "red", name="back")
OUT = fold((WIDTH_M, 0.35), (0.0, 0.35), "red", name="out")
# Or only its right outer corner goes back: the triangle beyond (0.25, 0.5) and (0.4, 0.4).
CORNER = fold((0.25, 0.5), (WIDTH_M, 0.4), "red", name="corner")


def towel(*folds: DrawnFold) -> Garment:
    return garment(rectangle_points(WIDTH_M, 0.6), *folds, placement=Pose2(-0.75, WIDTH_M / 2, -math.pi / 2))


# A cloth 0.6 x 0.24 m. Its left part, x < 0.16, comes over and its edge goes back again; on its own, x > 0.48 comes
# over.
LEFT = fold((0.16, 0.0), (0.16, 0.24), name="left")
EDGE = fold((0.24, 0.24), (0.24, 0.0), "red", name="edge")
RIGHT = fold((0.48, 0.24), (0.48, 0.0), name="right")
TWO_SIDES = garment(rectangle_points(0.6, 0.24), LEFT, EDGE, RIGHT, placement=Pose2(-0.6, 0.3, -math.pi / 2))
