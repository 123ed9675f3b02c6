"""Collision queries for arms, body and table.

The robot is represented by convex parts that contain its meshes (`part_shapes`). A query is a list of pairs of parts
(see `bodies`).

Fingertips may come closer to the table's top than other parts (`TIP_CLEAR_M`), since the cloth they grip lies there.
Cloth is no obstacle here; `over_cloth` checks how free arms keep clear of it.
"""

import math
from bisect import bisect_left
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import chain, combinations, product

import coal
import numpy as np

from planner.geometry.pose import BoolArray, FloatArray, Pose2
from planner.geometry.table import Table, table_parts
from planner.robots.card import OPENING_M
from planner.robots.collision.bodies import Bodies, Pairs, rows
from planner.robots.collision.part_poses import PLACE, set_middles
from planner.robots.collision.robot_parts import RobotParts, compiled_parts
from planner.robots.collision.separation import postures_apart


class Clearance:
    """A check for arm parts that are too low over cloth on the table. Threads may share it.

    Cloth is soft, but a hand that passes low over it sweeps it along. The cloth is therefore modelled as slabs of a
    given height, and compared with the parts of an arm that may come low.
    """

    def __init__(
        self,
        robot: RobotParts,
        level: int,
        pieces: Sequence[FloatArray],
        over_m: float,
        height_m: float,
        torso_m: float,
    ) -> None:
        """Take the slabs over the cloth, and the robot's arms to compare with them.

        Args:
            robot: the robot's parts.
            level: the index in the robot's openings of the fingers' opening.
            pieces: convex pieces of cloth, table frame, counter-clockwise, each of shape (n, 2), m.
            over_m: the height over the cloth that arms must keep (m).
            height_m: the table top's height over the floor (m).
            torso_m: how far the lift is raised (m).
        """
        slabs = [np.vstack([np.insert(piece, 2, z, axis=1) for z in (0.0, over_m)]) for piece in pieces]
        parts = compiled_parts(robot, level, slabs)
        slab_numbers = range(len(robot.names), len(robot.names) + len(slabs))
        poses, places = np.zeros((slab_numbers.stop, 5, 3)), np.tile([0.0, 0.0, height_m], (len(slabs), 1))
        self._bodies = Bodies(robot.kinematics, torso_m, parts, (), robot.is_mirrored, poses, places)
        low = [range(first, robot.of_arm(arm).stop) for arm, first in enumerate(robot.low_parts)]
        self._of_arm = tuple(_pairs(parts_of_arm, slab_numbers) for parts_of_arm in low)

    def arm_clear(self, arm: int, bases: Pose2 | FloatArray, joints: FloatArray) -> BoolArray:
        """Return at which joints of one arm, shape (n, joints), it is clear of all cloth, shape (n,).

        Args:
            arm: the arm's index.
            bases: the base pose in the table frame: one for all postures, or x (m), y (m), yaw (rad) of each.
            joints: the arm's joints (rad, m).
        """
        return self._bodies.are_free(self._of_arm[arm], bases, joints, np.array([arm]))


def _pairs(parts: range, slabs: range) -> Pairs:
    """Return the pairs of some parts of an arm with all slabs, the likeliest to be low first."""
    numbers = np.array([*product(reversed(parts), slabs)], dtype=np.int64).reshape(-1, 2)
    return Pairs(numbers, np.zeros(len(numbers)))


@dataclass(frozen=True, slots=True)
class Contact:
    """A contact of two parts, of the robot or of the robot and the table.

    Attributes:
        first: the first part's name for people, always of the robot: ``left forearm``.
        second: the second part's name for people: ``right palm``, ``torso``, ``table top``.
        depth_m: how far either part must move until the margin required is kept (m).
    """

    first: str
    second: str
    depth_m: float


_ORIGIN = Pose2(0.0, 0.0, 0.0)

TIP_CLEAR_M = 0.0001
"""The distance that fingertips keep from the table's top where other parts keep more (m).

Tools are 2 cm above the table while they hold cloth that lies: a PR2's fingertips then have .12 mm left.
"""


