"""The names of robots: the shipped ones, then the user's own."""

from contextlib import suppress
from pathlib import Path

from planner.errors import RequestError, RobotError, UnknownRobotError
from planner.robots.card_file import CardFile
from planner.robots.described_robot import read_card, shipped_card, shipped_path, shipped_robots
from planner.robots.own_robots import own_card, own_robots
from planner.robots.varied_card import split_changes, varied


def robot_names() -> tuple[str, ...]:
    """Return the names of all robots, the shipped ones first."""
    shipped = shipped_robots()
    return (*shipped, *(name for name in own_robots() if name not in shipped))


def robot_cards() -> list[CardFile]:
    """Return the cards of all robots, the shipped ones first; skip those of one's own that are not valid."""
    cards = []
    for name in robot_names():
        with suppress(RobotError, UnknownRobotError):
            cards.append(card_of(name))
    return cards


def card_of(name: str) -> CardFile:
    """Return the card of a robot by its name, without a look at its URDF.

    Raises:
        UnknownRobotError: there is none.
        RobotError: the card of a robot of one's own cannot be read, or is that of another name.
    """
    if name in shipped_robots():
        return shipped_card(name)
    path = own_card(name)
    if path is None:
        raise UnknownRobotError(name)
    card = read_card(path)
    if card.name != name:
        raise RobotError("name", f"is {card.name!r}, but its folder is called {name!r}")
    return card


def card_path(name_or_path: str) -> Path | None:
    """Return the file of a card by the name of its robot or by its own path; None if there is none."""
    if name_or_path in shipped_robots():
        return shipped_path(name_or_path)
    own = own_card(name_or_path)
    if own is not None:
        return own
    path = Path(name_or_path)
    return path if name_or_path.endswith(".json") and path.is_file() else None


def require_name(robot: str) -> None:
    """Raise `RequestError` for a robot that is given by anything but the name of one, changes of its card included."""
    known, (base, changes) = robot_names(), split_changes(robot)
    if base not in known:
        raise RequestError("robot", f"there is no robot {base[:80]!r}, only {', '.join(known)}")
    if changes:
        varied(card_of(base), changes)
