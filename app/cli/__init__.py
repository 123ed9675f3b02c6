"""The command line: ``pleat serve``, ``plan``, ``show``, ``timeline``, ``export``, ``dag``, ``check``, ``see``...

Modules stay, so the garbage collector does not look through them while they are imported: that takes a fifth of the
time in which the program starts.
"""

import gc
import os

is_collecting = gc.isenabled()
gc.disable()

from app.cli import backup, compare, export, garment, plan, rehearse, robots, see, serve, study  # noqa: E402
from app.cli.program import cli  # noqa: E402

if is_collecting:
    gc.freeze()
    gc.enable()

__all__ = [
    "backup",
    "cli",
    "compare",
    "export",
    "garment",
    "main",
    "plan",
    "rehearse",
    "robots",
    "see",
    "serve",
    "study",
]


def main() -> None:
    """Run the program: the entry point of the package.

    Processes that it starts run none of the current folder's modules: Python would look for any module there first.
    """
    os.environ["PYTHONSAFEPATH"] = "1"
    cli()
