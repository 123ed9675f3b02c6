"""Collision queries for arms, body and table.

The robot is represented by convex parts that contain its meshes (`part_shapes`). A query is a list of pairs of parts
(see `bodies`).

Fingertips may come arbitrarily close to the table's top, where the cloth they grip lies, but not into it. Cloth is no
obstacle here; `over_cloth` checks how free arms keep clear of it.
"""

from bisect import bisect_left
from collections.abc import Iterable, Iterator, Sequence
from itertools import product

import coal
import numpy as np

from planner.geometry.pose import BoolArray, FloatArray, Pose2
from planner.geometry.table import Table
from planner.geometry.table_parts import table_parts
from planner.robots.arm import MIRROR
from planner.robots.collision.bodies import Bodies, Pairs, rows
from planner.robots.collision.clearance import Clearance
from planner.robots.collision.contact import Contact
from planner.robots.collision.part_poses import EACH, PLACE, set_middles
from planner.robots.collision.part_shapes import OPENINGS_M
from planner.robots.collision.parts import BODY_PARTS, FINGERTIPS, pairs_in_arm, pairs_with_body
from planner.robots.collision.posture_pairs import postures_apart
from planner.robots.collision.robot_parts import RobotParts, compiled_parts

OPENING_M = 0.06
"""Default upper limit of the fingers' opening (m)."""

_BODY = 2 * EACH
_TABLE = _BODY + len(BODY_PARTS)
_TOP = 0
_BOTH = np.array([0, 1])
_LEFT = np.array([0])
_NEITHER = np.empty(0, dtype=np.int64)
_ORIGIN = Pose2(0.0, 0.0, 0.0)


