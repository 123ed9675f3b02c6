"""The part of a robot that does not depend on how its arms' kinematics are solved: card, joint paths, memories."""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Protocol

import numpy as np

from planner.errors import RequestError, SceneError
from planner.geometry.pose import BoolArray, FloatArray
from planner.geometry.table import Table
from planner.robots.arm_paths import Together, arm_paths, arm_searches
from planner.robots.card import OPENING_M, RobotCard
from planner.robots.collision.collisions import Collisions
from planner.robots.collision.robot_parts import RobotParts
from planner.robots.comfort_reach import ComfortReach, Memories
from planner.robots.edge_grip import HandShape, edge_raised_m
from planner.robots.tool_path import IsFree, NoPath, PathArm, ToolPath, free_postures, near_path

_MEMORIES_KEPT = 4
"""Lift heights and comfort radii whose memories of reach are kept."""


class PosableArm(PathArm, Protocol):
    """An arm with its forward kinematics."""

    def tool_pose(self, joints: FloatArray, torso_m: float) -> tuple[FloatArray, FloatArray]:
        """Return the tool's position (m), shape (3,), and rotation, shape (3, 3), in the base frame at some joints."""
        ...


class ArmedRobot(ABC):
    """A robot with arms: its card, its reach, what its arms touch, and the joints that bring a tool to a pose.

    It does not change, so all users may share one instance. Arms are numbered from left to right as the robot sees
    them. Poses are of the tool frame, in the base frame (x ahead, z up from the floor), in m.

    Attributes:
        card: the robot's card.
    """

    can_mind_arms = False
    """Whether `reach` differs where the other arm is minded."""

    def __init__(self, card: RobotCard) -> None:
        self.card = card
        self._edges: dict[tuple[int, float, float], float | None] = {}
        self._memories = lru_cache(_MEMORIES_KEPT)(lambda torso_m, comfort_m, minds_arms: Memories())

    @property
    @abstractmethod
    def _arms(self) -> tuple[PosableArm, ...]: ...

    @abstractmethod
    def _hand_shape(self, arm: int) -> HandShape:
        """Return an arm's hand as its tool sees it."""

    def reach(
        self,
        torso_m: float,
        comfort_m: float,
        *,
        is_passing: bool = False,
        minds_body: bool = True,
        minds_arms: bool = False,
    ) -> ComfortReach:
        """Return the reach with the lift at a height, for a comfort radius (m).

        Args:
            torso_m: how far the lift is raised (m).
            comfort_m: the comfort radius (m).
            is_passing: whether it is for a few queries only: it takes no memory from earlier plans and leaves none.
            minds_body: whether a place is out of reach where the robot's body may be in the arm's way. What that leaves
                is known in cells of 2 cm; a path that keeps clear of the body knows better.
            minds_arms: whether it is out of reach, too, where the other arm at home may be in the way. That arm may be
                elsewhere, so this is for restricted tasks.

        Raises:
            SceneError: the lift does not go there.
            RequestError: the radius is negative or no number.
        """
        minds_arms = minds_arms and self.can_mind_arms
        memories = None if is_passing else self._memories_of(torso_m, comfort_m, minds_arms=minds_arms)
        return self._reach(float(torso_m), float(comfort_m), memories, minds_body=minds_body, minds_arms=minds_arms)

    @abstractmethod
    def _reach(
        self, torso_m: float, comfort_m: float, memories: Memories | None, *, minds_body: bool, minds_arms: bool
    ) -> ComfortReach:
        """Return the reach; it takes a memory from some memories, and leaves it there."""

    @property
    @abstractmethod
    def _parts(self) -> RobotParts:
        """The parts that may collide."""

    def collisions(
        self, table: Table, torso_m: float, opening_m: float = OPENING_M, margin_m: float = 0.0
    ) -> Collisions:
        """Return the collision checks at a table, with the lift raised (1 ms); see `Collisions`."""
        return Collisions(self._parts, table, torso_m, opening_m, margin_m)

    @property
    def mirror(self) -> Callable[[FloatArray], FloatArray] | None:
        """The mirror image of configurations, shape (n, joints); None where the arms are not each other's."""
        return None

    def home(self, arm: int) -> FloatArray:
        """Return the joints of an arm that is out of the way (rad), shape (joints,)."""
        return np.array(self.card.arms[arm].home)

    def edge_raised_m(self, arm: int, height_m: float, pitch_rad: float) -> float | None:
        """Return how far above its path an arm's hand opens and closes to hold cloth at its edge (m).

        One finger is then under the cloth and one over it; see `edge_raised_m`.
        """
        key = (arm, height_m, pitch_rad)
        if key not in self._edges:
            self._edges[key] = edge_raised_m(self._hand_shape(arm), height_m, pitch_rad)
        return self._edges[key]

    def forget_reach(self) -> None:
        """Drop the memories of where the arms reach, so that benchmarks measure its computation."""
        self._memories.cache_clear()

    def _memories_of(self, torso_m: float, comfort_m: float, *, minds_arms: bool = False) -> Memories:
        """Return the memories for a height of the lift and a comfort radius (m); raises as `reach` does."""
        low, high = self.card.lift_limits_m
        if not low <= torso_m <= high:
            raise SceneError("torso_m", f"{torso_m} m is not between {low} and {high} m")
        if not (math.isfinite(comfort_m) and comfort_m >= 0.0):
            raise RequestError("comfort_radius_m", f"must be 0 or more, got {comfort_m} m")
        return self._memories(float(torso_m), float(comfort_m), minds_arms)

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
        """Return the joints of least movement that keep arms' tools on their paths, or why there are none.

        Args:
            paths: each arm's tool path, in rising order of the arms, with equally many poses.
            torso_m: the lift's height (m).
            floor_m: the height over which elbows should preferably stay, base frame (m).
            are_free: for each of them the check of which joints are collision-free, whatever the others do.
            together: the check of whether arms collide with each other.

        Returns:
            Joints within their limits (rad), one arm after the other, shape (n, joints); joints without end are
            unwound.
        """
        return arm_paths(arm_searches(self._arms, self.card, paths, torso_m, floor_m, are_free), together)

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
        return self._arms[arm].tool_pose(joints, float(torso_m))
