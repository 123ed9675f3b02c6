"""Measures: the few numbers that make a garment of a template."""

from collections.abc import Mapping
from dataclasses import dataclass

from planner.errors import FieldError


class MeasureError(FieldError):
    """A measure that is out of range, or does not go with another; the field is its name."""


@dataclass(frozen=True, slots=True)
class Measure:
    """One number that a template asks for.

    Attributes:
        name: what it is called in a request.
        label: what people call it.
        text: from where to where it is taken.
        default_m: what it is unless somebody says otherwise (m).
        min_m: the least that it may be (m).
        max_m: the most (m).
    """

    name: str
    label: str
    text: str
    default_m: float
    min_m: float
    max_m: float

    def require(self, value_m: float) -> None:
        """Refuse a value out of range; raises `MeasureError`."""
        if not self.min_m <= value_m <= self.max_m:
            message = f"{self.label.lower()} is {value_m:g} m, not between {self.min_m:g} and {self.max_m:g} m"
            raise MeasureError(self.name, message)


class Measures:
    """All the measures of one garment."""

    def __init__(self, asked: tuple[Measure, ...], given: Mapping[str, float]) -> None:
        """What was given, and the defaults of the rest.

        Raises:
            MeasureError: something is out of range, or was not asked for.
        """
        unknown = next((name for name in given if name not in {measure.name for measure in asked}), None)
        if unknown is not None:
            raise MeasureError(unknown, "is not a measure of this template")
        self._labels = {measure.name: measure.label.lower() for measure in asked}
        self._values = {measure.name: given.get(measure.name, measure.default_m) for measure in asked}
        for measure in asked:
            measure.require(self._values[measure.name])

    def __getitem__(self, name: str) -> float:
        """One of them (m)."""
        return self._values[name]

    def require_less(self, name: str, than: float, what: str) -> None:
        """Refuse a measure that is not less than something else (m); raises `MeasureError`."""
        if self._values[name] >= than:
            message = f"{self._labels[name]} ({self._values[name]:g} m) must be less than {what} ({than:g} m)"
            raise MeasureError(name, message)

    def require_at_least(self, name: str, least: float, what: str) -> None:
        """Refuse a measure that is less than something else (m); raises `MeasureError`."""
        if self._values[name] < least:
            message = f"{self._labels[name]} ({self._values[name]:g} m) must be at least {what} ({least:.4g} m)"
            raise MeasureError(name, message)
