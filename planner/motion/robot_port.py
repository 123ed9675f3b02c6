"""What planning asks of a robot besides its reach; `planner.robot` answers it."""

from collections.abc import Callable, Hashable, Sequence
from typing import Protocol

from planner.geometry.pose import BoolArray, FloatArray, Pose2
from planner.geometry.table import Table
from planner.primitives.reach import Reach
from planner.robot.arm_pair_path import BothArms
from planner.robot.card import RobotCard
from planner.robot.collision.contact import Contact
from planner.robot.tool_path import IsFree, NoPath, ToolPath


class Clearance(Protocol):
    """What of a robot's arms is too low over cloth that lies somewhere."""

    def arm_clear(
        self, arm: int, bases: Pose2 | FloatArray, joints: FloatArray, *, is_certain: bool = False
    ) -> BoolArray:
        """At which joints of one arm, shape (n, 7), it is high enough, shape (n,); see `Collisions.arm_free`."""
        ...


class Collisions(Protocol):
    """What of a robot is in whose way.

    Joints are in rad. Bases are poses of the table frame: one for all, or x (m), y (m), yaw (rad) of each, (n, 3).
    """

    def are_all_free(self, bases: Pose2 | FloatArray, joints: FloatArray) -> bool:
        """Whether none of some configurations, shape (n, arms, 7), touches anything."""
        ...

    def arm_free(
        self, arm: int, bases: Pose2 | FloatArray, joints: FloatArray, *, is_certain: bool = False
    ) -> BoolArray:
        """At which joints of one arm, shape (n, 7), it touches neither body nor table; shape (n,).

        Only what is certainly so counts if that is asked for, which is quicker.
        """
        ...

    def arms_apart(self, joints: FloatArray, *, is_certain: bool = False) -> BoolArray:
        """In which configurations, shape (n, arms, 7), no arm touches another; shape (n,); see `arm_free`."""
        ...

    def postures_apart(self, left: FloatArray, right: FloatArray) -> BoolArray:
        """Which postures of the left arm, shape (k, 7), certainly touch none of which of the right, shape (l, 7).

        In all postures of an arm its tool is in the same pose. The answers are of shape (k, l).
        """
        ...

    def are_some_apart(self, left: FloatArray, right: FloatArray) -> bool:
        """Whether some posture of the left arm and some of the right certainly do not touch; see `postures_apart`."""
        ...

    def over_cloth(self, pieces: Sequence[FloatArray], over_m: float) -> Clearance:
        """What is lower than so high (m) over convex pieces of cloth, table frame, each of shape (n, 2), m."""
        ...

    def deepest_contact(self, base_in_table: Pose2, joints: FloatArray) -> Contact | None:
        """Of all that touches in one configuration, shape (arms, 7), what does so deepest; None if nothing does."""
        ...


class RobotPort(Hashable, Protocol):
    """A robot: its card, its reach, and the joints that bring a tool to a pose."""

    @property
    def card(self) -> RobotCard:
        """What the robot is."""
        ...

    def home(self, arm: int) -> FloatArray:
        """The joints of an arm that is out of the way (rad)."""
        ...

    def reach(self, torso_m: float, comfort_m: float) -> Reach:
        """The reach with the lift raised so far, to a comfort radius (m)."""
        ...

    def joints_near(
        self, arm: int, position: FloatArray, rotation: FloatArray, torso_m: float, near: FloatArray
    ) -> FloatArray | None:
        """The joints nearest to `near` that bring the tool to a pose of the base frame, or None."""
        ...

    def can_reach(self, arm: int, positions: FloatArray, rotations: FloatArray, torso_m: float) -> BoolArray:
        """Which tool poses of the base frame, shapes (n, 3) and (n, 3, 3), an arm can take; shape (n,)."""
        ...

    def arm_path(
        self,
        arm: int,
        path: ToolPath,
        torso_m: float,
        floor_m: float,
        is_free: IsFree,
    ) -> FloatArray | NoPath:
        """The calmest joints that keep a tool on a path, shape (n, 7), none of which collides; or that there are none.

        Args:
            arm: which arm.
            path: where its tool must be.
            torso_m: how far the lift is raised (m).
            floor_m: the height over which elbows had better stay, base frame (m).
            is_free: which joints do not collide.
        """
        ...

    def arm_path_near(
        self, arm: int, path: ToolPath, torso_m: float, is_free: IsFree, known: FloatArray
    ) -> FloatArray | None:
        """Joints that keep a tool on a path near to others that are known, shape (n, 7); None where none so near do."""
        ...

    def arm_pair_path(
        self,
        paths: tuple[ToolPath, ToolPath],
        torso_m: float,
        floor_m: float,
        are_free: tuple[IsFree, IsFree],
        both_arms: BothArms,
    ) -> FloatArray | NoPath:
        """The same for two arms, joints of shape (n, 2, 7).

        Args:
            paths: where the tools must be, one path as long as the other.
            torso_m: how far the lift is raised (m).
            floor_m: the height over which elbows had better stay, base frame (m).
            are_free: of each arm which joints do not collide, whatever the other does.
            both_arms: knows whether the arms are in each other's way.
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
        """Samples of joints, shape (k, 7), that bring a tool to a pose of the base frame and are free."""
        ...

    def collisions(self, table: Table, torso_m: float, *, margin_m: float = 0.0) -> Collisions:
        """What is in whose way at a table, with the lift raised so far; what is nearer than a margin (m) is too."""
        ...

    def tool_pose(self, arm: int, joints: FloatArray, torso_m: float) -> tuple[FloatArray, FloatArray]:
        """The tool's position (m), shape (3,), and rotation, shape (3, 3), in the base frame."""
        ...

    def tool_places(self, arm: int, joints: FloatArray, torso_m: float) -> FloatArray:
        """The tool's positions in the base frame at each of some joints, shape (n, 7) -> (n, 3), m."""
        ...
