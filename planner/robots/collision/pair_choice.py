"""Choose which pairs of a robot's parts are compared, as generators of SRDF files do: by a sample of postures.

Parts beside each other overlap as hulls where their meshes never touch. Left out are therefore

- parts of which one carries the other over one joint,
- pairs that touch in nearly all postures of the sample,
- parts with up to `NEAR` joints between them whose hulls touch with the arms at home, where a card says that all is
  well, or whose hulls touch now and then, but whose meshes never do; of the body only those parts count as near that
  touch an arm's innermost ones.

Parts of two arms are all compared, but for the innermost ones that touch in nearly all postures.
"""

from collections.abc import Iterator, Sequence
from itertools import combinations, product
from typing import NamedTuple

import coal
import numpy as np
import pinocchio as pin

from planner.geometry.pose import FloatArray, Pose2
from planner.robots.chain import Chain
from planner.robots.collision.bodies import Bodies, Pairs, rows
from planner.robots.collision.part_poses import PLACE, Index, set_middles
from planner.robots.collision.robot_parts import RobotParts, compiled_parts
from planner.robots.described_robot import DescribedArm

NEAR = 3
"""Number of joints between two parts up to which their meshes are compared."""

SAMPLES, MESH_SAMPLES = 600, 100
"""Postures in which hulls are compared, and at most so many of these in which their meshes are."""

ALWAYS = 0.95
"""Share of the postures from which on a pair counts as always touching."""

_ORIGIN = Pose2(0.0, 0.0, 0.0)

Solids = Sequence[tuple[coal.CollisionGeometry, pin.SE3]]
"""The shapes of a part as they are, in its frame."""


class Choice(NamedTuple):
    """The pairs of parts of a robot that are compared.

    Attributes:
        own: for each arm the pairs of its parts with the body and with each other, shape (q, 2).
        skipped: the pairs of parts of two arms that are not compared, shape (r, 2).
    """

    own: tuple[Index, ...]
    skipped: Index


def choose(robot: RobotParts, arms: Sequence[DescribedArm], carriers: Index, solids: Sequence[Solids]) -> Choice:
    """Return the pairs that are compared; the same each time.

    Args:
        robot: the robot's parts.
        arms: its arms.
        carriers: for each part of an arm which of the arm's joints carries it.
        solids: the shapes of all parts.
    """
    sample = _Sample(robot, arms, solids)
    innermost = [[part for part in robot.of_arm(arm) if carriers[part] == 0] for arm in range(len(arms))]
    own = tuple(
        [pair for *pair, between in _candidates(robot, sample, arm, carriers) if sample.asks((arm,), pair, between)]
        for arm in range(len(arms))
    )
    skipped = [
        pair
        for first, second in combinations(range(len(arms)), 2)
        for pair in product(innermost[first], innermost[second])
        if not sample.asks((first, second), pair, NEAR + 1)
    ]
    return Choice(tuple(map(_pairs, own)), _pairs(skipped))


def _pairs(found: Sequence[Sequence[int]]) -> Index:
    return np.array(found, dtype=np.int64).reshape(-1, 2)


def _candidates(robot: RobotParts, sample: "_Sample", arm: int, carriers: Index) -> Iterator[tuple[int, int, int]]:
    """Yield pairs of an arm's part with the body and with each other, and how many joints are between them."""
    parts = robot.of_arm(arm)
    for body in robot.body:
        is_near = any(sample.touching((arm,), (part, body)) for part in parts if carriers[part] == 0)
        yield from ((part, body, int(carriers[part]) + 1 if is_near else NEAR + 1) for part in parts)
    for inner, outer in combinations(parts, 2):
        between = int(carriers[outer] - carriers[inner])
        if between > 1:
            yield outer, inner, between


class _Sample:
    """Arms at home, then random postures, and what touches in them."""

    def __init__(self, robot: RobotParts, arms: Sequence[DescribedArm], solids: Sequence[Solids]) -> None:
        rng = np.random.default_rng(0)
        self._postures = [np.vstack([arm.card.home, _anywhere(arm.chain, rng)]) for arm in arms]
        self._solids = solids
        parts, poses = compiled_parts(robot, 0), np.zeros((len(robot.names), 5, 3))
        poses[robot.body.start :, : PLACE + 1] = robot.body_poses
        set_middles(parts.bounds[robot.body.start :], poses[robot.body.start :])
        shapes = robot.convexes[0]
        self._bodies = Bodies(robot.kinematics, 0.0, parts, shapes, robot.is_mirrored, poses, np.empty((0, 3)))

    def touching(self, arms: tuple[int, ...], pair: Sequence[int]) -> list[int]:
        """Return the postures in which the hulls of a pair touch."""
        are_free = self._bodies.are_free(Pairs(_pairs([pair]), np.zeros(1)), _ORIGIN, *self._of(arms))
        return np.flatnonzero(~are_free).tolist()

    def asks(self, arms: tuple[int, ...], pair: Sequence[int], between: int) -> bool:
        """Return whether a pair with so many joints between its parts is to be compared."""
        touching = self.touching(arms, pair)
        is_home = bool(touching) and touching[0] == 0
        if len(touching) >= ALWAYS * SAMPLES or (between <= NEAR and is_home):
            return False
        if between > NEAR or not touching:
            return True
        joints, numbers = self._of(arms)
        some = joints[touching[:MESH_SAMPLES]]
        pairs, start = Pairs(_pairs([pair]), np.zeros(1)), np.zeros(len(some), dtype=np.int64)
        _, poses, _ = self._bodies.first_close(pairs, rows(_ORIGIN), some, numbers, start)
        return any(self._solids_touch(pair, both) for both in poses)

    def _of(self, arms: tuple[int, ...]) -> tuple[FloatArray, Index]:
        return np.hstack([self._postures[arm] for arm in arms]), np.array(arms)

    def _solids_touch(self, pair: Sequence[int], poses: FloatArray) -> bool:
        """Return whether the shapes of two parts touch, at poses of shape (2, 5, 3)."""
        first, second = (
            [(shape, _transform(pose, placement)) for shape, placement in self._solids[part]]
            for part, pose in zip(pair, poses, strict=True)
        )
        return any(
            coal.collide(a, at_a, b, at_b, coal.CollisionRequest(), coal.CollisionResult())
            for (a, at_a), (b, at_b) in product(first, second)
        )


def _anywhere(chain: Chain, rng: np.random.Generator) -> FloatArray:
    """Return random joints within an arm's limits (rad, m), shape (SAMPLES, n)."""
    low, high = np.where(chain.turns, -np.pi, chain.low), np.where(chain.turns, np.pi, chain.high)
    return rng.uniform(low, high, (SAMPLES, len(low)))


def _transform(pose: FloatArray, placement: pin.SE3) -> coal.Transform3s:
    place = pin.SE3(pose[:PLACE], pose[PLACE]) * placement
    return coal.Transform3s(place.rotation, place.translation)
