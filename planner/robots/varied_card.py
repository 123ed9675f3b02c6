"""Robots whose cards differ in some fields, for questions about hardware: arms further apart, a lower table.

Such a robot is named by the one it is made from and its changes: ``ur5e-pair@mounts.0.y_m=0.35:mounts.1.y_m=-0.35``. A
field's path has names and, into lists, numbers from 0; its value is JSON.
"""

import json
from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

from planner.errors import RequestError, RobotError
from planner.robots.card_file import CardFile

Changes: TypeAlias = tuple[tuple[str, str], ...]
"""Paths of fields of a card, and their values as JSON."""

CHANGES_MAX = 32
"""The most changes of one robot."""

_FIXED = ("pleat_robot", "name")


def changed(name: str, values: Mapping[str, object]) -> str:
    """Return the name of a robot with some more fields of its card changed, by their paths."""
    changed = ":".join(f"{path}={json.dumps(value)}" for path, value in values.items())
    return f"{name}{':' if '@' in name else '@'}{changed}" if values else name


def split_changes(name: str) -> tuple[str, Changes]:
    """Return the robot that a name is made from, and the changes of its card; none for a robot as it is.

    Raises:
        RequestError: what follows the ``@`` is not a list of changes.
    """
    base, mark, changed = name.partition("@")
    if not mark:
        return name, ()
    changes = [tuple(part.split("=", 1)) for part in changed.split(":")]
    if len(changes) > CHANGES_MAX:
        raise RequestError("robot", f"changes {len(changes)} fields, {CHANGES_MAX} at most")
    pairs = [change for change in changes if len(change) == 2]
    if len(pairs) < len(changes):
        raise RequestError("robot", f"{changed[:80]!r} is no list of changes like scene.table.height_m=0.7")
    return base, tuple((path, value) for path, value in pairs)


def varied(card: CardFile, changes: Changes) -> CardFile:
    """Return a card with some fields changed.

    Raises:
        RequestError: the card has no such field, the value is no JSON, or the card is not valid with it.
    """
    if not changes:
        return card
    data = card.to_dict()
    for path, value in changes:
        if path in _FIXED:
            raise RequestError("robot", f"{path} is read-only")
        try:
            _put(data, path.split("."), json.loads(value))
        except ValueError:
            raise RequestError("robot", f"{path}={value[:40]} is no JSON value") from None
        except (KeyError, IndexError, TypeError):
            raise RequestError("robot", f"the card has no field {path[:80]!r}") from None
    try:
        return CardFile.from_dict(data)
    except RobotError as error:
        raise RequestError("robot", f"{error.field}: {error.message}") from None


def _put(data: Any, path: Sequence[str], value: object) -> None:  # noqa: ANN401
    """Replace the value at a path; raise if there is none."""
    *parents, last = (int(part) if part.isdigit() else part for part in path)
    for part in parents:
        data = data[part]
    if not isinstance(last, int) and last not in data:
        raise KeyError(last)
    data[last] = value
