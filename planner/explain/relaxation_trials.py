"""Run trials of changes that may remove a cause, within limits."""

from collections.abc import Callable

from planner.errors import FoldingError
from planner.explain.reasons import reasons_met
from planner.explain.relaxation import Relaxation
from planner.explain.relaxed_problem import Ask, RelaxedProblem
from planner.planning.trial import Trial
from planner.task.reason import Reason

ASKS_MAX = 80
"""Trials that are made to find the reasons of one problem."""


class SpentError(Exception):
    """The trials, or the time for them, are used up."""


class Trials:
    """Runs trials within limits; a change that gives no valid problem counts as no help."""

    def __init__(self, ask: Ask, is_enough: Callable[[], bool]) -> None:
        self._ask = ask
        self._is_enough = is_enough
        self._left = ASKS_MAX
        self._known: dict[tuple[Relaxation, RelaxedProblem, float, bool], tuple[RelaxedProblem, Trial] | None] = {}

    def __call__(
        self, relaxation: Relaxation, base: RelaxedProblem, amount: float, folds: int, *, with_arms: bool
    ) -> tuple[RelaxedProblem, Trial] | None:
        """Return a problem with a cause removed and its trial; None where the change gives no valid problem."""
        key = (relaxation, base, amount, with_arms)
        if key not in self._known:
            changed = applied(relaxation, base, amount)
            self._known[key] = None if changed is None else (changed, self.trial(changed, folds, with_arms=with_arms))
        return self._known[key]

    def trial(self, relaxed: RelaxedProblem, folds: int, *, with_arms: bool) -> Trial:
        """Return the trial of a problem; without arms it is enough that all places are in reach."""
        if not self._left or self._is_enough():
            raise SpentError
        self._left -= 1
        return self._ask(relaxed if with_arms else relaxed.with_collisions_ignored(), folds)

    def measured(self, trial: Trial) -> tuple[Reason, ...]:
        """Return the reasons that a trial met."""
        if self._is_enough():
            raise SpentError
        return reasons_met(trial.obstacles)


def applied(relaxation: Relaxation, base: RelaxedProblem, amount: float) -> RelaxedProblem | None:
    """Return a problem with a cause removed; None where the change gives no valid problem."""
    try:
        return relaxation.applied(base, amount)
    except FoldingError:
        return None
