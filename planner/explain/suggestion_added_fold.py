"""Suggest one more fold before a fold that is too large for the hands.

A fold that needs more hands than there are, or lifts cloth higher than arms reach, often becomes possible in two parts:

- **split**: the far part of what moves is folded over first, along a line parallel to the fold's own. What is left to
  move is narrower and thicker, and ends in a straight crease, of which only the corners must be held.
- **halve**: the whole cloth is folded in half across the fold's own line first, so that the fold moves half the width.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from planner.cloth.garment import FOLDS_MAX, DrawnFold, Garment
from planner.errors import FieldError
from planner.explain.suggestion_fold_line import redrawn
from planner.explain.suggestion_trial import Search, SuggestionTrial, each_cheaper
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.pose import FloatArray
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M
from planner.task.task import Task
from planner.words.catalogue import worded

THINNEST_M = 0.04
"""Least width of either part of a fold that is split; narrower strips are not worth a fold of their own (m)."""

_SHARES = (0.5, 0.35, 0.65)
"""Shares of the moving part's depth at which a fold is split, besides the corners of the part."""

_CORNERS_MAX = 6
"""Corners of a moving part through which a fold is split."""


def splits(task: Task, folds: Sequence[int]) -> Search:
    """Look for one of some folds that can be done in two parts, the evenest parts first; then for cheaper ones."""
    return each_cheaper(_split_trials(task, folds))


def halvings(task: Task, folds: Sequence[int]) -> Search:
    """Look for one of some folds that can be done once the cloth is halved across its line; then for cheaper ones."""
    return each_cheaper(_halving_trials(task, folds))


def _split_trials(task: Task, folds: Sequence[int]) -> Iterator[SuggestionTrial]:
    sequence = FoldSequence.of(task.garment)
    for fold in folds:
        drawn, line = task.garment.folds[fold], sequence.folds[fold].line
        if drawn.is_red:
            continue
        left = np.array(line.left)
        distances = line.left_distances(sequence.moving(fold).coordinates)
        deep_m = float(distances.max())
        for depth_m in _depths(distances, deep_m):
            dx, dy = depth_m * left
            (x0, y0), (x1, y1) = line.start, line.end
            garment = with_fold_before(task.garment, fold, Segment((x0 + dx, y0 + dy), (x1 + dx, y1 + dy)))
            if garment is not None:
                says = worded("split_fold", {"fold": fold, "depth_m": deep_m - depth_m}, task.garment.folds)
                yield SuggestionTrial(
                    "split", says, {"garment": garment.to_dict()}, 1.0, replace(task, garment=garment)
                )


def _depths(distances: FloatArray, deep_m: float) -> list[float]:
    """Return the distances from a fold's line at which to split it (m), the evenest first.

    Lines through corners of the moving part can take two corners that must be held off the far side at once.
    """
    corners = sorted({round(float(d), 3) for d in distances}, key=lambda d: abs(d - deep_m / 2))
    wanted = [share * deep_m for share in _SHARES] + corners[:_CORNERS_MAX]
    found: list[float] = []
    for depth_m in wanted:
        is_new = all(abs(depth_m - known) > THINNEST_M / 2 for known in found)
        if is_new and THINNEST_M <= depth_m <= deep_m - THINNEST_M:
            found.append(depth_m)
    return found


def _halving_trials(task: Task, folds: Sequence[int]) -> Iterator[SuggestionTrial]:
    sequence = FoldSequence.of(task.garment)
    for fold in folds:
        drawn, line = task.garment.folds[fold], sequence.folds[fold].line
        if drawn.is_red:
            continue
        silhouette = sequence.cloth((1 << fold) - 1).silhouette.coordinates
        along = line.positions(silhouette)
        x, y = line.at(float(along.min() + along.max()) / 2)
        reach_m = float(np.abs(line.left_distances(silhouette)).max()) + LENGTH_M
        left = reach_m * np.array(line.left)
        for sign in (1, -1):
            dx, dy = sign * left
            garment = with_fold_before(task.garment, fold, Segment((x - dx, y - dy), (x + dx, y + dy)))
            if garment is not None:
                says = worded("halve_first", {"fold": fold}, task.garment.folds)
                yield SuggestionTrial(
                    "halve", says, {"garment": garment.to_dict()}, 1.0, replace(task, garment=garment)
                )


def with_fold_before(garment: Garment, fold: int, line: Segment) -> Garment | None:
    """Return the garment with one more blue fold before another; None where that, or a later fold, is not legal.

    The new fold has no name. Later folds keep their lines; where an end no longer meets the edge of the cloth it moves
    along the line to the edge.
    """
    if len(garment.folds) >= FOLDS_MAX:
        return None
    added = DrawnFold("", "blue", line.start, line.end, garment.folds[fold].grip_radius_m)
    try:
        changed = replace(garment, folds=(*garment.folds[:fold], added, *garment.folds[fold:]))
    except FieldError:
        return None
    return redrawn(changed, fold, line)
