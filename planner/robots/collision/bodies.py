"""Convex bodies, moving with the arms or standing still, and tests for contacts between them.

A compiled pass over all postures (`separation`) tells what touches, and coal how deep.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import coal
import numpy as np

from planner.geometry.pose import BoolArray, FloatArray, Pose2
from planner.robots.collision.arm_kinematics import ArmKinematics
from planner.robots.collision.part_poses import PLACE, Index
from planner.robots.collision.separation import ROUNDING, Parts, first_close

_MIRROR = np.array([1.0, -1.0, 1.0])


class Pairs(NamedTuple):
    """Pairs of bodies to compare.

    Attributes:
        numbers: the bodies' numbers, shape (q, 2).
        margins: the distance that each pair must keep (m), shape (q,).
    """

    numbers: Index
    margins: FloatArray


_HALVINGS = 3
"""How often lines on which parts may touch are halved."""

_LENIENT_M = 0.0003
"""How deep parts may overlap in postures between those given (m): they are estimates."""


@dataclass(frozen=True, slots=True, eq=False)
class Bodies:
    """The parts of all arms, arm after arm, then the rest of the robot, then the parts of the table.

    Attributes:
        kinematics: what poses the arms' parts.
        torso_m: how far the lift is raised (m).
        parts: all bodies.
        shapes: the same bodies as coal shapes, without their roundings.
        is_mirrored: which of the robot's parts have left-handed frames.
        poses: the poses of the robot's static parts, shape (p, 5, 3).
        places: the positions of the table's parts, which come last, in the table frame but measured from the floor (m),
            shape (t, 3).
    """

    kinematics: ArmKinematics
    torso_m: float
    parts: Parts
    shapes: Sequence[coal.CollisionGeometry]
    is_mirrored: BoolArray
    poses: FloatArray
    places: FloatArray

    def are_free(self, pairs: Pairs, bases: Pose2 | FloatArray, joints: FloatArray, arms: Index) -> BoolArray:
        """Return in which postures no pair touches, shape (n,).

        Args:
            pairs: the pairs to compare.
            bases: the base poses, see `rows`.
            joints: for each posture the joints of the arms considered, one arm after the other (rad, m), shape (n, q).
            arms: those arms, shape (k,).
        """
        close, *_ = self.first_close(pairs, rows(bases), joints, arms, np.zeros(len(joints), dtype=np.int64))
        return close < 0

    def free_until(self, pairs: Pairs, bases: Pose2 | FloatArray, joints: FloatArray, arms: Index) -> int:
        """Return the number of postures before the first one in which some pair touches; see `are_free`."""
        start = np.zeros(len(joints), dtype=np.int64)
        close, *_ = self.first_close(pairs, rows(bases), joints, arms, start, is_one_enough=True)
        return int(np.append(close >= 0, True).argmax())

    def is_path_free(self, pairs: Pairs, bases: Pose2 | FloatArray, joints: FloatArray, arms: Index) -> bool:
        """Return whether no pair touches along a path: in its postures, and on the lines from one to the next.

        Lines on which a pair may touch, by how far its parts move, are halved until it cannot, or they are very short.
        The postures between are estimates, so there pairs need keep no margin and may overlap by `_LENIENT_M`.
        """
        left, stands, ways = pairs, rows(bases), joints
        is_end = np.zeros(len(joints), dtype=np.bool_)  # of a line of its own
        for halvings in range(_HALVINGS + 1):
            start = np.zeros(len(ways), dtype=np.int64)
            close, _, may_touch = self.first_close(left, stands, ways, arms, start, is_one_enough=True, is_path=True)
            if (close >= 0).any():
                return False
            ends = np.flatnonzero(may_touch & ~is_end)
            if not len(ends) or halvings == _HALVINGS:
                break
            left = Pairs(pairs.numbers, np.full(len(pairs.numbers), -_LENIENT_M))
            ways, is_end = _halved(ways, ends), np.tile([True, False, False], len(ends))
            stands = _halved(stands, ends) if len(stands) > 1 else stands
        return True

    def first_close(
        self,
        pairs: Pairs,
        bases: FloatArray,
        joints: FloatArray,
        arms: Index,
        start: Index,
        *,
        is_one_enough: bool = False,
        is_path: bool = False,
    ) -> tuple[Index, FloatArray, BoolArray]:
        """Return for every posture the first pair from a start that is not apart; see `first_close`."""
        return first_close(
            self.kinematics,
            self.torso_m,
            self.parts,
            self.poses,
            pairs.numbers,
            np.ascontiguousarray(joints, dtype=np.float64),
            arms,
            bases,
            self.places,
            start,
            pairs.margins,
            is_one_enough,
            is_path,
        )

    def depth_m(self, pairs: Pairs, pair: int, poses: FloatArray) -> float:
        """Return how far one body of a pair must move until their margin is kept (m); negative if it is kept."""
        distance_m = coal.distance(*self._posed(pairs, pair, poses), coal.DistanceRequest(), coal.DistanceResult())
        return self._gap(pairs, pair) - float(distance_m)

    def _gap(self, pairs: Pairs, pair: int) -> float:
        """Return the distance that the hulls of a pair must keep (m): the margin and both roundings."""
        a, b = pairs.numbers[pair].tolist()
        bounds = self.parts.bounds
        return float(pairs.margins[pair] + bounds[a, ROUNDING] + bounds[b, ROUNDING])

    def _posed(
        self, pairs: Pairs, pair: int, poses: FloatArray
    ) -> tuple[coal.CollisionGeometry, coal.Transform3s, coal.CollisionGeometry, coal.Transform3s]:
        a, b = pairs.numbers[pair].tolist()
        return self.shapes[a], self._transform(a, poses[0]), self.shapes[b], self._transform(b, poses[1])

    def _transform(self, part: int, pose: FloatArray) -> coal.Transform3s:
        """Return a body's pose for coal, with left-handed frames made right-handed."""
        is_mirrored = part < len(self.is_mirrored) and self.is_mirrored[part]
        return coal.Transform3s(pose[:PLACE] * _MIRROR if is_mirrored else pose[:PLACE], pose[PLACE])


def _halved(path: FloatArray, ends: Index) -> FloatArray:
    """Return start, middle and end of some lines of a path, those that end at given rows, line after line."""
    first, last = path[ends - 1], path[ends]
    return np.stack([first, 0.5 * (first + last), last], axis=1).reshape(3 * len(ends), -1)


def rows(bases: Pose2 | FloatArray) -> FloatArray:
    """Return bases as rows of x (m), y (m) and yaw (rad), shape (n, 3), or (1, 3) for a single base."""
    if isinstance(bases, Pose2):
        return np.array([[bases.x_m, bases.y_m, bases.yaw_rad]])
    return np.require(bases, np.float64, ["C", "W"])  # kernels are compiled once more for arrays that are read-only
