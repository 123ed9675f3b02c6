"""Load a robot by its name, or by the path of its card."""

from functools import cache, lru_cache
from pathlib import Path

from planner.errors import RequestError
from planner.robots.card_file import CardFile
from planner.robots.card_robot import CardRobot
from planner.robots.described_robot import read_card, read_robot, shipped_card, shipped_robots
from planner.robots.pr2 import Pr2

CLOSED_FORMS = {"pr2": Pr2}
"""The robots whose arms have a closed form, by name; the others have maps of postures."""


@cache
def load_robot(name_or_path: str) -> Pr2 | CardRobot:
    """Return a robot by the name of a shipped card, or by the path of a card of one's own.

    Raises:
        RequestError: there is no such robot.
        RobotError: its card or its URDF is not valid.
    """
    if name_or_path in CLOSED_FORMS:
        return CLOSED_FORMS[name_or_path]()
    _require_card(name_or_path)
    return CardRobot(read_robot(name_or_path))


@lru_cache(maxsize=16)
def robot_card_file(name_or_path: str) -> CardFile:
    """Return a robot's card without a look at its URDF; raises as `load_robot` does."""
    _require_card(name_or_path)
    return shipped_card(name_or_path) if name_or_path in shipped_robots() else read_card(Path(name_or_path))


def _require_card(name_or_path: str) -> None:
    if name_or_path not in shipped_robots() and not _is_card(name_or_path):
        raise RequestError("robot", f"there is no robot {name_or_path[:80]!r}, only {', '.join(shipped_robots())}")


def _is_card(path: str) -> bool:
    try:
        return path.endswith(".json") and Path(path).is_file()
    except (OSError, ValueError):
        return False
