"""Suggest to fold the other side of the cloth at the same line."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

from planner.errors import FieldError
from planner.explain.suggestion_trial import Search, SuggestionTrial, each_cheaper
from planner.folds.fold_sequence import FoldSequence
from planner.task.task import Task
from planner.words.catalogue import worded


def flips(task: Task, folds: Sequence[int]) -> Search:
    """Look for one of some folds whose other part can move instead; the others must be legal on the cloth then."""
    return each_cheaper(_trials(task, folds))


def _trials(task: Task, folds: Sequence[int]) -> Iterator[SuggestionTrial]:
    drawn = task.garment.folds
    for index in folds:
        flipped = replace(drawn[index], start=drawn[index].end, end=drawn[index].start)
        garment = replace(task.garment, folds=(*drawn[:index], flipped, *drawn[index + 1 :]))
        try:
            FoldSequence.of(garment)
        except FieldError:
            continue
        says = worded("flip_fold", {"fold": index}, drawn)
        yield SuggestionTrial("flip", says, {"garment": garment.to_dict()}, 1.0, replace(task, garment=garment))
