"""Strict reading of the plain fields of a study's file."""

import math
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

from planner.errors import FieldError, FoldingError


class StudyError(FieldError):
    """A study that is not valid; names the field of its file."""


class StudyFolderError(FoldingError):
    """A folder whose results cannot be used."""


@contextmanager
def reported_at(field: str) -> Iterator[None]:
    """Report an error of a field, raised within, as the study's, at a field of its file."""
    try:
        yield
    except FieldError as error:
        within = error.within(field)
        raise StudyError(within.field, within.message) from None


def table(field: str, given: object) -> Mapping[str, Any]:
    """Return a table; raise `StudyError` for anything else."""
    if not isinstance(given, Mapping):
        raise StudyError(field, f"{given!r} is no table")
    return given


def require_known(field: str, given: Mapping[str, Any], known: Collection[str]) -> None:
    """Raise `StudyError` for the first field that is not known."""
    for name in given:
        if name not in known:
            raise StudyError(f"{field}.{name}" if field else name, f"is not a known field: {', '.join(sorted(known))}")


def required(field: str, given: Mapping[str, Any], name: str) -> object:
    """Return a field that must be there; raise `StudyError`."""
    if name not in given:
        raise StudyError(f"{field}.{name}", "is missing")
    return given[name]


def text(field: str, given: object) -> str:
    """Return a text that is not empty; raise `StudyError`."""
    if not isinstance(given, str) or not given:
        raise StudyError(field, f"{given!r} is no text")
    return given


def truth(field: str, given: object) -> bool:
    """Return true or false; raise `StudyError`."""
    if not isinstance(given, bool):
        raise StudyError(field, f"{given!r} is neither true nor false")
    return given


def whole(field: str, given: object, low: int, high: int) -> int:
    """Return a whole number within bounds; raise `StudyError`."""
    if isinstance(given, bool) or not isinstance(given, int) or not low <= given <= high:
        raise StudyError(field, f"{given!r} is not a whole number from {low} to {high}")
    return given


def pair(field: str, given: object, low: float, high: float) -> tuple[float, float]:
    """Return the least and the most of something, within bounds; raise `StudyError`."""
    match given:
        case [int() | float() as least, int() | float() as most] if not isinstance(least, bool | None):
            if low <= least <= most <= high and math.isfinite(most):
                return (least, most)
    raise StudyError(field, f"{given!r} is not the least and the most, two numbers from {low:g} to {high:g}")