class Collisions:
    """Collision checks at one table, with the torso at one height. Threads may share it.

    Bases are poses of the robot's base in the table frame: one for all postures, or for each its x (m), y (m) and yaw
    (rad), shape (n, 3). Joints are in rad; those of both arms are one row, the left arm's first, shape (n, 14).
    """

    def __init__(
        self, robot: RobotParts, table: Table, torso_m: float, opening_m: float = OPENING_M, margin_m: float = 0.0
    ) -> None:
        """Put the table's parts beside the robot's (1 ms).

        Args:
            robot: the robot's parts.
            table: the table.
            torso_m: how far the torso is raised (m).
            opening_m: the largest opening of the fingers, which may be anywhere from closed to it (m); rounded up to
                the next of `OPENINGS_M`.
            margin_m: the distance below which parts count as colliding (m).
        """
        of_table = table_parts(table)
        level = min(bisect_left(OPENINGS_M, opening_m), len(OPENINGS_M) - 1)
        self._robot, self._level, self._margin_m, self._height_m = robot, level, float(margin_m), table.height_m
        self._names = (*robot.names, *(part.name for part in of_table))
        corner_signs = np.array([*product((-0.5, 0.5), repeat=3)])
        parts = compiled_parts(robot, level, [corner_signs * part.size for part in of_table])
        shapes = (*robot.convexes[level], *(coal.Box(*part.size) for part in of_table))
        places = np.array([part.center for part in of_table])
        places[:, 2] += table.height_m
        poses = np.zeros((len(self._names), 5, 3))
        poses[_BODY:_TABLE, : PLACE + 1] = robot.body_poses
        poses[_BODY + 1 : _TABLE, PLACE, 2] += float(torso_m)
        set_middles(parts.bounds[_BODY:_TABLE], poses[_BODY:_TABLE])
        self._bodies = Bodies(robot.arm, float(torso_m), parts, shapes, poses, places)
        tables = range(_TABLE, len(self._names))
        self._of_body = self._pairs(product(range(_BODY, _TABLE), tables))
        self._of_arm = tuple(self._pairs(_arm_pairs(arm, tables)) for arm in _BOTH)
        self._of_arms = self._pairs(product(reversed(range(EACH)), reversed(range(EACH, _BODY))))
        every = (self._of_body, *self._of_arm, self._of_arms)
        self._all = Pairs(np.vstack([p.numbers for p in every]), np.concatenate([p.margins for p in every]))

    def _pairs(self, numbers: Iterable[tuple[int, int]]) -> Pairs:
        """Return pairs of parts with the distance that each must keep."""
        found = np.array([*numbers])
        is_tip_at_top = (found[:, 1] == _TABLE + _TOP) & (found[:, 0] % EACH == FINGERTIPS) & (found[:, 0] < _BODY)
        return Pairs(found, np.where(is_tip_at_top, 0.0, self._margin_m))

    def over_cloth(self, pieces: Sequence[FloatArray], over_m: float) -> Clearance:
        """Return the check that arms keep a height (m) over convex pieces of cloth (see `Clearance`)."""
        return Clearance(self._robot, self._level, pieces, over_m, self._height_m, self._bodies.torso_m)

    def free(self, bases: Pose2 | FloatArray, joints: FloatArray) -> BoolArray:
        """Return in which postures of both arms nothing collides, shape (n,)."""
        return self._bodies.are_free(self._all, bases, _by_arm(joints), _BOTH)

    def are_all_free(self, bases: Pose2 | FloatArray, joints: FloatArray) -> bool:
        """Return whether nothing collides in any posture of both arms; faster than `free` where something does."""
        return next(self._bodies.touching(self._all, bases, _by_arm(joints), _BOTH), None) is None

    def arm_free(
        self, arm: int, bases: Pose2 | FloatArray, joints: FloatArray, *, is_certain: bool = False
    ) -> BoolArray:
        """Return in which postures, shape (n, 7), an arm is clear of body, table and itself, shape (n,).

        With `is_certain`, accept only postures proved free: this takes a third of the time and misses 0.5 % of the free
        ones.
        """
        # The right arm's query is mirrored to the left arm, so that certain answers agree on both sides.
        side = 1.0 if arm == 0 else -1.0
        stands = rows(bases) * np.array([1.0, side, side])
        named = joints if arm == 0 else joints * MIRROR
        return self._bodies.are_free(self._of_arm[0], stands, named[:, None], _LEFT, is_certain)

    def arms_apart(self, arms: tuple[int, ...], joints: FloatArray, *, is_certain: bool = False) -> BoolArray:
        """Return in which postures of some arms these are clear of each other, shape (n,); see `arm_free`.

        An arm alone is.
        """
        if len(arms) < len(_BOTH):
            return np.ones(len(joints), dtype=np.bool_)
        return self._bodies.are_free(self._of_arms, _ORIGIN, _by_arm(joints), _BOTH, is_certain)

    def postures_apart(self, _arms: tuple[int, int], left: FloatArray, right: FloatArray) -> BoolArray:
        """Return which postures of the left arm are certainly apart from which of the right, shape (k, l).

        Args:
            _arms: the left and the right arm; there are no others.
            left: joints of the left arm, shape (k, 7), with the tool in the same pose in all of them.
            right: joints of the right arm, shape (l, 7), with the tool in the same pose in all of them.
        """
        return self._postures_apart(left, right, is_one_enough=False)

    def are_some_apart(self, _arms: tuple[int, int], left: FloatArray, right: FloatArray) -> bool:
        """Return whether some postures of the left and right arm are certainly apart; see `postures_apart`."""
        return bool(self._postures_apart(left, right, is_one_enough=True).any())

    def body_free(self, base_in_table: Pose2) -> bool:
        """Return whether the base, torso and head, without the arms, stay clear of the table."""
        return bool(self._bodies.are_free(self._of_body, base_in_table, np.empty((1, 0, 7)), _NEITHER)[0])

    def deepest_contact(self, base_in_table: Pose2, joints: FloatArray) -> Contact | None:
        """Return the deepest contact in one posture of both arms; None if nothing collides."""
        base, start = rows(base_in_table), np.zeros(1, dtype=np.int64)
        found: list[Contact] = []
        while True:
            (pair,), (poses,) = self._bodies.first_close(self._all, base, _by_arm(joints), _BOTH, start)
            if pair < 0:
                return max(found, key=lambda contact: contact.depth_m, default=None)
            if (depth_m := self._bodies.depth_m(self._all, int(pair), poses)) >= 0.0:
                a, b = self._all.numbers[pair].tolist()
                found.append(Contact(self._names[a], self._names[b], depth_m))
            start[0] = pair + 1

    def _postures_apart(self, left: FloatArray, right: FloatArray, *, is_one_enough: bool) -> BoolArray:
        bodies, pairs = self._bodies, self._of_arms.numbers
        return postures_apart(
            bodies.arm, bodies.torso_m, bodies.parts, left, right, pairs, self._margin_m, is_one_enough
        )


def _by_arm(joints: FloatArray) -> FloatArray:
    """Return postures of both arms arm by arm, shape (n, 2, 7)."""
    return joints.reshape(-1, len(_BOTH), len(MIRROR))


def _arm_pairs(arm: int, tables: range) -> Iterator[tuple[int, int]]:
    """Yield pairs of an arm's parts with the table, the body and the arm itself, the likeliest to collide first."""
    low = EACH * arm
    yield from ((low + part, table) for table, part in product(tables, reversed(range(EACH))))
    yield from ((low + part, _BODY + body) for part, body in pairs_with_body())
    yield from ((low + outer, low + inner) for outer, inner in pairs_in_arm())
