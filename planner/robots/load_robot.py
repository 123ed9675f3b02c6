"""Load a robot by its name, or by the path of its card."""

from functools import cache, lru_cache
from pathlib import Path
from typing import TypeAlias

from planner.errors import RequestError
from planner.robots.card_file import CardFile
from planner.robots.card_robot import CardRobot
from planner.robots.described_robot import DescribedRobot
from planner.robots.known_robots import card_path, read_card, robot_names
from planner.robots.pr2.robot import Pr2
from planner.robots.reach_maps import Progress
from planner.robots.varied_card import split_changes, varied

CLOSED_FORMS = {"pr2": Pr2}
"""The robots whose arms have a closed form, by name; the others have reach maps."""

_SCENE = "scene."
"""Fields of a card that do not concern the robot itself begin with this."""

_ROBOTS_KEPT = 8
"""Robots that are kept, some 20 MB an arm once they have been planned for: all shipped ones."""

Stamp: TypeAlias = tuple[int, int, int]
"""The identity of a card's file, which changes when it is written anew."""


def load_robot(name_or_path: str) -> Pr2 | CardRobot:
    """Return a robot, shipped or the user's own, by its name or its card's path; the same one until that changes.

    A name or a path may be followed by changes of the card (see `planner.robots.varied_card`).

    Raises:
        RequestError: there is no such robot, or its card has no such field.
        RobotError: its card or its URDF is not valid.
    """
    base, changes = split_changes(name_or_path)
    card = robot_card_file(name_or_path)
    if base in CLOSED_FORMS and all(path.startswith(_SCENE) for path, _ in changes):
        return _closed_form(base)
    path, stamp = _found(base)
    return _described(path, stamp, card)


def prepare_robot(name_or_path: str, progress: Progress) -> None:
    """Make a robot ready for planning, which takes up to a minute when its arms have never been mapped on this machine.

    Planning does so by itself, but does not report how far it is. Raises as `load_robot` does.

    Args:
        name_or_path: the robot's name, or the path of its card.
        progress: called with how far the maps are that must be built (0 to 1); not called for those that exist.
    """
    robot = load_robot(name_or_path)
    if isinstance(robot, CardRobot):
        robot.prepare(progress)


def needs_maps(name_or_path: str) -> bool:
    """Return whether planning for a robot needs maps of its arms, which may have to be built."""
    return split_changes(name_or_path)[0] not in CLOSED_FORMS


def robot_card_file(name_or_path: str) -> CardFile:
    """Return a robot's card without a look at its URDF; raises as `load_robot` does."""
    base, changes = split_changes(name_or_path)
    return varied(_card(*_found(base)), changes)


def robot_stamp(name_or_path: str) -> Stamp:
    """Return what changes when a robot is replaced by another one of its name; raises as `load_robot` does."""
    return _found(split_changes(name_or_path)[0])[1]


@cache
def _closed_form(name: str) -> Pr2:
    return CLOSED_FORMS[name]()


@lru_cache(_ROBOTS_KEPT)
def _described(path: Path, _: Stamp, card: CardFile) -> CardRobot:
    return CardRobot(DescribedRobot.of(card, path.parent))


@lru_cache(_ROBOTS_KEPT)
def _card(path: Path, _: Stamp) -> CardFile:
    return read_card(path)


def _found(name_or_path: str) -> tuple[Path, Stamp]:
    """Return the file of a robot's card, and its stamp."""
    try:
        path = card_path(name_or_path)
        if path is not None:
            state = path.stat()
            return path, (state.st_mtime_ns, state.st_ino, state.st_size)
    except (OSError, ValueError):
        pass
    raise RequestError("robot", f"there is no robot {name_or_path[:80]!r}, only {', '.join(robot_names())}")


def compile_samples(name: str) -> None:
    """Compile what samples the joints of any robot that has reach maps, with the arms of one of them."""
    robot = load_robot(name)
    if isinstance(robot, CardRobot):
        robot.compile_samples()
