"""Keep the C library from spreading memory over many arenas.

glibc gives threads arenas of their own, up to eight for each core, and each arena keeps what its threads have freed. A
server has more threads than that, and searches move from thread to thread: what one has freed does not serve the next.
The interpreter lets one thread run at a time anyway, so that few arenas cost no time.
"""

import ctypes
import os
from contextlib import suppress

ARENAS_MAX = 2

_M_ARENA_MAX = -8
"""The parameter of glibc's `mallopt` for the number of arenas."""

_CHOSEN_BY = ("MALLOC_ARENA_MAX", "GLIBC_TUNABLES")
"""The variables by which who runs the server chooses the number."""


def use_few_arenas() -> None:
    """Limit the arenas of this process, before it starts threads; do nothing where the C library has none."""
    if not any(name in os.environ for name in _CHOSEN_BY):
        with suppress(AttributeError, OSError, TypeError):  # another C library, another system
            ctypes.CDLL(None).mallopt(_M_ARENA_MAX, ARENAS_MAX)
