"""Suggest to shift the line of a fold that cannot be done, across its own direction, as little as possible."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from planner.cloth.fold_kinds import FOLD_KINDS
from planner.cloth.garment import DrawnFold, Garment
from planner.errors import FieldError
from planner.explain.suggestion_trial import Proof, Search, SuggestionTrial, narrowed
from planner.folds.fold import snapped_line
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.message import Message
from planner.task.task import Task
from planner.words.catalogue import worded

STEPS_M = (0.1, 0.2)
"""Shifts of a line that are tried first (m)."""

NARROWED_TO_M = 0.0125
"""The resolution of the least shift (m)."""

_FAR_M = 20.0
"""Length by which a line is extended to cross any cloth (m)."""

_DECIMALS = 5
"""Decimals to which the ends of a line are rounded (m)."""


def fold_lines(task: Task, folds: Sequence[int]) -> Search:
    """Look for the smallest shift of some folds, each alone and then all, first to the side where less cloth moves."""
    each = [_Shift(task, (fold,), sign) for fold in folds for sign in (1, -1)]
    sides = each + ([_Shift(task, tuple(folds), sign) for sign in (1, -1)] if len(folds) > 1 else [])
    for before_m, shift_m in zip((0.0, *STEPS_M), STEPS_M, strict=False):
        for side in tuple(sides):
            trial = side.shifted(shift_m)
            if trial is None:
                continue
            plan = yield trial
            if plan is None:
                return
            proof = Proof.of(trial, plan)
            if proof is not None:
                sides.remove(side)
                yield from narrowed(side.shifted, before_m, shift_m, proof, NARROWED_TO_M)


@dataclass(frozen=True, slots=True)
class _Shift:
    """Folds, and the side to which their lines may be shifted: 1 is left of each, where less moves; -1 right."""

    task: Task
    folds: tuple[int, ...]
    sign: int

    def shifted(self, by_m: float) -> SuggestionTrial | None:
        """Return the trial of shifting all their lines by a distance (m); None where it is not legal."""
        garment: Garment | None = self.task.garment
        says = []
        for fold in self.folds:
            if garment is None:
                return None
            says.append(self._said(fold, by_m))
            garment = redrawn(garment, fold, self._moved(garment.folds[fold], by_m))
        if garment is None:
            return None
        change = {"garment": garment.to_dict()}
        shifts = [one.to_dict() for one in says]
        both = says[0] if len(says) == 1 else worded("shift_folds", {"shifts": shifts}, self.task.garment.folds)
        return SuggestionTrial("fold_line", both, change, by_m, replace(self.task, garment=garment))

    def _moved(self, drawn: DrawnFold, by_m: float) -> Segment:
        line = Segment(drawn.start, drawn.end)
        dx, dy = (self.sign * by_m * part for part in line.left)
        (x0, y0), (x1, y1) = line.start, line.end
        return Segment((x0 + dx, y0 + dy), (x1 + dx, y1 + dy))

    def _said(self, fold: int, by_m: float) -> Message:
        """Return the message that says how to shift one of the folds."""
        drawn, placement = self.task.garment.folds[fold], self.task.start.placement
        left = np.array(Segment(drawn.start, drawn.end).left)
        x, y = placement.to_outer(self.sign * left) - placement.to_outer(np.zeros(2))
        values = {"fold": fold, "by_m": by_m, "towards": [float(x), float(y)]}
        return worded("shift_fold", values, self.task.garment.folds)


def redrawn(garment: Garment, fold: int, line: Segment) -> Garment | None:
    """Return the garment with a fold along another line; None if that fold, or a later fold, is then not legal.

    Later folds keep their lines; where an end no longer meets the edge of the cloth it moves along the line to the
    edge.
    """
    folds = garment.folds[:fold]
    try:
        for index in range(fold, len(garment.folds)):
            drawn = garment.folds[index]
            cloth = FoldSequence.of(replace(garment, folds=folds)).final
            silhouette = FOLD_KINDS[drawn.kind].silhouette(cloth)
            if index > fold and _is_snapped(drawn, silhouette):
                folds = (*folds, drawn)
                continue
            ends = chord(silhouette, line if index == fold else Segment(drawn.start, drawn.end))
            if ends is None:
                return None
            folds = (*folds, replace(drawn, start=ends.start, end=ends.end))
        changed = replace(garment, folds=folds)
        FoldSequence.of(changed)
    except FieldError:
        return None
    return changed


def chord(silhouette: Region, line: Segment) -> Segment | None:
    """Return the part of a line within a silhouette that overlaps most with the given segment (m, rounded).

    The line extends beyond the segment.
    """
    whole = Segment(line.at(-_FAR_M), line.at(line.length + _FAR_M))
    best, most_m = None, 0.0
    for ends in silhouette.overlaps_with(whole):
        low, high = sorted(line.positions(np.array(ends)))
        common_m = float(min(high, line.length) - max(low, 0.0))
        if common_m > most_m:
            best, most_m = (float(low), float(high)), common_m
    if best is None:
        return None
    (x0, y0), (x1, y1) = line.at(best[0]), line.at(best[1])
    return Segment((round(x0, _DECIMALS), round(y0, _DECIMALS)), (round(x1, _DECIMALS), round(y1, _DECIMALS)))


def _is_snapped(drawn: DrawnFold, silhouette: Region) -> bool:
    try:
        snapped_line(drawn, silhouette)
    except FieldError:
        return False
    return True
