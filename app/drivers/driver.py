"""The port to a robot that performs a plan: what each driver does, and how it fails."""

import math
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from typing import Protocol

from app.files.joint_motion import JointMotion
from planner.errors import FoldingError

Joints = Mapping[str, float]
"""Joints by their names in the robot's URDF (rad, m)."""

Seen = Callable[[float, Joints], None]
"""Called with the time since a motion began (s) and the joints read at that time."""


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


FINGERS_S = 1.0
"""The time in which fingers are brought somewhere (s)."""

_SEEN_EVERY_S = 0.1
"""The time between two looks at the joints (s)."""


class StreamedDriver(ABC):
    """Sends the positions of a motion when their time has come."""

    def __init__(self, rate_hz: float, clock: Clock) -> None:
        """Take how many positions are sent a second, and the clock."""
        self._tick_s, self._clock = 1.0 / rate_hz, clock

    @abstractmethod
    def put(self, joints: Joints) -> None:
        """Move joints to nearby positions without delay."""

    @abstractmethod
    def read(self) -> Joints:
        """Return where the joints are."""

    def send(self, motion: JointMotion, seen: Seen) -> None:
        """Send a motion's positions, the last of them at its end."""
        start_s, next_look_s = self._clock.now_s(), 0.0
        while True:
            t_s = min(self._clock.now_s() - start_s, motion.duration_s)
            self.put(motion.at(t_s))
            if t_s >= next_look_s or t_s == motion.duration_s:
                seen(t_s, self.read())
                next_look_s = t_s + _SEEN_EVERY_S
            if t_s == motion.duration_s:
                return
            # On the raster of ticks: a late one is not made up for by quicker ones.
            ticks = math.floor(t_s / self._tick_s + 1e-6) + 1
            self._clock.wait_until(start_s + min(ticks * self._tick_s, motion.duration_s))

    def grip(self, fingers: Joints) -> None:
        """Move the fingers evenly."""
        here, start_s = self.read(), self._clock.now_s()
        count = math.ceil(FINGERS_S / self._tick_s)
        for number in range(1, count + 1):
            self._clock.wait_until(start_s + number * self._tick_s)
            self.put({name: here[name] + number / count * (end - here[name]) for name, end in fingers.items()})
