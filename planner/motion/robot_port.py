"""The protocol for what planning needs of a robot besides its reach; `planner.robots` implements it."""

from collections.abc import Callable, Hashable, Mapping, Sequence
from typing import Protocol

from planner.geometry.pose import BoolArray, FloatArray, Pose2
from planner.geometry.table import Table
from planner.primitives.reach import Reach
from planner.robots.arm_paths import Together
from planner.robots.card import RobotCard
from planner.robots.collision.contact import Contact
from planner.robots.openings import OPENING_M
from planner.robots.tool_path import IsFree, NoPath, ToolPath


class Clearance(Protocol):
    """The test whether a robot's arms are high enough above cloth on the table."""

    def arm_clear(self, arm: int, bases: Pose2 | FloatArray, joints: FloatArray) -> BoolArray:
        """Return at which joints of one arm it is high enough, shape (n,); see `Collisions.arm_free`."""
        ...


class Collisions(Together, Hashable, Protocol):
    """The collisions of a robot with itself and the table.

    Joints are in rad: of one arm, or a configuration, which is a row of the joints of all arms (see `JointLayout`).
    Bases are poses of the table frame: one for all, or x (m), y (m), yaw (rad) of each, shape (n, 3).
    """

    def free_until(self, bases: Pose2 | FloatArray, joints: FloatArray) -> int:
        """Return the number of configurations before the first one at which something touches."""
        ...

    def are_all_free(self, bases: Pose2 | FloatArray, joints: FloatArray) -> bool:
        """Return whether none of some configurations touches anything."""
        ...

    def arm_free(self, arm: int, bases: Pose2 | FloatArray, joints: FloatArray) -> BoolArray:
        """Return at which joints of one arm it touches neither body nor table; shape (n,)."""
        ...

    def arms_apart(self, arms: tuple[int, ...], joints: FloatArray) -> BoolArray:
        """Return in which postures of some arms, in rising order, none of them touches another; shape (n,)."""
        ...

    def are_some_apart(self, arms: tuple[int, int], first: FloatArray, second: FloatArray) -> bool:
        """Return whether any postures of two arms do not touch; see `postures_apart`."""
        ...

    def over_cloth(self, pieces: Sequence[FloatArray], over_m: float) -> Clearance:
        """Return the test for a height above convex pieces of cloth, table frame, each of shape (n, 2), m."""
        ...

    def deepest_contact(self, base_in_table: Pose2, joints: FloatArray) -> Contact | None:
        """Return the deepest contact in one configuration; None if nothing touches."""
        ...


class PathFinder(Protocol):
    """The search for joints that keep tools on their paths."""

    def arm_path_near(
        self, arm: int, path: ToolPath, torso_m: float, is_free: IsFree, known: FloatArray
    ) -> FloatArray | None:
        """Return joints that keep a tool on a path near to known ones, a row each; None if none are near enough."""
        ...

    def arm_paths(
        self,
        paths: Mapping[int, ToolPath],
        torso_m: float,
        floor_m: float,
        are_free: Mapping[int, IsFree],
        together: Together,
    ) -> FloatArray | NoPath:
        """Return the smoothest collision-free joints of arms along their tool paths, or that none exist.

        Args:
            paths: each arm's tool path, in rising order of the arms, of equal length.
            torso_m: the height of the lift (m).
            floor_m: the height above which elbows should stay, base frame (m).
            are_free: for each of them the test for collision-free joints, whatever the others do.
            together: the test whether arms are in each other's way.

        Returns:
            These arms' joints, one arm after the other, shape (n, joints).
        """
        ...


class Kinematics(Protocol):
    """An arm's kinematics: from joints to the tool's pose, and from a pose to free joints."""

    def free_postures(
        self,
        arm: int,
        position: FloatArray,
        rotation: FloatArray,
        torso_m: float,
        is_free: Callable[[FloatArray], BoolArray],
    ) -> FloatArray:
        """Return samples of free joints that bring a tool to a pose of the base frame, a row each."""
        ...

    def tool_places(self, arm: int, joints: FloatArray, torso_m: float) -> FloatArray:
        """Return the tool's positions in the base frame at each row of joints, shape (n, 3), m."""
        ...

    def tool_pose(self, arm: int, joints: FloatArray, torso_m: float) -> tuple[FloatArray, FloatArray]:
        """Return the tool's position (m), shape (3,), and rotation, shape (3, 3), in the base frame at some joints."""
        ...


class RobotPort(PathFinder, Kinematics, Hashable, Protocol):
    """A robot: its card, its reach, what its arms touch, and the joints that bring a tool to a pose."""

    @property
    def card(self) -> RobotCard:
        """The robot's description."""
        ...

    @property
    def can_mind_arms(self) -> bool:
        """Whether `reach` differs where the other arm is minded."""
        ...

    @property
    def mirror(self) -> Callable[[FloatArray], FloatArray] | None:
        """The mirror image of configurations, shape (n, joints); None where the arms are not each other's."""
        ...

    def reach(
        self,
        torso_m: float,
        comfort_m: float,
        *,
        is_passing: bool = False,
        minds_body: bool = True,
        minds_arms: bool = False,
    ) -> Reach:
        """Return the reach with the lift at a height, for a comfort radius (m).

        Args:
            torso_m: how far the lift is raised (m).
            comfort_m: the comfort radius (m).
            is_passing: whether it is for a few queries only: it takes no memory from earlier plans and leaves none.
            minds_body: whether a place is out of reach where the robot's body may be in the arm's way. What that leaves
                is told in cells of 2 cm; a path that keeps clear of the body knows better.
            minds_arms: whether it is out of reach, too, where the other arm at home may be in the way. That arm may be
                elsewhere, so this is for restricted tasks.
        """
        ...

    def collisions(
        self, table: Table, torso_m: float, opening_m: float = OPENING_M, margin_m: float = 0.0
    ) -> Collisions:
        """Return the collisions at a table with the lift at a height.

        Args:
            table: the table.
            torso_m: how far the lift is raised (m).
            opening_m: the opening up to which fingers may be open (m).
            margin_m: anything nearer counts as touching (m).
        """
        ...

    def edge_raised_m(self, arm: int, height_m: float, pitch_rad: float) -> float | None:
        """Return how far above its path a hand opens and closes to hold cloth at its edge (m).

        One finger is then under the cloth and one over it. None where the gripper cannot do so.

        Args:
            arm: the arm.
            height_m: the tool's height above the table while it holds cloth that lies (m).
            pitch_rad: how far the fingers point below the horizontal (rad).
        """
        ...