class Collisions:
    """Collision checks at one table, with the lift at one height. Threads may share it.

    Bases are poses of the robot's base in the table frame: one for all postures, or for each its x (m), y (m) and yaw
    (rad), shape (n, 3). Joints are in rad, or m where they slide; those of all arms are one row, one arm after the
    other.
    """

    def __init__(
        self, robot: RobotParts, table: Table, torso_m: float, opening_m: float = OPENING_M, margin_m: float = 0.0
    ) -> None:
        """Put the table's parts beside the robot's (1 ms).

        Args:
            robot: the robot's parts.
            table: the table.
            torso_m: how far the lift is raised (m).
            opening_m: the largest opening of the fingers, which may be anywhere from closed to it (m); rounded up to
                the next for which there are shapes.
            margin_m: the distance below which parts count as colliding (m).
        """
        of_table = table_parts(table)
        level = min(bisect_left(robot.openings_m, opening_m), len(robot.openings_m) - 1)
        self._robot, self._level, self._margin_m, self._height_m = robot, level, float(margin_m), table.height_m
        self._names = (*robot.names, *(part.name for part in of_table))
        corner_signs = np.array([*product((-0.5, 0.5), repeat=3)])
        parts = compiled_parts(robot, level, [corner_signs * part.size for part in of_table])
        shapes = (*robot.convexes[level], *(coal.Box(*part.size) for part in of_table))
        places = np.array([part.center for part in of_table])
        places[:, 2] += table.height_m
        poses = np.zeros((len(self._names), 5, 3))
        body = poses[robot.body.start : robot.body.stop]
        body[:, : PLACE + 1] = robot.body_poses
        body[robot.is_lifted, PLACE, 2] += float(torso_m)
        set_middles(parts.bounds[robot.body.start : robot.body.stop], body)
        self._bodies = Bodies(robot.kinematics, float(torso_m), parts, shapes, robot.is_mirrored, poses, places)
        self._every_arm = tuple(range(len(robot.arms)))
        tables = range(robot.body.stop, len(self._names))
        self._top = tables[0]
        self._of_body = self._pairs(() if robot.is_fixed else product(robot.body, tables))
        self._of_arm = tuple(self._of_one(arm, tables) for arm in self._every_arm)
        self._of_two = {pair: self._of_both(*pair) for pair in combinations(self._every_arm, 2)}
        self._all = _together((self._of_body, *self._of_arm, *self._of_two.values()))

    def _of_one(self, arm: int, tables: range) -> Pairs:
        """Return pairs of an arm's parts with table, body and the arm itself, the likeliest to collide first."""
        with_table = ((part, table) for table, part in product(tables, reversed(self._robot.of_arm(arm))))
        return self._pairs(chain(with_table, ((a, b) for a, b in self._robot.own_pairs[arm].tolist())))

    def _of_both(self, first: int, second: int) -> Pairs:
        """Return pairs of the parts of two arms, the outermost first."""
        pairs = product(reversed(self._robot.of_arm(first)), reversed(self._robot.of_arm(second)))
        return self._pairs(pair for pair in pairs if pair not in self._robot.skipped)

    def _pairs(self, numbers: Iterable[tuple[int, int]]) -> Pairs:
        """Return pairs of parts with the distance that each must keep."""
        found = np.array([*numbers], dtype=np.int64).reshape(-1, 2)
        is_tip = np.append(self._robot.is_tip, np.zeros(len(self._names) - len(self._robot.names), dtype=np.bool_))
        is_tip_at_top = (found[:, 1] == self._top) & is_tip[found[:, 0]]
        return Pairs(found, np.where(is_tip_at_top, min(self._margin_m, TIP_CLEAR_M), self._margin_m))

    def over_cloth(self, pieces: Sequence[FloatArray], over_m: float) -> Clearance:
        """Return the check that arms keep a height (m) over convex pieces of cloth (see `Clearance`)."""
        return Clearance(self._robot, self._level, pieces, over_m, self._height_m, self._bodies.torso_m)

    def free(self, bases: Pose2 | FloatArray, joints: FloatArray) -> BoolArray:
        """Return in which postures of all arms nothing collides, shape (n,)."""
        return self._bodies.are_free(self._all, bases, _rows(joints), np.array(self._every_arm))

    def free_until(self, bases: Pose2 | FloatArray, joints: FloatArray) -> int:
        """Return the number of postures of all arms before the first one in which something collides."""
        return self._bodies.free_until(self._all, bases, _rows(joints), np.array(self._every_arm))

    def is_path_free(self, bases: Pose2 | FloatArray, joints: FloatArray) -> bool:
        """Return whether nothing collides along a path of all arms, from posture to posture."""
        return self._bodies.is_path_free(self._all, bases, _rows(joints), np.array(self._every_arm))

    def arm_free(self, arm: int, bases: Pose2 | FloatArray, joints: FloatArray) -> BoolArray:
        """Return in which postures, shape (n, joints), an arm is clear of body, table and itself, shape (n,)."""
        if arm == 1 and self._robot.mirror is not None:
            # Mirrored to the left arm, so that answers agree on both sides to the last digit.
            return self.arm_free(0, rows(bases) * np.array([1.0, -1.0, -1.0]), joints * self._robot.mirror)
        return self._bodies.are_free(self._of_arm[arm], bases, joints, np.array([arm]))

    def is_arm_path_free(self, arm: int, bases: Pose2 | FloatArray, joints: FloatArray) -> bool:
        """Return whether an arm is clear of body, table and itself along a path, from posture to posture."""
        if arm == 1 and self._robot.mirror is not None:
            return self.is_arm_path_free(0, rows(bases) * np.array([1.0, -1.0, -1.0]), joints * self._robot.mirror)
        return self._bodies.is_path_free(self._of_arm[arm], bases, joints, np.array([arm]))

    def arms_apart(self, arms: tuple[int, ...], joints: FloatArray) -> BoolArray:
        """Return in which postures of some arms these are clear of each other, shape (n,); see `arm_free`.

        An arm alone is.
        """
        if len(arms) < 2:
            return np.ones(len(joints), dtype=np.bool_)
        pairs = self._of_two[arms] if len(arms) == 2 else _together(self._of_two[two] for two in combinations(arms, 2))
        return self._bodies.are_free(pairs, _ORIGIN, _rows(joints), np.array(arms))

    def postures_apart(self, arms: tuple[int, int], first: FloatArray, second: FloatArray) -> BoolArray:
        """Return which postures of one arm are apart from which of another, shape (k, l).

        Args:
            arms: the two arms, in rising order.
            first: joints of the first arm, shape (k, joints), with the tool in the same pose in all of them.
            second: joints of the second arm, shape (l, joints), with the tool in the same pose in all of them.
        """
        return self._postures_apart(arms, (first, second), is_one_enough=False)

    def are_some_apart(self, arms: tuple[int, int], first: FloatArray, second: FloatArray) -> bool:
        """Return whether some postures of two arms are apart; see `postures_apart`."""
        return bool(self._postures_apart(arms, (first, second), is_one_enough=True).any())

    def body_free(self, base_in_table: Pose2) -> bool:
        """Return whether the base, torso and head, without the arms, stay clear of the table.

        A base that is fixed at the table does.
        """
        nothing = np.empty((1, 0)), np.empty(0, dtype=np.int64)
        return bool(self._bodies.are_free(self._of_body, base_in_table, *nothing)[0])

    def deepest_contact(self, base_in_table: Pose2, joints: FloatArray) -> Contact | None:
        """Return the deepest contact in one posture of all arms; None if nothing collides."""
        base, start, arms = rows(base_in_table), np.zeros(1, dtype=np.int64), np.array(self._every_arm)
        found: list[Contact] = []
        while True:
            (pair,), (poses,), _ = self._bodies.first_close(self._all, base, joints.reshape(1, -1), arms, start)
            if pair < 0:
                return max(found, key=lambda contact: contact.depth_m, default=None)
            if (depth_m := self._bodies.depth_m(self._all, int(pair), poses)) >= 0.0:
                a, b = self._all.numbers[pair].tolist()
                found.append(Contact(self._names[a], self._names[b], depth_m))
            start[0] = pair + 1

    def _postures_apart(
        self, arms: tuple[int, int], postures: tuple[FloatArray, FloatArray], *, is_one_enough: bool
    ) -> BoolArray:
        bodies, pairs = self._bodies, self._of_two[arms].numbers
        return postures_apart(
            bodies.kinematics, bodies.torso_m, bodies.parts, arms, postures, pairs, self._margin_m, is_one_enough
        )


def _rows(joints: FloatArray) -> FloatArray:
    """Return postures of several arms as one row each, shape (n, joints)."""
    return joints.reshape(len(joints), math.prod(joints.shape[1:]))


def _together(pairs: Iterable[Pairs]) -> Pairs:
    found = tuple(pairs)
    return Pairs(np.vstack([one.numbers for one in found]), np.concatenate([one.margins for one in found]))
