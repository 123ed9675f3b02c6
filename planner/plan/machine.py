"""What planning asks of a robot besides its reach; `planner.robot` answers it."""

from typing import Protocol

from planner.geometry.pose import FloatArray
from planner.primitives.reach import Reach
from planner.robot.card import RobotCard


class Machine(Protocol):
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

    def elbow_height(self, arm: int, joints: FloatArray, torso_m: float) -> float:
        """How high an arm's elbow is above the floor (m)."""
        ...

    def tool_pose(self, arm: int, joints: FloatArray, torso_m: float) -> tuple[FloatArray, FloatArray]:
        """The tool's position (m), shape (3,), and rotation, shape (3, 3), in the base frame."""
        ...
