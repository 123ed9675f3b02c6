"""A robot's parts with everything about them that does not depend on the posture."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import coal
import numpy as np

from planner.geometry.pose import BoolArray, FloatArray
from planner.robots.collision.arm_kinematics import ArmKinematics
from planner.robots.collision.part_poses import Index
from planner.robots.collision.rounded_hull import RoundedHull
from planner.robots.collision.separation import END, FIRST, Parts


@dataclass(frozen=True, slots=True, eq=False)
class RobotParts:
    """A robot's parts: those of its arms, arm after arm and from the shoulder outwards, then the body's.

    Attributes:
        kinematics: what poses the arms' parts.
        arms: which parts and how many joints each arm has, see `planner.robots.collision.separation.Parts`.
        names: the name of each part for people.
        openings_m: the openings of the fingers for which there are shapes (m), in rising order.
        hulls: for each of these openings the parts' shapes, those of mirrored parts before they are mirrored.
        convexes: the same shapes for coal, mirrored where they are.
        is_mirrored: which parts have left-handed frames, shape (p,).
        is_tip: which parts are fingertips, shape (p,).
        low_parts: for each arm the first part from which on they may come low over cloth.
        own_pairs: for each arm the pairs of its parts with the body and with each other.
        skipped: the pairs of parts of two arms that are not compared.
        body_poses: rotations and, in their last row, positions (m) of the body's parts in the base frame, with the
            lift down, shape (b, 4, 3).
        is_lifted: which of the body's parts the lift raises, shape (b,).
        is_fixed: whether the body stands still at the table, with which it is then not compared.
        mirror: the factors of the first arm's joints that make the second the mirror image of the first, shape (n,);
            None where it is not.
    """

    kinematics: ArmKinematics
    arms: Index
    names: tuple[str, ...]
    openings_m: tuple[float, ...]
    hulls: tuple[tuple[RoundedHull, ...], ...]
    convexes: tuple[tuple[coal.Convex, ...], ...]
    is_mirrored: BoolArray
    is_tip: BoolArray
    low_parts: tuple[int, ...]
    own_pairs: tuple[Index, ...]
    body_poses: FloatArray
    is_lifted: BoolArray
    skipped: frozenset[tuple[int, int]] = frozenset()
    is_fixed: bool = False
    mirror: FloatArray | None = None

    def of_arm(self, arm: int) -> range:
        """Return the numbers of an arm's parts."""
        return range(int(self.arms[arm, FIRST]), int(self.arms[arm, END]))

    @property
    def body(self) -> range:
        """The numbers of the body's parts."""
        return range(int(self.arms[-1, END]), len(self.names))


def compiled_parts(robot: RobotParts, level: int, clouds: Sequence[FloatArray] = ()) -> Parts:
    """Return the robot's parts, and the hulls of point clouds, in the form of the compiled pass.

    Args:
        robot: the robot's parts.
        level: the index in `openings_m` of the fingers' opening.
        clouds: the points of each hull, shape (n, 3), m; these hulls come last.
    """
    parts = _compiled_robot(robot, level)
    if not clouds:
        return parts
    others = _compiled(clouds, np.zeros(len(clouds)))
    others[1][:] += len(parts.corners)
    corners, spans, bounds = (np.vstack(both) for both in zip(parts[:3], others, strict=True))
    return Parts(corners, spans, bounds, parts.arms)


@lru_cache(maxsize=32)
def _compiled_robot(robot: RobotParts, level: int) -> Parts:
    hulls = robot.hulls[level]
    rounding = np.array([hull.radius_m for hull in hulls])
    return Parts(*_compiled([hull.corners for hull in hulls], rounding), robot.arms)


def _compiled(clouds: Sequence[FloatArray], rounding: FloatArray) -> tuple[FloatArray, Index, FloatArray]:
    low, high = (np.array([limit(cloud, axis=0) for cloud in clouds]) for limit in (np.min, np.max))
    middle, half = (low + high) / 2, (high - low) / 2 + rounding[:, None]
    radius = [np.linalg.norm(cloud - at, axis=1).max() for cloud, at in zip(clouds, middle, strict=True)] + rounding
    last = np.cumsum([len(cloud) for cloud in clouds])
    spans = np.column_stack([last - [len(cloud) for cloud in clouds], last])
    return np.vstack(clouds), spans, np.column_stack([middle, half, radius, rounding])
