"""A robot that is not there: its joints are where they are sent to be."""

from app.drivers.driver import Clock, Joints, RealClock, StreamedDriver
from planner.robots.card import RobotCard

_RATE_HZ = 50.0


class SimulatedDriver(StreamedDriver):
    """A robot in this process; it follows exactly, in real time."""

    def __init__(self, card: RobotCard, clock: Clock | None = None, at: Joints | None = None) -> None:
        """Take the robot's card, a clock other than this machine's, and where joints are at first.

        Those that `at` does not name are at home, grippers open.
        """
        super().__init__(_RATE_HZ, clock or RealClock())
        at_home = {name: q for arm in card.arms for name, q in zip(arm.joint_names, arm.home, strict=True)}
        fingers = {arm.gripper.joint_name: arm.gripper.angle(arm.gripper.opening_max_m) for arm in card.arms}
        self.joints: dict[str, float] = at_home | fingers
        self.joints |= {name: q for name, q in (at or {}).items() if name in self.joints}

    def connect(self) -> None:
        """Do nothing: it is there."""

    def put(self, joints: Joints) -> None:
        """Move the joints; ignore what else is sent, such as the base."""
        self.joints |= {name: value for name, value in joints.items() if name in self.joints}

    def read(self) -> Joints:
        """Return the joints."""
        return dict(self.joints)

    def stop(self) -> None:
        """Do nothing: it moves only where it is sent."""

    def close(self) -> None:
        """Do nothing."""
