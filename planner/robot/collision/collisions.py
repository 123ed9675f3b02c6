"""Does anything collide: arms, body, table?

The robot is taken apart into convex parts that contain its meshes (`part_shapes`). A question is a list of pairs of
parts. A compiled pass over all postures leaves, for most of them, no pair that could touch (`separation`); what it
leaves is answered exactly, by coal, pair by pair until one touches.

Fingertips may touch the table's top, on which the cloth lies that they grip; all else that `parts` names is compared
with all of the table. Cloth is no obstacle.
"""

from bisect import bisect_left
from collections.abc import Iterator
from itertools import product

import coal
import numpy as np

from planner.geometry.pose import BoolArray, FloatArray, Pose2
from planner.geometry.table import Table
from planner.geometry.table_parts import table_parts
from planner.robot.collision.contact import Contact
from planner.robot.collision.part_poses import EACH, PLACE, Index, set_middles
from planner.robot.collision.part_shapes import OPENINGS_M
from planner.robot.collision.parts import BODY_PARTS, FINGERTIPS, pairs_in_arm, pairs_with_body
from planner.robot.collision.posture_pairs import postures_apart
from planner.robot.collision.robot_parts import RobotParts, compiled_parts
from planner.robot.collision.separation import ROUNDING, first_close

OPENING_M = 0.06
"""How far open fingers are taken to be, unless told (m)."""

_BODY = 2 * EACH
_TABLE = _BODY + len(BODY_PARTS)
_TOP = 0
_BOTH = np.array([0, 1])
_NEITHER = np.empty(0, dtype=np.int64)
_ORIGIN = Pose2(0.0, 0.0, 0.0)
_MIRROR = np.array([1.0, -1.0, 1.0])


