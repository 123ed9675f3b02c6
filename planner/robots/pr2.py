"""The PR2, with its card, its reach and its joints."""

import math
from collections.abc import Callable, Mapping
from functools import cached_property, lru_cache

import numpy as np

from planner.errors import RequestError, SceneError
from planner.geometry.pose import BoolArray, FloatArray
from planner.geometry.table import Table
from planner.robots.arm import read_arm
from planner.robots.arm_paths import Together, arm_paths, arm_searches
from planner.robots.card import RobotCard
from planner.robots.collision.collisions import OPENING_M, Collisions
from planner.robots.collision.pr2_parts import pr2_parts
from planner.robots.collision.robot_parts import RobotParts
from planner.robots.comfort_memories import Memories
from planner.robots.description import read_model
from planner.robots.posture_room import Room, room_beside
from planner.robots.pr2_card import pr2_card
from planner.robots.reach import Pr2Reach
from planner.robots.sided_arm import SidedArm
from planner.robots.tool_path import IsFree, NoPath, ToolPath, free_postures, near_path

_MEMORIES_KEPT = 4
"""Torso heights and comfort radii for which it is kept where the arms reach."""


class Pr2:
    """A PR2. It does not change, so all users may share one instance.

    Arms are numbered from left to right as the robot sees them. Poses are of the tool frame, in the base frame
    (``base_footprint``: x ahead, z up from the floor), in m.
    """

    def __init__(self) -> None:
        """Read the robot's description (10 ms); raise `FoldingError` where it is missing."""
        model = read_model()
        shape = read_arm(model)
        self._model = model
        self._card = pr2_card(model)
        self._rooms: dict[float, Room] = {}
        self._memories = lru_cache(_MEMORIES_KEPT)(lambda torso_m, comfort_m: Memories())
        self._arms = (SidedArm(shape, is_mirrored=False), SidedArm(shape, is_mirrored=True))

    @property
    def card(self) -> RobotCard:
        """The robot's card."""
        return self._card

    def home(self, arm: int) -> FloatArray:
        """Return the joints of an arm that is out of the way (rad), shape (7,)."""
        return np.array(self._card.arms[arm].home)

    def reach(self, torso_m: float, comfort_m: float) -> Pr2Reach:
        """Return the reach with the torso raised by `torso_m`, for a comfort radius (m).

        Raises:
            SceneError: the torso does not go there.
            RequestError: the radius is negative or no number.
        """
        low, high = self._card.lift_limits_m
        if not low <= torso_m <= high:
            raise SceneError("torso_m", f"{torso_m} m is not between {low} and {high} m")
        if not (math.isfinite(comfort_m) and comfort_m >= 0.0):
            raise RequestError("comfort_m", f"{comfort_m} m is no radius")
        names = tuple(arm.name for arm in self._card.arms)
        memories = self._memories(float(torso_m), float(comfort_m))
        return Pr2Reach(names, self._arms, float(torso_m), float(comfort_m), self._room(float(torso_m)), memories)

    def forget_reach(self) -> None:
        """Drop what plans have left about where the arms reach, so that benchmarks measure its computation."""
        self._memories.cache_clear()

    def _room(self, torso_m: float) -> Room:
        """Return the room that the body leaves an arm; cached, because every plan needs it."""
        if torso_m not in self._rooms:
            self._rooms = {torso_m: room_beside(self._arms[0].shape, self._parts, torso_m, self.home(1))}
        return self._rooms[torso_m]

    def collisions(
        self, table: Table, torso_m: float, opening_m: float = OPENING_M, margin_m: float = 0.0
    ) -> Collisions:
        """Return the collision checks at a table, with the torso raised (1 ms).

        Args:
            table: the table.
            torso_m: how far the torso is raised (m).
            opening_m: the largest opening of the fingers, which may be anywhere from closed to it (m).
            margin_m: the distance below which parts count as colliding (m).
        """
        return Collisions(self._parts, table, torso_m, opening_m, margin_m)

    @cached_property
    def _parts(self) -> RobotParts:
        """The parts that may collide; 15 ms the first time, a second where the cache of shapes is empty."""
        return pr2_parts(self._model, self._card)

    def can_reach(self, arm: int, positions: FloatArray, rotations: FloatArray, torso_m: float) -> BoolArray:
        """Return which tool poses an arm can take with every joint within its limits, shape (n,).

        Only the approach axis matters: forearm and wrist roll are continuous, so a PR2's tool that reaches a point
        along an axis does so at any roll about it.

        Args:
            arm: the arm's index.
            positions: tool points (m), shape (n, 3).
            rotations: tool rotations, shape (n, 3, 3).
            torso_m: how far the torso is raised (m).
        """
        return self._arms[arm].can_reach(positions, rotations[:, :, 0], float(torso_m))

    def joints_near(
        self, arm: int, position: FloatArray, rotation: FloatArray, torso_m: float, near: FloatArray
    ) -> FloatArray | None:
        """Return the joints nearest to given ones that bring an arm's tool to a pose.

        Args:
            arm: the arm's index.
            position: the tool's position (m), shape (3,).
            rotation: the tool's axes as columns, shape (3, 3).
            torso_m: how far the torso is raised (m).
            near: joints to be near to (rad), shape (7,).

        Returns:
            Joints within their limits (rad), shape (7,), forearm and wrist roll within half a turn of `near`; or None
            where the pose is out of reach.
        """
        return self._arms[arm].joints_near(position, rotation, float(torso_m), near)

    def arm_path_near(
        self, arm: int, path: ToolPath, torso_m: float, is_free: IsFree, known: FloatArray
    ) -> FloatArray | None:
        """Return joints that keep an arm's tool on a path, near to known joints, shape (n, 7) (see `near_path`)."""
        return near_path(self._arms[arm], path, float(torso_m), is_free, known)

    def arm_paths(
        self,
        paths: Mapping[int, ToolPath],
        torso_m: float,
        floor_m: float,
        are_free: Mapping[int, IsFree],
        together: Together,
    ) -> FloatArray | NoPath:
        """Return the calmest joints that keep arms' tools on their paths, or that there are none (see `arm_paths`).

        Args:
            paths: each arm's tool path, in rising order of the arms, with equally many poses.
            torso_m: how far the torso is raised (m).
            floor_m: the height over which elbows should preferably stay, base frame (m).
            are_free: for each of them the check of which joints are collision-free, whatever the others do.
            together: the check of whether arms collide with each other.

        Returns:
            Joints within their limits (rad), one arm after the other, shape (n, joints); rolls are unwound.
        """
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
        """Return the tool's positions in the base frame for rows of joints, shape (n, 7) -> (n, 3), m."""
        return self._arms[arm].tool_places(joints, float(torso_m))

    def elbow_height(self, arm: int, joints: FloatArray, torso_m: float) -> float:
        """Return how high an arm's elbow is above the floor (m) at seven joint angles."""
        return self._arms[arm].elbow_height(joints, float(torso_m))

    def tool_pose(self, arm: int, joints: FloatArray, torso_m: float) -> tuple[FloatArray, FloatArray]:
        """Return the tool's position (m), shape (3,), and rotation, shape (3, 3), at seven joint angles."""
        return self._arms[arm].tool_pose(joints, float(torso_m))
