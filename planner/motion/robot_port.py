"""The protocol for what planning needs of a robot besides its reach; `planner.robots` implements it."""

from collections.abc import Callable, Hashable, Sequence
from typing import Protocol

from planner.geometry.pose import BoolArray, FloatArray, Pose2
from planner.geometry.table import Table
from planner.primitives.reach import Reach
from planner.robots.arm_pair_path import BothArms
from planner.robots.card import RobotCard
from planner.robots.collision.contact import Contact
from planner.robots.tool_path import IsFree, NoPath, ToolPath


class Clearance(Protocol):
    """The test whether a robot's arms are high enough above cloth on the table."""

    def arm_clear(
        self, arm: int, bases: Pose2 | FloatArray, joints: FloatArray, *, is_certain: bool = False
    ) -> BoolArray:
        """Return at which joints of one arm, shape (n, 7), it is high enough, shape (n,); see `Collisions.arm_free`."""
        ...


class Collisions(Protocol):
    """The collisions of a robot with itself and the table.

    Joints are in rad. Bases are poses of the table frame: one for all, or x (m), y (m), yaw (rad) of each, (n, 3).
    """

    def are_all_free(self, bases: Pose2 | FloatArray, joints: FloatArray) -> bool:
        """Return whether none of some configurations, shape (n, arms, 7), touches anything."""
        ...

    def arm_free(
        self, arm: int, bases: Pose2 | FloatArray, joints: FloatArray, *, is_certain: bool = False
    ) -> BoolArray:
        """Return at which joints of one arm, shape (n, 7), it touches neither body nor table; shape (n,).

        With `is_certain` only those count that certainly touch nothing, which is quicker to tell.
        """
        ...

    def arms_apart(self, joints: FloatArray, *, is_certain: bool = False) -> BoolArray:
        """Return in which configurations, shape (n, arms, 7), no arm touches another; shape (n,).

        For `is_certain` see `arm_free`.
        """
        ...

    def postures_apart(self, left: FloatArray, right: FloatArray) -> BoolArray:
        """Return which pairs of left postures, shape (k, 7), and right ones, shape (l, 7), certainly do not touch.

        In all postures of an arm its tool is in the same pose. The answers are of shape (k, l).
        """
        ...

    def are_some_apart(self, left: FloatArray, right: FloatArray) -> bool:
        """Return whether any left and any right posture certainly do not touch; see `postures_apart`."""
        ...

    def over_cloth(self, pieces: Sequence[FloatArray], over_m: float) -> Clearance:
        """Return the test for a height above convex pieces of cloth, table frame, each of shape (n, 2), m."""
        ...

    def deepest_contact(self, base_in_table: Pose2, joints: FloatArray) -> Contact | None:
        """Return the deepest contact in one configuration, shape (arms, 7); None if nothing touches."""
        ...


class RobotPort(Hashable, Protocol):
    """A robot: its card, its reach, and the joints that bring a tool to a pose."""

    @property
    def card(self) -> RobotCard:
        """The robot's description."""
        ...

    def home(self, arm: int) -> FloatArray:
        """Return the joints of an arm that is out of the way (rad)."""
        ...

    def reach(self, torso_m: float, comfort_m: float) -> Reach:
        """Return the reach with the lift at a height, for a comfort radius (m)."""
        ...

    def joints_near(
        self, arm: int, position: FloatArray, rotation: FloatArray, torso_m: float, near: FloatArray
    ) -> FloatArray | None:
        """Return the joints nearest to `near` that bring the tool to a pose of the base frame, or None."""
        ...

    def can_reach(self, arm: int, positions: FloatArray, rotations: FloatArray, torso_m: float) -> BoolArray:
        """Return which tool poses of the base frame, shapes (n, 3) and (n, 3, 3), an arm can take; shape (n,)."""
        ...

    def arm_path(
        self,
        arm: int,
        path: ToolPath,
        torso_m: float,
        floor_m: float,
        is_free: IsFree,
    ) -> FloatArray | NoPath:
        """Return the calmest collision-free joints that keep a tool on a path, shape (n, 7), or that there are none.

        Args:
            arm: the arm.
            path: the tool path.
            torso_m: the height of the lift (m).
            floor_m: the height above which elbows should stay, base frame (m).
            is_free: the test for collision-free joints.
        """
        ...

    def arm_path_near(
        self, arm: int, path: ToolPath, torso_m: float, is_free: IsFree, known: FloatArray
    ) -> FloatArray | None:
        """Return joints, shape (n, 7), that keep a tool on a path near to known ones; None if none are near enough."""
        ...

    def arm_pair_path(
        self,
        paths: tuple[ToolPath, ToolPath],
        torso_m: float,
        floor_m: float,
        are_free: tuple[IsFree, IsFree],
        both_arms: BothArms,
    ) -> FloatArray | NoPath:
        """Return the calmest collision-free joints of two arms on their paths, shape (n, 2, 7), or that there are none.

        Args:
            paths: the tool paths, of equal length.
            torso_m: the height of the lift (m).
            floor_m: the height above which elbows should stay, base frame (m).
            are_free: for each arm the test for collision-free joints, whatever the other does.
            both_arms: the test whether the arms are in each other's way.
        """
        ...

    def free_postures(
        self,
        arm: int,
        position: FloatArray,
        rotation: FloatArray,
        torso_m: float,
        is_free: Callable[[FloatArray], BoolArray],
    ) -> FloatArray:
        """Return samples of free joints, shape (k, 7), that bring a tool to a pose of the base frame."""
        ...

    def collisions(self, table: Table, torso_m: float, *, margin_m: float = 0.0) -> Collisions:
        """Return the collisions at a table with the lift at a height; anything nearer than a margin (m) counts."""
        ...

    def tool_pose(self, arm: int, joints: FloatArray, torso_m: float) -> tuple[FloatArray, FloatArray]:
        """Return the tool's position (m), shape (3,), and rotation, shape (3, 3), in the base frame."""
        ...

    def tool_places(self, arm: int, joints: FloatArray, torso_m: float) -> FloatArray:
        """Return the tool's positions in the base frame at each of some joints, shape (n, 7) -> (n, 3), m."""
        ...
