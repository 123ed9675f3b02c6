"""Measures: the few lengths from which a template makes a garment."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from planner.cloth.outline import EDGE_MIN_M
from planner.errors import FieldError
from planner.message import Message
from planner.strict_model import LARGEST_M


class MeasureError(FieldError):
    """A measure is out of range or does not fit another; the field is its name."""


@dataclass(frozen=True, slots=True)
class Measure:
    """A length that a template asks for.

    Attributes:
        name: its name in a request.
        label: its displayed name.
        text: the points between which it is taken.
        default_m: its value by default (m).
        follows: measures to scale with by default, by the smallest of their ratios to their own defaults.
        min_m: its smallest value (m).
        max_m: its largest value (m).
    """

    name: str
    label: str
    text: str
    default_m: float
    follows: tuple[str, ...] = ()
    min_m: float = EDGE_MIN_M
    max_m: float = LARGEST_M

    def require(self, value_m: float) -> None:
        """Raise `MeasureError` if a value is out of range."""
        if not self.min_m <= value_m <= self.max_m:
            text = f"{self.label.lower()} is {value_m:g} m, not between {self.min_m:g} and {self.max_m:g} m"
            values = {"label": self.label.lower(), "value_m": value_m, "least_m": self.min_m, "most_m": self.max_m}
            raise MeasureError(self.name, Message("measure_out_of_range", text, values))


class Measures:
    """All the measures of one garment."""

    def __init__(self, asked: tuple[Measure, ...], given: Mapping[str, float]) -> None:
        """Take the given measures, and scale the others with those they follow.

        Raises:
            MeasureError: something is out of range, or was not asked for.
        """
        self._asked = {measure.name: measure for measure in asked}
        unknown = next((name for name in given if name not in self._asked), None)
        if unknown is not None:
            raise MeasureError(unknown, "is not a measure of this template")
        self._values = {name: self._value(name, given, frozenset()) for name in self._asked}
        for measure in asked:
            measure.require(self._values[measure.name])

    def _value(self, name: str, given: Mapping[str, float], below: frozenset[str]) -> float:
        """Return the value of a measure; it cannot follow those in `below`, which follow it."""
        if name in given:
            return given[name]
        measure = self._asked[name]
        followed = [self._asked[other] for other in measure.follows if other not in below]
        shares = [self._value(other.name, given, below | {name}) / other.default_m for other in followed]
        return measure.default_m * min(shares, default=1.0)

    def __getitem__(self, name: str) -> float:
        """Return a measure's value (m)."""
        return self._values[name]

    def to_dict(self) -> dict[str, float]:
        """Return all measures by name, as JSON (m)."""
        return dict(self._values)

    def require_less(self, name: str, than_m: float, what: str, by_m: float = 0.0) -> None:
        """Raise `MeasureError` if a measure is not less than a limit.

        Args:
            name: the measure.
            than_m: the limit (m).
            what: the limit in words; ``{}`` stands for the length `by_m`.
            by_m: a length that the words mention (m).
        """
        if self._values[name] >= than_m:
            content = self._message("must be less than", name, than_m, what, by_m)
            raise MeasureError(name, Message("measure_not_less", *content))

    def require_at_least(self, name: str, least_m: float, what: str) -> None:
        """Raise `MeasureError` if a measure is less than a limit (m)."""
        if self._values[name] < least_m:
            content = self._message("must be at least", name, least_m, what, 0.0)
            raise MeasureError(name, Message("measure_too_small", *content))

    def _message(self, must: str, name: str, than_m: float, what: str, by_m: float) -> tuple[str, dict[str, Any]]:
        """Return a sentence about a measure, and its values."""
        label, value_m = self._asked[name].label.lower(), self._values[name]
        text = f"{label} ({value_m:g} m) {must} {what.format(f'{by_m:g} m')} ({than_m:.4g} m)"
        return text, {"label": label, "value_m": value_m, "than_m": than_m, "what": what, "by_m": by_m}
