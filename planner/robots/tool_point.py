"""Where an arm's fingers are relative to its card's tool point: a first check of whether they meet in that point.

Tools pass two centimetres over the table. A tool point behind the fingertips, or beside the plane in which the fingers
meet, brings the fingers into the table top in most approaches.
"""

from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from planner.geometry.pose import FloatArray
from planner.robots.collision.link_shapes import LinkShape, link_shapes
from planner.robots.collision.rigid_groups import Carrier, Skeleton
from planner.robots.described_robot import DescribedArm, DescribedRobot

BEYOND_OFF_M, BEFORE_OFF_M, BESIDE_OFF_M = 0.012, 0.015, 0.005
"""Distances of the fingertips from a tool point from which a card is worth a look (m): beyond it, where less than 8 mm
are left between them and the table top, which tools pass by 2 cm; before it, where they hold no cloth; beside it.
"""

_TIP_M = 0.02
"""Length of the fingertips that meet (m); jaws whose lengths differ by more do not meet."""

_A_LITTLE = 0.25
"""Share of the widest opening by which fingers are opened to see which way each of them moves."""

_STILL_M = 1e-4
"""A part of the gripper that moves less along the closing direction is no jaw (m)."""


@dataclass(frozen=True, slots=True)
class ToolPoint:
    """Where the closed fingers of an arm are, seen from its tool point.

    Attributes:
        arm: the arm's name.
        beyond_m: how far the fingertips reach beyond it along the approach axis; negative: they end before it (m).
        beside_m: how far the plane in which the fingers meet lies beside it along the closing axis (m); None where
            nothing meets a finger.
    """

    arm: str
    beyond_m: float
    beside_m: float | None

    @property
    def is_off(self) -> bool:
        """Whether it is far from where the fingertips meet."""
        is_beside = abs(self.beside_m or 0.0) > BESIDE_OFF_M
        return is_beside or not -BEFORE_OFF_M <= self.beyond_m <= BEYOND_OFF_M


def tool_points(robot: DescribedRobot) -> tuple[ToolPoint, ...]:
    """Return where the fingers of each arm are relative to its tool point; arms without shapes of fingers are left out.

    Raises:
        RobotError: a mesh cannot be read or is too large.
    """
    skeleton = Skeleton(robot)
    hands = {Carrier(arm, len(one.card.joints) - 1) for arm, one in enumerate(robot.arms)}

    def is_wanted(joint: int) -> bool:
        carrier = skeleton.carrier(joint)
        return carrier.is_finger or carrier in hands

    shapes = link_shapes(skeleton.model, robot.urdf, is_wanted)
    found = (_tool_point(skeleton, shapes, number, arm) for number, arm in enumerate(robot.arms))
    return tuple(one for one in found if one is not None)


def _tool_point(skeleton: Skeleton, shapes: tuple[LinkShape, ...], number: int, arm: DescribedArm) -> ToolPoint | None:
    last = Carrier(number, len(arm.card.joints) - 1)
    fixed = [
        _in_tool(arm, shape, skeleton.placement(shape)) for shape in shapes if skeleton.carrier(shape.joint) == last
    ]
    jaws: dict[bool, list[FloatArray]] = {False: [], True: []}
    for shape in shapes:
        carrier = skeleton.carrier(shape.joint)
        if (carrier.arm, carrier.is_finger) != (number, True):
            continue
        closed, opened = (
            _in_tool(arm, shape, skeleton.placement_open(shape, share * arm.card.gripper.opening_max_m))
            for share in (0.0, _A_LITTLE)
        )
        moved_m = float((opened - closed)[..., 1].mean())
        if abs(moved_m) > _STILL_M:
            jaws[moved_m > 0.0].append(closed)
    right, left = (jaws[side] or fixed for side in (False, True))
    if not (jaws[False] or jaws[True]):
        return None
    beyond_m = max(float(part[..., 0].max()) for part in (*right, *left))
    return ToolPoint(arm.card.name, beyond_m, _meeting_m(right, left))


def _meeting_m(right: list[FloatArray], left: list[FloatArray]) -> float | None:
    """Return where the plane between the tips of two jaws is, along the closing axis (m); None where they do not meet.

    Args:
        right: triangles of the jaw towards the negative side of that axis.
        left: triangles of the other.
    """
    if not (right and left):
        return None
    ends = [max(float(part[..., 0].max()) for part in jaw) for jaw in (right, left)]
    if abs(ends[0] - ends[1]) > _TIP_M:
        return None
    tips = [np.concatenate([_within(part, min(ends) - _TIP_M, min(ends)) for part in jaw]) for jaw in (right, left)]
    return 0.5 * float(tips[0][:, 1].max() + tips[1][:, 1].min())


def _within(triangles: FloatArray, low: float, high: float) -> FloatArray:
    """Return the corners of what of some triangles lies between two heights along x; shape (n, 3)."""
    found = [triangles[(triangles[..., 0] >= low) & (triangles[..., 0] <= high)]]
    starts, ends = triangles.reshape(-1, 3), np.roll(triangles, -1, axis=1).reshape(-1, 3)
    for plane in (low, high):
        crossing = (starts[:, 0] - plane) * (ends[:, 0] - plane) < 0.0
        one, other = starts[crossing], ends[crossing]
        share = (plane - one[:, :1]) / (other[:, :1] - one[:, :1])
        found.append(one + share * (other - one))
    return np.concatenate(found)


def _in_tool(arm: DescribedArm, shape: LinkShape, placement: pin.SE3) -> FloatArray:
    """Return the triangles of a shape that is placed in the last joint's frame, seen from the tool; (n, 3, 3)."""
    corners = _triangles(shape) @ placement.rotation.T + placement.translation
    return np.asarray((corners - arm.chain.tool_offset) @ arm.chain.tool_rotation)


def _triangles(shape: LinkShape) -> FloatArray:
    """Return the triangles of a mesh, or of the hull of another shape, in its own frame, shape (n, 3, 3)."""
    if shape.triangles is not None:
        return np.asarray(shape.geometry.vertices()[shape.triangles])
    from scipy.spatial import ConvexHull  # slow to import, and needed only for some cards

    own = (shape.corners - shape.placement.translation) @ shape.placement.rotation
    return np.asarray(own[ConvexHull(own).simplices])
