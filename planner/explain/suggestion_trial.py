"""The protocol between a kind of suggestion and whoever plans its trials.

Each kind is a generator, its *search*: it yields trials, is sent the plan of each, and yields a suggestion when it has
found one. So a search is written as if it had unlimited time, while the caller shares out the time among the kinds.
When time is up, the caller sends None instead of a plan: the search may yield what it still has, and returns.
"""

import math
from collections.abc import Callable, Generator, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeAlias

from planner.explain.suggestion import Suggestion
from planner.message import Message
from planner.task.plan import Plan
from planner.task.task import Task

AS_QUICK_S = 0.1
"""A plan that takes so much longer is as quick (s)."""

WORTH_TELLING_S = 1.0
"""Least saving of a second suggestion of a kind, or of a suggestion where there is a plan already (s)."""


@dataclass(frozen=True, slots=True)
class SuggestionTrial:
    """A change that may help.

    Attributes:
        kind: the kind of suggestion that it would be.
        says: what to do.
        change: the fields of the request that change.
        size: the size of the change.
        task: the task with the change.
        by_folds_alone: whether drags by the arms are not looked for, which is much less work.
    """

    kind: str
    says: Message
    change: Mapping[str, Any]
    size: float
    task: Task
    by_folds_alone: bool = False


class Proof(NamedTuple):
    """A trial that succeeded, its plan, and the cost of that plan (s)."""

    trial: SuggestionTrial
    plan: Plan
    cost_s: float

    @staticmethod
    def of(trial: SuggestionTrial, plan: Plan | None) -> "Proof | None":
        """Return the trial as a proof, if its plan is solved."""
        return None if plan is None or plan.cost_s is None else Proof(trial, plan, plan.cost_s)

    @property
    def suggestion(self) -> Suggestion:
        """The proven trial as a suggestion."""
        return Suggestion(self.trial.kind, self.trial.says, self.trial.change, self.trial.size, self.plan, self.cost_s)

    def is_worth_more_than(self, cost_s: float) -> bool:
        """Return whether it is so much cheaper that it should be suggested as well."""
        return self.cost_s < cost_s - WORTH_TELLING_S


Search: TypeAlias = Generator[SuggestionTrial | Suggestion, Plan | None, None]
"""The search of one kind of suggestion: yields trials and suggestions, is sent the plans of trials."""

Smallest: TypeAlias = Generator[SuggestionTrial | Suggestion, Plan | None, tuple[float, Proof]]
"""A part of a search that returns the smallest amount of a change that was seen to work, and its proof."""


def each_cheaper(trials: Iterable[SuggestionTrial]) -> Search:
    """Suggest the first trial that gives a plan; then each that gives a cheaper one."""
    to_beat = None
    for trial in trials:
        plan = yield trial
        if plan is None:
            return
        proof = Proof.of(trial, plan)
        if proof is not None and (to_beat is None or proof.is_worth_more_than(to_beat)):
            yield proof.suggestion
            to_beat = proof.cost_s


def narrowed(
    trial_at: Callable[[float], SuggestionTrial | None], fails_at: float, works_at: float, proof: Proof, step: float
) -> Search:
    """Suggest the smallest change that gives a plan; then, where it is slower, the smallest with a plan as quick.

    Args:
        trial_at: makes the trial of a change by some amount; None where there is none, which counts as failing.
        fails_at: an amount that does not work.
        works_at: an amount that does.
        proof: the proof that it does.
        step: the resolution of the result; amounts in between are `fails_at` plus whole multiples of it.
    """
    amount, least = yield from smallest(trial_at, fails_at, works_at, proof, step)
    yield least.suggestion
    if proof.is_worth_more_than(least.cost_s):
        _, quick = yield from smallest(trial_at, amount, works_at, proof, step, proof.cost_s + AS_QUICK_S)
        yield quick.suggestion


def smallest(
    trial_at: Callable[[float], SuggestionTrial | None],
    fails_at: float,
    works_at: float,
    proof: Proof,
    step: float,
    most_s: float = math.inf,
) -> Smallest:
    """Look for the smallest change with a plan that costs at most `most_s` (s), by bisection; arguments as above."""
    low, high = 0, round((works_at - fails_at) / step)
    found = works_at, proof
    while high - low > 1:
        middle = (low + high) // 2
        trial = trial_at(fails_at + middle * step)
        better = None if trial is None else Proof.of(trial, (yield trial))
        if better is None or better.cost_s > most_s:
            low = middle
        else:
            high, found = middle, (fails_at + middle * step, better)
    return found