class Collisions:
    """What collides at one table, with the torso at one height. May be shared between threads.

    Bases are poses of the robot's base in the table frame: one for all postures, or for each its x (m), y (m) and yaw
    (rad), shape (n, 3). Joints are in rad, arms from left to right.
    """

    def __init__(
        self, robot: RobotParts, table: Table, torso_m: float, opening_m: float = OPENING_M, margin_m: float = 0.0
    ) -> None:
        """Put the table's parts beside the robot's (1 ms).

        Args:
            robot: its parts.
            table: the table.
            torso_m: how far the torso is raised (m).
            opening_m: the fingers are anywhere from closed to this far apart (m); taken as the next larger of
                `OPENINGS_M`.
            margin_m: what comes nearer to each other than this collides (m).
        """
        of_table = table_parts(table)
        level = min(bisect_left(OPENINGS_M, opening_m), len(OPENINGS_M) - 1)
        self._arm, self._torso_m, self._margin_m = robot.arm, float(torso_m), float(margin_m)
        self._names = (*robot.names, *(part.name for part in of_table))
        self._shapes = (*robot.convexes[level], *(coal.Box(*part.size) for part in of_table))
        self._parts = compiled_parts(robot, level, np.array([part.size for part in of_table]))
        self._tables = np.array([part.center for part in of_table])
        self._tables[:, 2] += table.height_m
        self._poses = np.zeros((len(self._names), 5, 3))
        self._poses[_BODY:_TABLE, : PLACE + 1] = robot.body_poses
        self._poses[_BODY + 1 : _TABLE, PLACE, 2] += self._torso_m
        set_middles(self._parts.bounds[_BODY:_TABLE], self._poses[_BODY:_TABLE])
        tables = range(_TABLE, len(self._names))
        self._of_body = np.array([*product(range(_BODY, _TABLE), tables)])
        self._of_arm = tuple(np.array([*_arm_pairs(arm, tables)]) for arm in _BOTH)
        self._of_arms = np.array([*product(reversed(range(EACH)), reversed(range(EACH, _BODY)))])
        self._all = np.vstack([self._of_body, *self._of_arm, self._of_arms])

    def free(self, bases: Pose2 | FloatArray, joints: FloatArray) -> BoolArray:
        """In which postures, shape (n, 2, 7), nothing collides, shape (n,)."""
        return self._are_free(self._all, bases, joints, _BOTH)

    def are_all_free(self, bases: Pose2 | FloatArray, joints: FloatArray) -> bool:
        """Whether nothing collides in any of some postures, shape (n, 2, 7); sooner told than `free` where not so."""
        return next(self._colliding(self._all, bases, joints, _BOTH), None) is None

    def arm_free(
        self, arm: int, bases: Pose2 | FloatArray, joints: FloatArray, *, is_certain: bool = False
    ) -> BoolArray:
        """In which postures, shape (n, 7), an arm collides with neither body, table nor itself, shape (n,).

        Only certainly free ones count if that is asked for: a third of the time, and 0.5 % of the free ones missed.
        """
        return self._are_free(self._of_arm[arm], bases, joints[:, None], np.array([arm]), is_certain)

    def arms_apart(self, joints: FloatArray, *, is_certain: bool = False) -> BoolArray:
        """In which postures, shape (n, 2, 7), the arms do not collide with each other, shape (n,); see `arm_free`."""
        return self._are_free(self._of_arms, _ORIGIN, joints, _BOTH, is_certain)

    def postures_apart(self, left: FloatArray, right: FloatArray) -> BoolArray:
        """Which postures of the left arm are certainly apart from which of the right, shape (k, l).

        Args:
            left: joints of the left arm, shape (k, 7), the tool in the same pose in all of them.
            right: joints of the right arm, shape (l, 7), likewise.
        """
        return self._postures_apart(left, right, is_one_enough=False)

    def are_some_apart(self, left: FloatArray, right: FloatArray) -> bool:
        """Whether some posture of the left arm is certainly apart from some of the right; see `postures_apart`."""
        return bool(self._postures_apart(left, right, is_one_enough=True).any())

    def body_free(self, base_in_table: Pose2) -> bool:
        """Whether the base, torso and head, without the arms, stay clear of the table."""
        return bool(self._are_free(self._of_body, base_in_table, np.empty((1, 0, 7)), _NEITHER)[0])

    def deepest_contact(self, base_in_table: Pose2, joints: FloatArray) -> Contact | None:
        """Of all that collides in one posture, shape (2, 7), what does so deepest; None if nothing does."""
        base, start = _rows(base_in_table), np.zeros(1, dtype=np.int64)
        found: list[Contact] = []
        while True:
            (pair,), (places,) = self._first_close(self._all, base, joints[None], _BOTH, start)
            if pair < 0:
                return max(found, key=lambda contact: contact.depth_m, default=None)
            a, b = self._all[pair].tolist()
            if (depth_m := self._depth(a, b, places)) >= 0.0:
                found.append(Contact(self._names[a], self._names[b], depth_m))
            start[0] = pair + 1

    def _postures_apart(self, left: FloatArray, right: FloatArray, *, is_one_enough: bool) -> BoolArray:
        arm, pairs = self._arm, self._of_arms
        return postures_apart(arm, self._torso_m, self._parts, left, right, pairs, self._margin_m, is_one_enough)

    def _are_free(
        self, pairs: Index, bases: Pose2 | FloatArray, joints: FloatArray, arms: Index, is_certain: bool = False
    ) -> BoolArray:
        """In which postures no pair touches."""
        if is_certain:
            close, _ = self._first_close(pairs, _rows(bases), joints, arms, np.zeros(len(joints), dtype=np.int64))
            return close < 0
        is_free = np.ones(len(joints), dtype=np.bool_)
        is_free[[*self._colliding(pairs, bases, joints, arms)]] = False
        return is_free

    def _colliding(self, pairs: Index, bases: Pose2 | FloatArray, joints: FloatArray, arms: Index) -> Iterator[int]:
        """The postures in which some pair touches: rounds of the compiled pass, each going on where coal found none."""
        stands = _rows(bases)
        asked, start = np.arange(len(joints)), np.zeros(len(joints), dtype=np.int64)
        while len(asked):
            at = stands if len(stands) == 1 else stands[asked]
            close, places = self._first_close(pairs, at, joints[asked], arms, start)
            is_open = close >= 0
            for k in np.flatnonzero(is_open):
                a, b = pairs[close[k]].tolist()
                if self._touch(a, b, places[k]):
                    is_open[k] = False
                    yield int(asked[k])
            asked, start = asked[is_open], close[is_open] + 1

    def _first_close(
        self, pairs: Index, bases: FloatArray, joints: FloatArray, arms: Index, start: Index
    ) -> tuple[Index, FloatArray]:
        poses = self._poses.copy()
        return first_close(
            self._arm,
            self._torso_m,
            self._parts,
            poses,
            pairs,
            np.ascontiguousarray(joints, dtype=np.float64),
            arms,
            bases,
            self._tables,
            start,
            self._margin_m,
        )

    def _touch(self, a: int, b: int, poses: FloatArray) -> bool:
        """Whether two parts come nearer to each other than the margin, at poses of shape (2, 5, 3)."""
        request = coal.CollisionRequest()
        request.security_margin = self._gap(a, b)
        return bool(coal.collide(*self._posed(a, b, poses), request, coal.CollisionResult()))

    def _depth(self, a: int, b: int, poses: FloatArray) -> float:
        """How far one of two parts must move until they are apart by the margin (m); negative if they are."""
        distance_m = coal.distance(*self._posed(a, b, poses), coal.DistanceRequest(), coal.DistanceResult())
        return self._gap(a, b) - float(distance_m)

    def _gap(self, a: int, b: int) -> float:
        """How far apart the hulls of two parts must be (m)."""
        rounding = self._parts.bounds[:, ROUNDING]
        return float(self._margin_m + rounding[a] + rounding[b])

    def _posed(
        self, a: int, b: int, poses: FloatArray
    ) -> tuple[coal.CollisionGeometry, coal.Transform3s, coal.CollisionGeometry, coal.Transform3s]:
        return self._shapes[a], _transform(a, poses[0]), self._shapes[b], _transform(b, poses[1])


def _rows(bases: Pose2 | FloatArray) -> FloatArray:
    """Bases as x (m), y (m) and yaw (rad), shape (n, 3) or (1, 3)."""
    if isinstance(bases, Pose2):
        return np.array([[bases.x_m, bases.y_m, bases.yaw_rad]])
    return np.ascontiguousarray(bases, dtype=np.float64)


def _arm_pairs(arm: int, tables: range) -> Iterator[tuple[int, int]]:
    """Pairs of an arm's parts with the table, the body, and the arm itself, the likeliest to collide first."""
    low = EACH * arm
    for table, part in product(tables, reversed(range(EACH))):
        if part != FINGERTIPS or table != tables[_TOP]:
            yield low + part, table
    yield from ((low + part, _BODY + body) for part, body in pairs_with_body())
    yield from ((low + outer, low + inner) for outer, inner in pairs_in_arm())


def _transform(part: int, pose: FloatArray) -> coal.Transform3s:
    """A part's pose for coal: the frames of the right arm are made right-handed."""
    rotation = pose[:PLACE] * _MIRROR if EACH <= part < _BODY else pose[:PLACE]
    return coal.Transform3s(rotation, pose[PLACE])
