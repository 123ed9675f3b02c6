"""A study: the product of what varies between its cells, or a sample of it. Each cell is a task."""

import hashlib
import json
import math
import random
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from app.studies.axis import Axis, Value
from app.studies.cell import Cell, GarmentCase, cell_of
from app.studies.rehearsed import NOISE_AXIS, StudyRehearsal
from planner.geometry.pose import Pose2
from planner.json_form import STRICT, JsonForm
from planner.task.scene import Scene

VERSION = 1
GARMENT = "garment"
"""The name of the first axis."""


@dataclass(frozen=True, slots=True)
class Sample:
    """A sample of a study's cells, drawn without repetition.

    Attributes:
        cells: their number.
        seed: what they are drawn with.
    """

    cells: int
    seed: int = 0


@dataclass(frozen=True, slots=True)
class Study:
    """A study.

    Attributes:
        title: its title.
        garments: the garments: the first axis.
        axes: the other axes, in the order of the table's columns. The last varies fastest.
        scene: the scene, whose fields the axes replace.
        has_stations: whether the scene's stations are the study's own; otherwise they keep their distance to the table.
        placements: the poses that the axis ``placement`` counts.
        sample: the sample; None for all cells.
        has_comfort_margin: whether the answers tell the comfort margin, which takes further plans.
        rehearsal: how plans are rehearsed; None: not at all.
    """

    __pydantic_config__ = STRICT

    title: str
    garments: tuple[GarmentCase, ...]
    axes: tuple[Axis, ...]
    scene: Scene
    has_stations: bool = False
    placements: tuple[Pose2, ...] = ()
    sample: Sample | None = None
    has_comfort_margin: bool = False
    rehearsal: StudyRehearsal | None = None

    @property
    def all_axes(self) -> tuple[Axis, ...]:
        """The axes, the garments' first."""
        return (Axis(GARMENT, tuple(case.label for case in self.garments), is_ordered=False), *self.axes)

    @property
    def product(self) -> int:
        """The number of all combinations."""
        return len(self.garments) * math.prod(len(axis.values) for axis in self.axes)

    @property
    def count(self) -> int:
        """The number of cells."""
        return self.product if self.sample is None else min(self.sample.cells, self.product)

    def indices(self) -> Sequence[int]:
        """Return the numbers of the cells in the product, ascending."""
        if self.count == self.product or self.sample is None:
            return range(self.product)
        return sorted(random.Random(self.sample.seed).sample(range(self.product), self.count))

    def cells(self, indices: Iterable[int]) -> Iterator[Cell]:
        """Yield cells, each made when it is asked for."""
        return (self.cell(index) for index in indices)

    def cell(self, index: int) -> Cell:
        """Return the cell of a number in the product."""
        digits = self.digits(index)
        values: dict[str, Value] = {
            axis.name: axis.values[digit] for axis, digit in zip(self.axes, digits[1:], strict=True)
        }
        made = cell_of(index, self.garments[digits[0]], values, self.scene, self.placements, self.has_stations)
        rehearsal = None if self.rehearsal is None else self.rehearsal.options(str(values[NOISE_AXIS]))
        return replace(made, has_comfort_margin=self.has_comfort_margin, rehearsal=rehearsal)

    def digits(self, index: int) -> tuple[int, ...]:
        """Return which value of each axis a cell has, the garments' first."""
        digits = []
        for axis in reversed(self.axes):
            index, digit = divmod(index, len(axis.values))
            digits.append(digit)
        return (index, *reversed(digits))

    def to_dict(self) -> dict[str, Any]:
        """Return the study as JSON, all files that it names read in; later options only where they are used."""
        written = {"pleat_study": VERSION, **_FORM.write(self)}
        return {name: value for name, value in written.items() if value or name not in _LATER}

    @staticmethod
    def from_dict(data: Mapping[str, Any]) -> "Study":
        """Return the study that `to_dict` wrote."""
        return _FORM.read({name: value for name, value in data.items() if name != "pleat_study"})

    @property
    def digest(self) -> str:
        """A digest of all on which its cells depend."""
        fields = {name: value for name, value in self.to_dict().items() if name != "title"}
        return hashlib.sha256(json.dumps(fields, sort_keys=True).encode()).hexdigest()


_FORM = JsonForm(Study)
_LATER = frozenset({"has_comfort_margin", "rehearsal"})
