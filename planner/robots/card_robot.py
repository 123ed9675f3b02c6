"""A robot as its card and its URDF describe it, ready for planning."""

import math
import threading
from collections.abc import Callable, Mapping
from functools import cached_property, lru_cache

import numpy as np

from planner.errors import RequestError, SceneError
from planner.geometry.pose import BoolArray, FloatArray
from planner.geometry.table import Table
from planner.robots.arm_paths import Together, arm_paths, arm_searches
from planner.robots.card import RobotCard
from planner.robots.collision.collisions import OPENING_M, Collisions
from planner.robots.collision.described_parts import described_parts
from planner.robots.comfort_memories import Memories
from planner.robots.comfort_reach import AskedArms
from planner.robots.described_card import robot_card
from planner.robots.described_robot import DescribedRobot
from planner.robots.mapped_arm import ALL_ROUND, MappedArm, all_arms
from planner.robots.mapped_comfort import ARM_LABELS, MappedArms, mapped_arms, rooted
from planner.robots.mapped_reach import MappedReach
from planner.robots.posture_maps import Progress
from planner.robots.tool_path import IsFree, NoPath, ToolPath, free_postures, near_path

_MEMORIES_KEPT = 4
"""Lift heights and comfort radii for which it is kept where the arms reach."""


class CardRobot:
    """A robot of a card. It does not change, so all users may share one instance.

    Arms are numbered from left to right as the robot sees them. Poses are of the tool frame, in the base frame (x
    ahead, z up from the floor), in m.
    """

    def __init__(self, described: DescribedRobot) -> None:
        """Take the description; maps of postures are read, or built in seconds, when they are first needed."""
        self._described = described
        self._card = robot_card(described)
        self._memories = lru_cache(_MEMORIES_KEPT)(lambda torso_m, comfort_m: Memories())
        self._mapping = threading.Lock()
        self._mapped: tuple[MappedArm, ...] | None = None

    @property
    def card(self) -> RobotCard:
        """The robot's card."""
        return self._card

    def reach(self, torso_m: float, comfort_m: float) -> MappedReach:
        """Return the reach with the lift raised by `torso_m`, for a comfort radius (m).

        Raises:
            SceneError: the lift does not go there.
            RequestError: the radius is negative or no number.
        """
        low, high = self._card.lift_limits_m
        if not low <= torso_m <= high:
            raise SceneError("torso_m", f"{torso_m} m is not between {low} and {high} m")
        if not (math.isfinite(comfort_m) and comfort_m >= 0.0):
            raise RequestError("comfort_m", f"{comfort_m} m is no radius")
        names = tuple(arm.name for arm in self._card.arms)
        ask = np.arange(1, len(ALL_ROUND) + 1)
        labels = tuple(ARM_LABELS * number + ask for number in range(len(names)))
        numbers = rooted(self._numbers, [arm.shoulder(float(torso_m)) for arm in self._arms])
        asked = AskedArms(names, self._arms, numbers, ALL_ROUND, labels)
        joints = tuple(arm.joint_names for arm in self._card.arms)
        lengths = tuple(arm.length_m for arm in self._arms)
        memories = self._memories(float(torso_m), float(comfort_m))
        return MappedReach(asked, numbers, joints, lengths, float(torso_m), float(comfort_m), memories)

    def forget_reach(self) -> None:
        """Drop what plans have left about where the arms reach and how, so that benchmarks measure its computation."""
        self._memories.cache_clear()
        for arm in self._arms:
            arm.forget_samples()

    def prepare(self, progress: Progress | None = None) -> tuple[MappedArm, ...]:
        """Return the arms with their maps of postures, which are read or built at the first call.

        Args:
            progress: is told how far the maps are that must be built (0 to 1).
        """
        with self._mapping:
            if self._mapped is None:
                self._mapped = all_arms(self._described, progress)
            return self._mapped

    @property
    def _arms(self) -> tuple[MappedArm, ...]:
        return self.prepare()

    @cached_property
    def _numbers(self) -> MappedArms:
        arms = self._arms
        return mapped_arms([arm.chain for arm in arms], [arm.known for arm in arms])

    def collisions(
        self, table: Table, torso_m: float, opening_m: float = OPENING_M, margin_m: float = 0.0
    ) -> Collisions:
        """Return the collision checks at a table, with the lift raised; see `Collisions`."""
        return Collisions(described_parts(self._described), table, torso_m, opening_m, margin_m)

    def arm_path_near(
        self, arm: int, path: ToolPath, torso_m: float, is_free: IsFree, known: FloatArray
    ) -> FloatArray | None:
        """Return joints that keep an arm's tool on a path, near to known ones, shape (n, joints) (see `near_path`)."""
        return near_path(self._arms[arm], path, float(torso_m), is_free, known)

    def arm_paths(
        self,
        paths: Mapping[int, ToolPath],
        torso_m: float,
        floor_m: float,
        are_free: Mapping[int, IsFree],
        together: Together,
    ) -> FloatArray | NoPath:
        """Return the calmest joints that keep arms' tools on their paths, or that there are none (see `arm_paths`)."""
        return arm_paths(arm_searches(self._arms, self._card, paths, torso_m, floor_m, are_free), together)

    def free_postures(
        self,
        arm: int,
        position: FloatArray,
        rotation: FloatArray,
        torso_m: float,
        is_free: Callable[[FloatArray], BoolArray],
    ) -> FloatArray:
        """Return samples of an arm's joints at a tool pose that do not collide (see `free_postures`)."""
        return free_postures(self._arms[arm], position, rotation, float(torso_m), is_free)

    def tool_places(self, arm: int, joints: FloatArray, torso_m: float) -> FloatArray:
        """Return the tool's positions in the base frame for rows of joints, shape (n, joints) -> (n, 3), m."""
        return self._arms[arm].tool_places(joints, float(torso_m))

    def tool_pose(self, arm: int, joints: FloatArray, torso_m: float) -> tuple[FloatArray, FloatArray]:
        """Return the tool's position (m), shape (3,), and rotation, shape (3, 3), in the base frame at some joints."""
        positions, rotations = self._arms[arm].tool_poses(joints[None], float(torso_m))
        return positions[0], rotations[0]
