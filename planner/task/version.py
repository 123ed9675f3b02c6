"""Versions of JSON forms: older ones are read, a newer one is refused by its number."""

from collections.abc import Mapping, Set
from typing import Any

from planner.errors import RequestError


def require_version(data: Mapping[str, Any], key: str, newest: int, fields: Set[str]) -> None:
    """Raise `RequestError` unless JSON is an object of a known version with exactly the version's field and these.

    Args:
        data: the object.
        key: the field of the version.
        newest: the newest known version.
        fields: the names of its other fields.
    """
    if not isinstance(data, Mapping):
        raise RequestError("", "is not a JSON object")
    version = data.get(key)
    if not isinstance(version, int) or isinstance(version, bool) or version < 1:
        raise RequestError(key, "is missing" if version is None else f"{version!r} is no version")
    if version > newest:
        raise RequestError(key, f"is {version}, newer than {newest}, the newest that this program reads")
    for name in data:
        if name != key and name not in fields:
            raise RequestError(str(name), "is not a known field")
    for name in sorted(fields):
        if name not in data:
            raise RequestError(name, "is missing")
