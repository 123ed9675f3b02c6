"""The port to a robot that performs a plan: what each driver does, and how it fails."""

import time
from collections.abc import Callable, Mapping
from typing import Protocol

from app.files.joint_motion import JointMotion
from planner.errors import FoldingError

Joints = Mapping[str, float]
"""Joints by their names in the robot's URDF (rad, m)."""

Seen = Callable[[float, Joints], None]
"""Is told how long a motion has gone on (s), and the joints as read then."""


class DriverError(FoldingError):
    """A driver that cannot be used: a library or an address is missing, or the robot is one that it does not drive."""


class LostError(FoldingError):
    """A robot that does not answer, refuses what it is sent, or is not where it should be."""


class Driver(Protocol):
    """A robot. All of its methods but `stop` raise `LostError` where it is lost."""

    def connect(self) -> None:
        """Connect to the robot, without moving it; raises `DriverError`, too."""
        ...

    def read(self) -> Joints:
        """Return where the joints of arms and grippers are."""
        ...

    def send(self, motion: JointMotion, seen: Seen) -> None:
        """Have a motion performed from now on; return at its end."""
        ...

    def grip(self, fingers: Joints) -> None:
        """Bring the joints that drive fingers somewhere; return when they are there."""
        ...

    def stop(self) -> None:
        """Stop all motion, as well as it can be done; never raises."""
        ...

    def close(self) -> None:
        """End the connection; the robot stays where it is. Never raises."""
        ...


class Clock(Protocol):
    """A clock that can be waited for."""

    def now_s(self) -> float:
        """Return the time (s)."""
        ...

    def wait_until(self, t_s: float) -> None:
        """Wait until a time of the clock (s); return immediately if it has passed."""
        ...


class RealClock:
    """The clock of this machine."""

    def now_s(self) -> float:
        """Return the time since some moment (s)."""
        return time.monotonic()

    def wait_until(self, t_s: float) -> None:
        """Sleep until then."""
        time.sleep(max(t_s - time.monotonic(), 0.0))
