"""What a run sent to a robot and read of it, as ROS messages in an MCAP file."""

from typing import Any

from app.drivers.driver import Clock, Joints, RealClock
from app.files.ros_bag import mcap_of
from app.files.ros_messages import JointMessages, RosMessage, RosMotion, message_types
from app.files.step_motion import StepMotion
from planner.robots.card import RobotCard


class Recording:
    """Messages in the order of their times, which count from its beginning.

    Each motion is a `JointTrajectory` for each controller on the topics of the exports, logged when it was sent; what
    was read are `JointState`s on ``/joint_states``.
    """

    def __init__(self, card: RobotCard, clock: Clock | None = None) -> None:
        """Begin a recording of a robot."""
        self._card, self._clock = card, clock or RealClock()
        self._messages = JointMessages(message_types())
        self._start_s, self._kept = self._clock.now_s(), list[RosMessage]()

    def sent(self, motion: StepMotion) -> None:
        """Keep a motion."""
        self._kept.extend(self._messages.trajectories(motion, self._card, self._now_ns()))

    def read(self, joints: Joints) -> None:
        """Keep joints as they were read."""
        self._kept.append(self._messages.state(joints, self._now_ns()))

    def mcap(self, about: dict[str, Any]) -> bytes:
        """Return all of it as a file; `about` says what it is of."""
        return mcap_of(RosMotion(tuple(self._kept), about))

    def _now_ns(self) -> int:
        return round((self._clock.now_s() - self._start_s) * 1e9)
