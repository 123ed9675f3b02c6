"""The cards of robots by name, the shipped ones and the user's own, read without a look at their URDFs."""

import json
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

from planner.errors import RequestError, RobotError, UnknownRobotError
from planner.robots.card_file import CardFile
from planner.robots.own_robots import own_card, own_robots
from planner.robots.varied_card import split_changes, varied

_CARDS = Path(__file__).parent / "cards"

CARD_BYTES_MAX = 1_000_000
"""A larger file is no card."""


@cache
def shipped_robots() -> tuple[str, ...]:
    """Return the names of the robots that are shipped, in alphabetical order.

    Remembered: each message about a document looks up its robot, and to list a folder lets go of the interpreter a
    dozen times, each of which waits for a search in another thread.
    """
    return tuple(sorted(path.stem for path in _CARDS.glob("*.json")))


def shipped_card(name: str) -> CardFile:
    """Return a shipped robot's card without reading its URDF; raise `UnknownRobotError` for another name."""
    if name not in shipped_robots():
        raise UnknownRobotError(name)
    return read_card(shipped_path(name))


def shipped_path(name: str) -> Path:
    """Return the file of a shipped robot's card."""
    return _CARDS / f"{name}.json"


def robot_names() -> tuple[str, ...]:
    """Return the names of all robots, the shipped ones first."""
    shipped = shipped_robots()
    return (*shipped, *(name for name in own_robots() if name not in shipped))


def robot_cards() -> list[CardFile]:
    """Return the cards of all robots, the shipped ones first; skip those of the user's own that are not valid."""
    cards = []
    for name in robot_names():
        with suppress(RobotError, UnknownRobotError):
            cards.append(card_of(name))
    return cards


def card_of(name: str) -> CardFile:
    """Return the card of a robot by its name, without a look at its URDF.

    Raises:
        UnknownRobotError: there is none.
        RobotError: the card of a user's own robot cannot be read, or has another name.
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


def read_card(path: Path) -> CardFile:
    """Return the card in a file; raises `RobotError`."""
    try:
        if path.stat().st_size > CARD_BYTES_MAX:
            raise RobotError("", f"{path.name} is larger than {CARD_BYTES_MAX // 1000} kB")
        data = json.loads(path.read_text(encoding="utf-8"))
    except RobotError:
        raise
    except OSError as error:
        raise RobotError("", f"{path.name} cannot be read: {error.strerror}") from None
    except (ValueError, RecursionError) as error:
        raise RobotError("", f"{path.name} cannot be read as JSON: {error}") from None
    return CardFile.from_dict(data)


def robot_entry(card: CardFile) -> dict[str, Any]:
    """Return a robot's entry in a list of robots, as JSON."""
    return {
        "name": card.name,
        "title": card.title,
        "arms": [arm.name for arm in card.arms],
        "base": card.base.kind,
        "shipped": card.name in shipped_robots(),
    }


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
