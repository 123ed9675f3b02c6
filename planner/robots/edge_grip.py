"""Grips at the edge of cloth: one finger under it, sliding over the table, and one over it.

Fingers that close along the table pinch flat cloth on a ridge only. With one finger under the cloth and one over it
they hold its edge, but the lower finger must fit between tool and table: whether it does depends on the pitch and on
the gripper's own shapes. Tools are at a given height when they hold cloth. Open fingers are often lower or higher than
that allows, so a hand opens and closes at the height at which its lower finger just clears the table.
"""

import math
from dataclasses import dataclass

import numpy as np

from planner.geometry.pose import FloatArray
from planner.robots.card import EDGE_OPEN_M, HELD_M, LOWERED_MAX_M, RAISED_MAX_M
from planner.robots.collision.collisions import TIP_CLEAR_M
from planner.robots.collision.robot_parts import RobotParts
from planner.robots.collision.rounded_hull import RoundedHull
from planner.robots.collision.separation import END, HAND

FINGER_CLEAR_M, BODY_CLEAR_M = 0.0003, 0.0015
"""Distance that fingertips, and all else of a hand, keep from the table (m); collision checks ask for 0.1 and 1 mm."""


@dataclass(frozen=True, slots=True)
class HandShape:
    """A hand's shapes seen from its tool.

    Attributes:
        openings_m: the openings of the fingers for which there are shapes (m), in rising order.
        hulls: for each of these openings the corners of each part (m), shape (n, 3), and how far the part extends
            beyond their hull (m).
        is_tip: which parts are fingertips.
    """

    openings_m: tuple[float, ...]
    hulls: tuple[tuple[tuple[FloatArray, float], ...], ...]
    is_tip: tuple[bool, ...]

    @staticmethod
    def of(parts: RobotParts, arm: int, offset: FloatArray, rotation: FloatArray) -> "HandShape":
        """Return an arm's hand.

        Args:
            parts: the robot's parts.
            arm: the arm.
            offset: the tool's position in the frame of the arm's last joint (m), shape (3,).
            rotation: the tool's axes in that frame, as columns, shape (3, 3).
        """
        own = range(int(parts.arms[arm, HAND]), int(parts.arms[arm, END]))

        def seen(hull: RoundedHull) -> tuple[FloatArray, float]:
            return (hull.corners - offset) @ rotation, hull.radius_m

        hulls = tuple(tuple(seen(of_level[part]) for part in own) for of_level in parts.hulls)
        return HandShape(parts.openings_m, hulls, tuple(bool(parts.is_tip[part]) for part in own))

    def raised_m(self, opening_m: float, height_m: float, pitch_rad: float, side: float) -> float:
        """Return how far a hand must be raised to clear a table (m); negative: it may be lowered as far.

        Args:
            opening_m: the opening up to which its fingers may be open (m).
            height_m: the tool's height above the table (m).
            pitch_rad: how far the fingers point below the horizontal (rad).
            side: 1 where the closing axis points up, -1 where it points down.
        """
        level = next(n for n, one in enumerate(self.openings_m) if one >= opening_m or n == len(self.openings_m) - 1)
        up = np.array([-math.sin(pitch_rad), side * math.cos(pitch_rad), 0.0])
        wanted = (FINGER_CLEAR_M if is_tip else BODY_CLEAR_M for is_tip in self.is_tip)
        lowest = (float((corners @ up).min()) - radius_m for corners, radius_m in self.hulls[level])
        return max(clear_m - (height_m + low_m) for clear_m, low_m in zip(wanted, lowest, strict=True))


def edge_raised_m(hand: HandShape, height_m: float, pitch_rad: float) -> float | None:
    """Return how far above its path a hand opens and closes to hold cloth at its edge (m); negative: below.

    The finger that can come nearer to the table is the lower one.

    Args:
        hand: the hand.
        height_m: the tool's height above the table while it holds cloth that lies (m).
        pitch_rad: how far the fingers point below the horizontal (rad).

    Returns:
        The height; None where a finger would be in the table, or the hand too far from its path.
    """
    sides = [
        side for side in (1.0, -1.0) if hand.raised_m(HELD_M, height_m, pitch_rad, side) <= FINGER_CLEAR_M - TIP_CLEAR_M
    ]
    raised = [hand.raised_m(EDGE_OPEN_M, height_m, pitch_rad, side) for side in sides]
    able = [one for one in raised if -LOWERED_MAX_M <= one <= RAISED_MAX_M]
    return min(able, default=None)
