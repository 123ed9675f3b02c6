"""The findings of a study: counts of its answers over its axes, for the report.

All answers are held as three arrays: which value of each varied axis a cell has, its status, its cost.
"""

import math
from array import array
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from app.studies.answer import FAILED, INFEASIBLE, OUT_OF_BUDGET, SOLVED
from app.studies.axis import Axis
from app.studies.rehearsed import RUNS_HELD
from app.studies.results import Results
from app.studies.study import Study
from planner.geometry.pose import BoolArray, FloatArray

STATUSES = (SOLVED, INFEASIBLE, OUT_OF_BUDGET, FAILED)
_NOT_REHEARSED = -1
_IS_KNOWN = 2
"""The first statuses, solved and infeasible, are answers; beyond them nothing is known."""


@dataclass(frozen=True, slots=True)
class Tally:
    """Counts over one axis or several.

    Attributes:
        solved: the number of cells solved, by the axes' values.
        cells: the number of cells.
        cost_s: the mean cost of those solved (s); not a number where there is none.
    """

    solved: NDArray[np.int64]
    cells: NDArray[np.int64]
    cost_s: FloatArray


@dataclass(frozen=True, slots=True)
class Flip:
    """Two cells that differ by one step on one axis, one solved and one with no plan.

    Attributes:
        axis: the axis' number.
        low: the number of the lower of the two values.
        solved: the cell that is solved.
        unsolved: the cell that has no plan.
    """

    axis: int
    low: int
    solved: int
    unsolved: int


