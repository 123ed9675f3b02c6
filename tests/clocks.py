"""Clocks of searches that run on at once, so that no test waits for time to pass."""

import time
from collections.abc import Callable

import pytest

from planner import deadline

_CLOCKS = {"clock_s": time.process_time, "wall_clock_s": time.perf_counter}
_PAUSE_S = 0.002


class FastClock:
    """A clock of the planner's deadlines that may be put forward.

    Attributes:
        ahead_s: how far it is put forward (s).
    """

    def __init__(self, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
        """Take the place of `deadline.clock_s` or `deadline.wall_clock_s`, by name."""
        self.ahead_s = 0.0
        monkeypatch.setattr(deadline, name, lambda: _CLOCKS[name]() + self.ahead_s)
        monkeypatch.setattr(deadline, "LOOK_S", 0.0)  # it may run on by hours between two looks


def slow_machine(monkeypatch: pytest.MonkeyPatch) -> Callable[[], bool]:
    """Return a question whether to stop that a slow machine answers slowly, and always with no."""
    clocks = [FastClock(monkeypatch, name) for name in _CLOCKS]

    def should_stop() -> bool:
        for clock in clocks:
            clock.ahead_s += _PAUSE_S
        return False

    return should_stop
