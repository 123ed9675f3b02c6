"""The template process, of which each worker is a fork: it loads the planner when imported.

Only the fork server may import this module.
"""

import os
import signal
from importlib import import_module

NICENESS = 5
"""Niceness of the work: the server comes first, because users wait for it while they drag."""

_HELD = ("app.cli", "app.searches", "app.live_planning", "app.job_kinds.kinds", "app.files.import_file")
"""Modules to load. The program's main module imports `app.cli`, and every worker runs that again."""


_LOOK_EVERY_S = 0.2
"""Period of the check whether the program still runs (s)."""


def _load() -> None:
    """Load everything that work may need, which takes seconds; exit if the program ends meanwhile."""
    program = os.getppid()
    signal.signal(signal.SIGALRM, lambda *_: None if os.getppid() == program else os._exit(0))
    signal.setitimer(signal.ITIMER_REAL, _LOOK_EVERY_S, _LOOK_EVERY_S)
    os.nice(NICENESS)
    for name in _HELD:
        import_module(name)
    import_module("planner.plans").compile_kernels()
    signal.setitimer(signal.ITIMER_REAL, 0.0)


_load()
