"""The user's own robots: a folder for each, by name, with its card and the files that the card names.

It is `robots` in Pleat's data folder: that of the server, or of `PLEAT_DATA`, or the user's. Work that a server does
in other processes learns which (`app.worker`).
"""

import os
import re
from pathlib import Path

from platformdirs import user_data_path

CARD = "robot.json"
"""The name of a card's file."""

ROBOTS = "robots"
"""The folder of robots in the data folder."""

_NAME = re.compile(r"[a-z0-9][a-z0-9-]{0,63}")
_chosen: list[Path] = []


def robots_folder() -> Path:
    """Return the folder of the user's own robots; it need not exist."""
    if _chosen:
        return _chosen[-1]
    return Path(os.environ.get("PLEAT_DATA") or user_data_path("pleat")) / ROBOTS


def use_robots_folder(folder: Path) -> None:
    """Look for the user's own robots in a folder from now on, in the whole process."""
    _chosen[:] = [folder]


def own_robots() -> tuple[str, ...]:
    """Return the names of the user's own robots, in alphabetical order."""
    return tuple(sorted(path.parent.name for path in robots_folder().glob(f"*/{CARD}") if own_card(path.parent.name)))


def own_card(name: str) -> Path | None:
    """Return the card's file of a robot of the user's own; None if there is none of this name."""
    if not _NAME.fullmatch(name):
        return None
    path = robots_folder() / name / CARD
    return path if path.is_file() else None
