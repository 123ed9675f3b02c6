"""What a run sent to a robot and read of it, as ROS messages in an MCAP file."""

from typing import Any

from app.drivers.driver import Clock, Joints, RealClock
from app.files.joint_motion import JointMotion
from planner.robots.card import RobotCard


class Recording:
    """Messages in the order of their times, which count from its beginning.

    Each motion is a `JointTrajectory` for each controller on the topics of the exports, logged when it was sent; what
    was read are `JointState`s on ``/joint_states``.
    """

    def __init__(self, card: RobotCard, clock: Clock | None = None) -> None:
        """Begin a recording of a robot."""
        self._card, self._clock = card, clock or RealClock()
        self._start_s, self._kept = self._clock.now_s(), list[tuple[int, JointMotion | Joints]]()

    def sent(self, motion: JointMotion) -> None:
        """Keep a motion."""
        self._kept.append((self._now_ns(), motion))

    def read(self, joints: Joints) -> None:
        """Keep joints as they were read."""
        self._kept.append((self._now_ns(), dict(joints)))

    def mcap(self, about: dict[str, Any]) -> bytes:
        """Return all of it as a file; `about` says what it is of."""
        from app.files.ros_bag import mcap_of
        from app.files.ros_messages import JointMessages, RosMessage, RosMotion, message_types

        written, messages = JointMessages(message_types()), list[RosMessage]()
        for stamp_ns, kept in self._kept:
            if isinstance(kept, JointMotion):
                messages.extend(written.trajectories(kept, self._card, stamp_ns))
            else:
                messages.append(written.state(kept, stamp_ns))
        return mcap_of(RosMotion(tuple(messages), about))

    def _now_ns(self) -> int:
        return round((self._clock.now_s() - self._start_s) * 1e9)