class Findings:
    """The answers of a study.

    Attributes:
        study: the study.
        axes: its axes with more than one value, the garments' always first.
        cells: the numbers of the cells that have answers, ascending, shape (n,).
        status: their statuses as indices into `STATUSES`, shape (n,).
        cost_s: their costs (s), not a number unless solved, shape (n,).
        held: how many of their rehearsed runs held, -1 where there were none, shape (n,).
        reasons: how many cells each reason code is given for, the most frequent first.
    """

    def __init__(self, study: Study, results: Results) -> None:
        """Read the answers."""
        self.study = study
        every = study.all_axes
        self._kept = [n for n, axis in enumerate(every) if n == 0 or len(axis.values) > 1]
        self.axes: Sequence[Axis] = [every[n] for n in self._kept]
        cells, status, cost_s, held = array("q"), array("b"), array("d"), array("q")
        reasons: Counter[str] = Counter()
        for cell, row, _ in results.rows():
            cells.append(cell)
            status.append(STATUSES.index(row["status"]))
            cost_s.append(math.nan if row["cost_s"] is None else row["cost_s"])
            held.append(row.get(RUNS_HELD, _NOT_REHEARSED))
            reasons.update((row["reason_codes"] or "").split())
        self.cells: NDArray[np.int64] = np.array(cells)
        self.status: NDArray[np.int8] = np.array(status)
        self.cost_s: FloatArray = np.array(cost_s)
        self.held: NDArray[np.int64] = np.array(held)
        self.reasons: Sequence[tuple[str, int]] = sorted(reasons.items(), key=lambda pair: (-pair[1], pair[0]))

    @cached_property
    def is_solved(self) -> BoolArray:
        """Which cells are solved, shape (n,)."""
        return np.asarray(self.status == STATUSES.index(SOLVED))

    @cached_property
    def digits(self) -> NDArray[np.int64]:
        """Which value of each of `axes` the cells have, shape (axes, n)."""
        lengths = [len(axis.values) for axis in self.study.all_axes]
        unravelled = np.unravel_index(self.cells, lengths)
        return np.array([unravelled[n] for n in self._kept])

    @property
    def counts(self) -> Sequence[int]:
        """How many cells have each of `STATUSES`."""
        return [int(count) for count in np.bincount(self.status, minlength=len(STATUSES))]

    def tally(self, *axes: int) -> Tally:
        """Return the counts over some axes, all cells of the others together."""
        shape = tuple(len(self.axes[n].values) for n in axes)
        flat = np.ravel_multi_index(tuple(self.digits[list(axes)]), shape)
        size = int(np.prod(shape))
        cells = np.bincount(flat, minlength=size)
        solved = np.bincount(flat[self.is_solved], minlength=size)
        total_s = np.bincount(flat[self.is_solved], self.cost_s[self.is_solved], minlength=size)
        cost_s = np.divide(total_s, solved, out=np.full(size, np.nan), where=solved > 0)
        return Tally(solved.reshape(shape), cells.reshape(shape), cost_s.reshape(shape))

    def held_by(self, *axes: int) -> Tally:
        """Count the rehearsed runs that held, over some axes, as `tally` counts cells; without costs."""
        shape = tuple(len(self.axes[n].values) for n in axes)
        flat = np.ravel_multi_index(tuple(self.digits[list(axes)]), shape)
        is_rehearsed = self.held != _NOT_REHEARSED
        each = 0 if self.study.rehearsal is None else self.study.rehearsal.runs
        runs, held = np.zeros(int(np.prod(shape)), np.int64), np.zeros(int(np.prod(shape)), np.int64)
        np.add.at(runs, flat[is_rehearsed], each)
        np.add.at(held, flat[is_rehearsed], self.held[is_rehearsed])
        return Tally(held.reshape(shape), runs.reshape(shape), np.full(shape, np.nan))

    def pairs(self, most: int) -> Iterator[tuple[int, int]]:
        """Yield the pairs of axes, garments left out, whose product has at most some number of fields."""
        for one, other in combinations(range(1, len(self.axes)), 2):
            if len(self.axes[one].values) * len(self.axes[other].values) <= most:
                yield one, other

    def best(self, most: int) -> Sequence[tuple[int, int, int, float]]:
        """Return the combinations of values that fold the most garments; among equals the quickest first.

        Returns:
            Tuples of a cell that has the combination, garments folded, garments asked for, mean cost (s).
        """
        others = self.study.product // len(self.study.garments)
        combination, first, inverse = np.unique(self.cells % others, return_index=True, return_inverse=True)
        solved = np.bincount(inverse[self.is_solved], minlength=len(combination))
        asked = np.bincount(inverse, minlength=len(combination))
        total_s = np.bincount(inverse[self.is_solved], self.cost_s[self.is_solved], minlength=len(combination))
        cost_s = np.divide(total_s, solved, out=np.full(len(combination), np.inf), where=solved > 0)
        order = np.lexsort((combination, cost_s, -solved))[:most]
        return [(int(self.cells[first[n]]), int(solved[n]), int(asked[n]), float(cost_s[n])) for n in order]

    @cached_property
    def flips(self) -> Sequence[Flip]:
        """All flips between neighbours that are in the study, axis by axis."""
        lengths = [len(axis.values) for axis in self.study.all_axes]
        found = []
        for number, kept in enumerate(self._kept):
            if not self.axes[number].is_ordered:
                continue
            stride = int(np.prod(lengths[kept + 1 :], dtype=np.int64))
            here = np.flatnonzero(self.digits[number] < lengths[kept] - 1)
            wanted = self.cells[here] + stride
            there = np.searchsorted(self.cells, wanted)
            is_there = there < len(self.cells)
            is_there[is_there] = self.cells[there[is_there]] == wanted[is_there]
            here, there = here[is_there], there[is_there]
            known = (self.status[here] < _IS_KNOWN) & (self.status[there] < _IS_KNOWN)
            for a, b in zip(
                *(side[known & (self.status[here] != self.status[there])] for side in (here, there)), strict=True
            ):
                yes, no = (a, b) if self.is_solved[a] else (b, a)
                found.append(Flip(number, int(self.digits[number][a]), int(self.cells[yes]), int(self.cells[no])))
        return found
