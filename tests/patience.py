"""Wait until something holds: far longer than it takes, for the machine may be busy. No test waits for time itself."""

import asyncio
import time
from collections.abc import Awaitable, Callable, Iterator
from typing import TypeVar

T = TypeVar("T")

PATIENCE_S = 300.0

FOR_EVER_S = 600.0
"""The time that work takes which has to be stopped (s): longer than any test waits."""

_FIRST_PAUSE_S, _GROWTH, _LONGEST_PAUSE_S = 0.002, 1.2, 0.1
"""The pauses between looks: what comes soon is seen soon, and what takes long is not slowed down by looks."""


def wait_until(condition: Callable[[], T | None]) -> T:
    """Evaluate a condition again and again until it holds; return its value."""
    for pause_s in _pauses_s():
        if value := condition():
            return value
        time.sleep(pause_s)
    raise AssertionError(f"it does not come to hold: {value!r}")


async def wait_until_async(condition: Callable[[], Awaitable[T | None]]) -> T:
    """Await a condition again and again until it holds; return its value."""
    for pause_s in _pauses_s():
        if value := await condition():
            return value
        await asyncio.sleep(pause_s)
    raise AssertionError(f"it does not come to hold: {value!r}")


def _pauses_s() -> Iterator[float]:
    """Yield pauses that grow, until patience is at its end (s)."""
    pause_s, until_s = _FIRST_PAUSE_S, time.monotonic() + PATIENCE_S
    while time.monotonic() < until_s:
        yield pause_s
        pause_s = min(_GROWTH * pause_s, _LONGEST_PAUSE_S)
