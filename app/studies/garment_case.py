"""A garment of a study, with its source."""

from collections.abc import Mapping
from dataclasses import dataclass, field

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
