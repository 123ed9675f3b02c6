"""Conditions between the fields of an object, as parts of its JSON schema: which must be given, and which left out.

A field that is null counts as left out.
"""

from typing import Any


def gives(**types: str) -> dict[str, Any]:
    """Return the schema of objects that have these fields, each of a JSON type and not null."""
    return {"properties": {name: {"type": kind} for name, kind in types.items()}, "required": list(types)}


def leaves_out(*names: str) -> dict[str, Any]:
    """Return the schema of objects in which these fields are null or left out."""
    return {"properties": {name: {"type": "null"} for name in names}}


def either(*conditions: dict[str, Any]) -> dict[str, Any]:
    """Return what to add to the schema of an object of which at least one condition has to hold."""
    return {"anyOf": list(conditions)}
