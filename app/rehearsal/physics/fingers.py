"""The bodies of a hand's two fingers, one under the cloth that it holds and one over it.

Fingers are boxes of the card's size that push cloth out of their way without friction: MuJoCo takes a body that is
moved from outside to be at rest. Closing on cloth that lies on the table, the lower one lifts it by its own thickness;
on a stack it lies between that and what was folded, and is drawn out from there once the hand has opened.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from app.rehearsal.physics.pinch import OPENING_M, PAD_M
from planner.geometry.pose import FloatArray
from planner.robots.card_parts import GripperFile

_DRAWN_M_S, _GOES_ON_M_S = 0.2, 0.1
"""How quickly an open hand is drawn back from cloth that it has laid down, and goes on before (m/s); assumptions."""

_STACK_SHARE = 0.5
"""The height of the highest stack that a pinch holds, as a share of how wide fingers open at a stack.

An assumption: the pads of fingers that stand far apart are no longer parallel, and what is between them slips out.
"""

_CLEAR_M = 5e-4
"""The room between cloth and the fingers that hold it (m)."""


@dataclass(frozen=True, slots=True)
class FingerSize:
    """The size of each of a hand's fingers.

    Attributes:
        length_m: along the direction in which it points (m).
        width_m: across that and across the direction in which it closes (m).
        thickness_m: along the direction in which it closes (m).
        opening_m: how wide the hand opens (m).
    """

    length_m: float
    width_m: float
    thickness_m: float
    opening_m: float

    @staticmethod
    def of(gripper: GripperFile) -> "FingerSize":
        """Return the size of a gripper's fingers."""
        return FingerSize(
            gripper.finger_length_m, gripper.finger_width_m, gripper.finger_thickness_m, gripper.opening_max_m
        )

    @property
    def stack_max_m(self) -> float:
        """The height of the layers pressed on one another above which a pinch slips (m)."""
        return _STACK_SHARE * min(self.opening_m, OPENING_M)


@dataclass(frozen=True, slots=True, eq=False)
class Box:
    """A finger in space.

    Attributes:
        middle: its middle, table frame, shape (3,), m.
        axes: the directions along its length, width and thickness as columns, shape (3, 3).
    """

    middle: FloatArray
    axes: FloatArray

    def shifted(self, ahead_m: float) -> "Box":
        """Return it further along its length (m)."""
        return replace(self, middle=self.middle + ahead_m * self.axes[:, 0])


@dataclass(frozen=True, slots=True, eq=False)
class Leaving:
    """The finger of an open hand that is still under the cloth that it has laid down.

    Attributes:
        finger: where it is.
        ahead_m: how far it goes on where it points (m).
        back_m: how far it is drawn back from there until it is out (m).
    """

    finger: Box
    ahead_m: float
    back_m: float

    def after(self, time_s: float) -> "Leaving | None":
        """Return it a time later (s); None once it is out."""
        if self.ahead_m > 0.0:
            way_m = min(_GOES_ON_M_S * time_s, self.ahead_m)
            return Leaving(self.finger.shifted(way_m), self.ahead_m - way_m, self.back_m)
        way_m = _DRAWN_M_S * time_s
        return None if self.back_m <= way_m else Leaving(self.finger.shifted(-way_m), 0.0, self.back_m - way_m)


def around(points: FloatArray, closing: FloatArray, heading_rad: float, size: FingerSize, open_m: float) -> list[Box]:
    """Return the lower finger and the upper one round the cloth that they hold.

    Args:
        points: the points of the cloth between them, table frame, shape (n, 3), m.
        closing: from the finger that is below when the hand closes on the table to the other, of length 1, shape (3,).
        heading_rad: the direction in which they point, horizontal, table frame (rad).
        size: a finger's size.
        open_m: how far the second one is from the cloth still (m).
    """
    ahead = np.array([math.cos(heading_rad), math.sin(heading_rad), 0.0])
    ahead -= (ahead @ closing) * closing
    length = float(np.linalg.norm(ahead))
    if length < _CLEAR_M:  # they point where they close: nothing tells how they are turned
        return []
    ahead /= length
    tip = points.mean(axis=0)
    back = tip + (PAD_M - size.length_m / 2.0) * ahead
    heights = (points - tip) @ closing
    beyond = size.thickness_m / 2.0 + _CLEAR_M
    axes = np.column_stack([ahead, np.cross(closing, ahead), closing])
    shifts = float(heights.min()) - beyond, float(heights.max()) + beyond + open_m
    return [Box(back + shift * closing, axes) for shift in shifts]


def lowest(boxes: Iterable[Box]) -> Box:
    """Return the box with the lowest middle; once the fingers have turned over that is the other one."""
    return min(boxes, key=lambda box: float(box.middle[2]))
