"""An axis of a study: one quantity, and the values it takes."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from app.studies.fields import StudyError

AXIS_MAX = 100_000
"""The most values of one axis."""

_DIGITS = 9
"""Decimals of the values of a range, so that 0.6 + 0.1 is 0.7."""

Value = float | int | str


@dataclass(frozen=True, slots=True)
class Axis:
    """A quantity that a study varies.

    Attributes:
        name: its name in the file, and its column in the table.
        values: its values in order, at least one, no two equal.
        is_ordered: whether neighbouring values are near each other: numbers, not names.
    """

    name: str
    values: tuple[Value, ...]
    is_ordered: bool = True

    def __post_init__(self) -> None:
        """Check the values; raises `StudyError`."""
        if not 1 <= len(self.values) <= AXIS_MAX:
            raise StudyError(self.name, f"has {len(self.values)} values, not 1 to {AXIS_MAX}")
        if len(set(self.values)) < len(self.values):
            again = next(value for n, value in enumerate(self.values) if value in self.values[:n])
            raise StudyError(self.name, f"{again!r} is given twice")


def number_axis(name: str, given: object, *, whole: bool = False) -> Axis:
    """Return the axis of a number, a list of numbers or a range.

    Args:
        name: the field.
        given: a number; a list; or ``{from, to, step}`` or ``{from, to, count}``, both ends included.
        whole: whether only whole numbers are valid.

    Raises:
        StudyError: it is none of these.
    """
    if isinstance(given, Mapping):
        found = _range(name, given)
    elif isinstance(given, list):
        found = [_number(f"{name}[{n}]", value) for n, value in enumerate(given)]
    else:
        found = [_number(name, given)]
    if whole:
        for number in found:
            if number != int(number):
                raise StudyError(name, f"{number} is not a whole number")
        return Axis(name, tuple(int(number) for number in found))
    return Axis(name, tuple(float(number) for number in found))


def _number(field: str, given: object) -> float:
    if isinstance(given, bool) or not isinstance(given, int | float) or not math.isfinite(given):
        raise StudyError(field, f"{given!r} is no number, list of numbers or range")
    return given


def _range(name: str, given: Mapping[str, Any]) -> list[float]:
    unknown = next((field for field in given if field not in ("from", "to", "step", "count")), None)
    if unknown is not None:
        raise StudyError(f"{name}.{unknown}", "is not a known field; a range has from, to, and step or count")
    if not {"from", "to"} <= given.keys() or ("step" in given) == ("count" in given):
        raise StudyError(name, "a range has from, to, and either step or count")
    low, high = (_number(f"{name}.{end}", given[end]) for end in ("from", "to"))
    if "count" in given:
        count = given["count"]
        if isinstance(count, bool) or not isinstance(count, int) or not 1 <= count <= AXIS_MAX:
            raise StudyError(f"{name}.count", f"{count!r} is not a whole number from 1 to {AXIS_MAX}")
        step = (high - low) / max(count - 1, 1)
    else:
        step = _number(f"{name}.step", given["step"])
        steps = (high - low) / step if step else -1.0
        if not 0 <= steps < AXIS_MAX:
            raise StudyError(f"{name}.step", f"{step:g} does not lead from {low:g} to {high:g} in {AXIS_MAX} steps")
        count = math.floor(steps + 1e-6) + 1
    return [round(low + n * step, _DIGITS) for n in range(count)]
