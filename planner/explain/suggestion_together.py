"""Suggest assumptions that give a plan only together, where none of them alone does.

All are assumed to the utmost first: friction and comfort only ever allow more the further they go, and wider grips hold
more. If that gives a plan, those that are not needed are dropped, and of each that is left the least is found by
bisection while the others stay.
"""

from collections.abc import Generator, Mapping, Sequence
from typing import Any, TypeAlias

from planner.explain.suggestion_assumption import assumptions
from planner.explain.suggestion_trial import Proof, Search, SuggestionTrial
from planner.task.plan import Plan
from planner.task.task import Task
from planner.words.catalogue import worded

TOGETHER = "together"
"""The kind of these suggestions."""

_Steps: TypeAlias = Mapping[int, int]
"""How far each lever is pulled, by its index."""


def together(task: Task, folds: Sequence[int]) -> Search:
    """Look for the fewest assumptions, two at least, that give a plan, and the least of each.

    Args:
        task: the task.
        folds: the indices of the folds whose grips may hold more.
    """
    attempt = _Attempt(task, folds)
    steps: _Steps = {
        number: assumption.most
        for number, assumption in enumerate(attempt.assumptions)
        if assumption.most > assumption.now
    }
    best = yield from attempt.proof(steps)
    if best is None:
        return
    for number in tuple(steps):
        rest = {other: step for other, step in steps.items() if other != number}
        proof = (yield from attempt.proof(rest)) if rest else None
        if proof is not None:
            steps, best = rest, proof
    if len(steps) < 2:
        return  # one alone is suggested by itself
    for number, most in tuple(steps.items()):
        fails, works = attempt.assumptions[number].now, most
        while works - fails > 1:
            middle = (fails + works) // 2
            proof = yield from attempt.proof({**steps, number: middle})
            if proof is None:
                fails = middle
            else:
                works, best = middle, proof
        steps = {**steps, number: works}
    yield best.suggestion


class _Attempt:
    """Trials of several assumptions at once."""

    def __init__(self, task: Task, folds: Sequence[int]) -> None:
        self._task = task
        self.assumptions = assumptions(task, folds)

    def proof(self, steps: _Steps) -> Generator[SuggestionTrial, Plan | None, Proof | None]:
        """Try assumptions; return the proof that they give a plan, or None."""
        trial = self._trial(steps)
        return Proof.of(trial, (yield trial))

    def _trial(self, steps: _Steps) -> SuggestionTrial:
        task, parts, size = self._task, [], 0.0
        change: dict[str, Any] = {}
        for number, step in steps.items():
            assumption = self.assumptions[number]
            part = assumption.trial_at(task, step)
            task = part.task
            parts.append(part.says)
            change |= part.change
            size += (step - assumption.now) / (assumption.most - assumption.now)
        says = worded("assume_together", {"parts": [part.to_dict() for part in parts]}, self._task.garment.folds)
        return SuggestionTrial(TOGETHER, says, change, size, task)
