"""Suggest a smaller garment of the same shape, where nothing else helps: the largest that can be folded.

A cloth that is too large for the arms, or has more rim than the hands can hold, is no dead end: people want to know how
large it may be. The garment keeps its edge nearest to the robot's side of the table, where arms reach best.
"""

from dataclasses import replace

import numpy as np

from planner.cloth.garment import Garment
from planner.errors import FieldError
from planner.explain.suggestion_trial import Proof, Search, SuggestionTrial, narrowed
from planner.geometry.pose import Point2, Pose2
from planner.task.task import Task
from planner.words.catalogue import worded

SHARES = (0.8, 0.6, 0.4, 0.25)
"""The sizes that are tried first, as shares of the garment's own."""

STEP = 0.05
"""The resolution of the share."""


def sizes(task: Task) -> Search:
    """Look for a size with which there is a plan, and then for the largest one."""
    if task.start.folds_done:
        return
    too_large = 1.0
    for share in SHARES:
        trial = _trial(task, share)
        plan = None
        if trial is not None:
            plan = yield trial
            if plan is None:
                return
        proof = None if trial is None else Proof.of(trial, plan)
        if proof is not None:
            yield from narrowed(lambda by: _trial(task, 1.0 - by), 1.0 - too_large, 1.0 - share, proof, STEP)
            return
        too_large = share


def _trial(task: Task, share: float) -> SuggestionTrial | None:
    """Return the trial with all lengths of the garment multiplied by a share; None where that is no garment."""
    try:
        garment = _scaled(task.garment, share)
    except FieldError:
        return None
    placement = _kept_near(task, garment)
    width, height = np.ptp(np.array(garment.outline), axis=0).tolist()
    says = worded("smaller", {"by": round(1.0 - share, 6), "size_m": [width, height]})
    change = {"garment": garment.to_dict(), "placement": placement.to_dict()}
    return SuggestionTrial("size", says, change, 1.0 - share, replace(task, garment=garment).at(placement))


def _scaled(garment: Garment, share: float) -> Garment:
    def point(at: Point2) -> Point2:
        return (share * at[0], share * at[1])

    folds = tuple(replace(fold, start=point(fold.start), end=point(fold.end)) for fold in garment.folds)
    return replace(garment, outline=tuple(point(at) for at in garment.outline), folds=folds)


def _kept_near(task: Task, garment: Garment) -> Pose2:
    """Return the placement with which a garment has its near side, and the middle of it, where the task's has them."""
    before = task.start.placement
    old, new = (before.to_outer(np.array(one.outline)) for one in (task.garment, garment))
    dx = old[:, 0].min() - new[:, 0].min()
    dy = (old[:, 1].min() + old[:, 1].max() - new[:, 1].min() - new[:, 1].max()) / 2
    return before.moved(float(dx), float(dy))
