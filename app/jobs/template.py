"""What the template process holds, of which each piece of work gets a copy: imported there, and nowhere else."""

import os
import signal
from importlib import import_module

NICENESS = 5
"""The server, which somebody waits for with a pointer in the hand, comes first."""

_HELD = ("app.cli", "app.searches")
"""The first is what the program's main module imports, which every copy runs again."""


_LOOK_EVERY_S = 0.2
"""How often it is looked whether the server is still there (s)."""


def _load() -> None:
    """Load all that a piece of work may want, which takes seconds; end at once when the server ends meanwhile."""
    server = os.getppid()
    signal.signal(signal.SIGALRM, lambda *_: None if os.getppid() == server else os._exit(0))
    signal.setitimer(signal.ITIMER_REAL, _LOOK_EVERY_S, _LOOK_EVERY_S)
    os.nice(NICENESS)
    for name in _HELD:
        import_module(name)
    import_module("planner.plans").compile_kernels()
    signal.setitimer(signal.ITIMER_REAL, 0.0)


_load()
