"""A garment of a study, with its source."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from planner.cloth.garment import Garment


@dataclass(frozen=True, slots=True)
class GarmentCase:
    """A garment as one value of a study's garment axis.

    Attributes:
        label: its name in the table, unique in the study.
        garment: the garment; None where its measures do not fit each other.
        seed: the seed of a random garment.
        measures: the measures that its template was given (m).
        error: why there is no garment.
    """

    label: str
    garment: Garment | None
    seed: int | None = None
    measures: Mapping[str, float] = field(default_factory=dict)
    error: str | None = None

    def to_dict(self) -> dict[str, Any]:
        """Return the case as JSON."""
        return {
            "label": self.label,
            "garment": None if self.garment is None else self.garment.to_dict(),
            "seed": self.seed,
            "measures": dict(self.measures),
            "error": self.error,
        }

    @staticmethod
    def from_dict(data: Mapping[str, Any]) -> "GarmentCase":
        """Return the case that `to_dict` wrote."""
        drawn = data["garment"]
        garment = None if drawn is None else Garment.from_dict(drawn)
        return GarmentCase(data["label"], garment, data["seed"], data["measures"], data["error"])
