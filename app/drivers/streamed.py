"""Drivers that are sent positions one after the other, as fast as the robot takes them."""

import math
from abc import ABC, abstractmethod

from app.drivers.driver import Clock, Joints, Seen
from app.files.joint_motion import JointMotion

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
