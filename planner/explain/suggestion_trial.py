"""What one kind of suggestion asks to have tried, and what it says of the outcome.

Each kind is a generator, its *search*: it yields trials, is sent the plan of each, and yields a suggestion when it has
found one. So a search reads as if it had all the time in the world, while somebody else shares out the time among
the kinds. Sent None instead of a plan, there is no more time: it may tell what it still has, and returns.
"""

from collections.abc import Callable, Generator, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeAlias

from planner.explain.suggestion import Suggestion
from planner.message import Message
from planner.task.plan import Plan
from planner.task.task import Task

WORTH_TELLING_S = 1.0
"""A second suggestion of a kind, or one where there is a plan already, saves at least this much (s)."""


@dataclass(frozen=True, slots=True)
class Trial:
    """A change that may help.

    Attributes:
        kind: the kind of suggestion that it would be.
        says: what to do.
        change: the fields of the request that change.
        size: how big the change is.
        task: the task with the change.
    """

    kind: str
    says: Message
    change: Mapping[str, Any]
    size: float
    task: Task


class Proof(NamedTuple):
    """A trial that succeeded, its plan, and what that costs (s)."""

    trial: Trial
    plan: Plan
    cost_s: float

    @staticmethod
    def of(trial: Trial, plan: Plan | None) -> "Proof | None":
        """The trial as a proof, if its plan is solved."""
        return None if plan is None or plan.cost_s is None else Proof(trial, plan, plan.cost_s)

    @property
    def suggestion(self) -> Suggestion:
        """The proven trial as a suggestion."""
        return Suggestion(self.trial.kind, self.trial.says, self.trial.change, self.trial.size, self.plan, self.cost_s)

    def is_worth_more_than(self, cost_s: float) -> bool:
        """Whether it is so much cheaper that it should be told as well."""
        return self.cost_s < cost_s - WORTH_TELLING_S


Search: TypeAlias = Generator[Trial | Suggestion, Plan | None, None]
Narrowing: TypeAlias = Generator[Trial | Suggestion, Plan | None, Proof]


def narrowed(
    trial_at: Callable[[float], Trial | None], fails_at: float, works_at: float, proof: Proof, step: float
) -> Narrowing:
    """Tell a change that works; then look for a smaller one, halving between it and one that fails, and tell that.

    Args:
        trial_at: the trial of a change of some amount; None where there is none, which counts as failing.
        fails_at: an amount that does not work.
        works_at: an amount that does.
        proof: that it does.
        step: how exact the result is to be; amounts between are `fails_at` and whole multiples of it.

    Returns:
        The proof of the smallest amount that was seen to work.
    """
    yield proof.suggestion
    first = proof
    low, high = 0, round((works_at - fails_at) / step)
    while high - low > 1:
        middle = (low + high) // 2
        trial = trial_at(fails_at + middle * step)
        better = None if trial is None else Proof.of(trial, (yield trial))
        low, high, proof = (middle, high, proof) if better is None else (low, middle, better)
    if proof is not first:
        yield proof.suggestion
    return proof
