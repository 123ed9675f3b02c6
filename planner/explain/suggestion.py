"""Suggestions: changes to the request, each with the plan that it makes possible, and how they are looked for.

Each kind of change is a generator, its *search*: it yields trials, is sent the plan of each, and yields a suggestion
when it has found one. So a search is written as if it had unlimited time, while the caller shares out the time among
the kinds. When time is up, the caller throws `SpentError` into it: a search that catches it yields what it still has.
"""

import math
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import wraps
from typing import Any, ParamSpec, TypeAlias, TypeVar

from planner.errors import FoldingError
from planner.explain.change import Bisection, Change, SpentError, request_fields
from planner.explain.reasons import reasons_met
from planner.message import Message
from planner.planning.budget import Budget
from planner.planning.events import Blocked
from planner.planning.plan_search import Hints, quickest
from planner.planning.problem import Problem
from planner.task.plan import Plan
from planner.task.reason import Reason
from planner.task.task import Task

P = ParamSpec("P")

ASSUMPTIONS = frozenset({"friction", "grip_radius", "comfort_radius", "together"})
"""Kinds of suggestions that nobody can carry out: they hold only if the world is kinder than assumed."""

AS_QUICK_S = 0.1
"""A plan that takes so much longer is as quick (s)."""

WORTH_TELLING_S = 1.0
"""Least saving of a second suggestion of a kind, or of a suggestion where there is a plan already (s)."""


@dataclass(frozen=True, slots=True)
class SuggestionTrial:
    """A change that may help, made.

    Attributes:
        kind: the kind of suggestion that it would be: "placement", "fold_line", "split", "halve", "flip", "order",
            "station", "robot", "size", "friction", "grip_radius", "comfort_radius" or "together", several of the last
            three.
        says: what to do.
        size: the size of the change.
        before: the task without the change.
        task: the task with the change.
        by_folds_alone: whether drags by the arms are not looked for, which is much less work.
    """

    kind: str
    says: Message
    size: float
    before: Task
    task: Task
    by_folds_alone: bool = False

    @property
    def change(self) -> dict[str, Any]:
        """The fields of the request that change."""
        return request_fields(self.before, self.task)

    @staticmethod
    def of(change: Change, task: Task, amount: float) -> "SuggestionTrial | None":
        """Return the trial of a task changed by an amount; None where that gives no valid task."""
        try:
            changed = change.applied(task, amount)
        except FoldingError:
            return None
        return SuggestionTrial(change.kind, change.says(task, changed), amount, task, changed)


@dataclass(frozen=True, slots=True)
class Suggestion:
    """A change that gives a plan, or a quicker one.

    Attributes:
        trial: the change.
        plan: the plan that proves it.
        cost_s: the cost of that plan (s).
    """

    trial: SuggestionTrial
    plan: Plan
    cost_s: float

    @property
    def kind(self) -> str:
        """The kind of change."""
        return self.trial.kind

    @property
    def says(self) -> Message:
        """What to do, with the numbers; directions as seen by the robot at the near edge of the table."""
        return self.trial.says

    @property
    def change(self) -> dict[str, Any]:
        """The fields that replace those of the plan request."""
        return self.trial.change

    @property
    def size(self) -> float:
        """The size of the change, for comparing within its kind: m, a count, or a coefficient."""
        return self.trial.size

    @property
    def message(self) -> str:
        """The change in words, with the cost of its plan."""
        return f"{self.says.text}: {self.cost_s:.1f} s"

    @property
    def is_assumption(self) -> bool:
        """Whether it assumes something about the world instead of changing it."""
        return self.kind in ASSUMPTIONS

    def is_worth_more_than(self, cost_s: float) -> bool:
        """Return whether it is so much cheaper that it should be suggested as well."""
        return self.cost_s < cost_s - WORTH_TELLING_S

    def to_dict(self) -> dict[str, Any]:
        """Return the suggestion as JSON, without its plan."""
        return {
            "kind": self.kind,
            "is_assumption": self.is_assumption,
            "message": self.message,
            "says": self.says.to_dict(),
            "change": self.change,
            "size": self.size,
            "cost_s": self.cost_s,
        }


Search: TypeAlias = Generator[SuggestionTrial | Suggestion, Plan | None, None]
"""The search of one kind of suggestion: yields trials and suggestions, is sent the plans of trials."""

Proving: TypeAlias = Generator[SuggestionTrial | Suggestion, Plan | None, Suggestion | None]
"""A part of a search that returns a suggestion, or None."""

Smallest: TypeAlias = Generator[SuggestionTrial | Suggestion, Plan | None, tuple[float, Suggestion]]
"""A part of a search that returns the smallest amount of a change that was seen to work, and its suggestion."""


def proven(trial: SuggestionTrial | None) -> Proving:
    """Plan a trial and return the proof that it helps; None if it does not, or cannot be made."""
    plan = None if trial is None else (yield trial)
    return None if trial is None or plan is None or plan.cost_s is None else Suggestion(trial, plan, plan.cost_s)


def each_cheaper(trials: Callable[P, Iterator[SuggestionTrial]]) -> Callable[P, Search]:
    """Make a search of a generator of trials: the first that gives a plan is suggested, then each that is cheaper."""

    @wraps(trials)
    def search(*args: P.args, **named: P.kwargs) -> Search:
        to_beat = None
        for trial in trials(*args, **named):
            proof = yield from proven(trial)
            if proof is not None and (to_beat is None or proof.is_worth_more_than(to_beat)):
                yield proof
                to_beat = proof.cost_s

    return search


def narrowed(
    trial_at: Callable[[float], SuggestionTrial | None],
    fails_at: float,
    works_at: float,
    proof: Suggestion,
    step: float,
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
    yield least
    if proof.is_worth_more_than(least.cost_s):
        _, quick = yield from smallest(trial_at, amount, works_at, proof, step, proof.cost_s + AS_QUICK_S)
        yield quick


def smallest(
    trial_at: Callable[[float], SuggestionTrial | None],
    fails_at: float,
    works_at: float,
    proof: Suggestion,
    step: float,
    most_s: float = math.inf,
    *,
    is_near: bool = False,
) -> Smallest:
    """Look for the smallest change with a plan that costs at most `most_s` (s); arguments as above.

    Where `works_at` was measured, `is_near` has the amount just below it tried first.
    """
    search, found = Bisection(0, round((works_at - fails_at) / step), 1, is_whole=True, is_near=is_near), proof
    with suppress(SpentError):
        while (number := search.amount) is not None:
            better = yield from proven(trial_at(fails_at + number * step))
            is_enough = better is not None and better.cost_s <= most_s
            search.note(number, number if is_enough else None)
            found = better if is_enough and better is not None else found
    return fails_at + search.works * step if found is not proof else works_at, found


T = TypeVar("T")

SHORTEST_TRIAL_S = 1.0
"""Least work of a trial (s, see `Budget`); less would cut off most plans just before they are found."""

_TRIALS_LEFT = 6
"""Trials among which the work left is shared out by default."""

_SETTING_UP_S = 0.01
"""Work counted for preparing a request, which replays the folds (s); the planner counts none of it."""


class TrialBudget:
    """Work and time for a series of trials.

    Attributes:
        spent_s: the work done so far (s).
        has_unknown: whether a trial was cut off before its answer was known.
    """

    def __init__(self, whole: Budget) -> None:
        self._whole = whole
        self.spent_s = 0.0
        self.has_unknown = False

    @property
    def is_late(self) -> bool:
        """Whether the time is up, even if work is left, or the search was stopped."""
        return self._whole.deadline.is_over

    @property
    def is_stopped(self) -> bool:
        """Whether the search was stopped."""
        return self._whole.deadline.is_stopped

    def while_left(self, things: Iterable[T], needed_s: float) -> Iterator[T]:
        """Yield things as long as there is time for one more (s); what is left then counts as unknown."""
        for thing in things:
            if self._whole.left_s < needed_s:
                self.has_unknown = True
                return
            yield thing

    def require_time(self, _share: float = 0.0) -> None:
        """Raise `SpentError` once the time is up; what was begun then counts as unknown.

        Progress can be reported to it (see `planner.robots.reach_maps`): so the building of maps ends in between.
        """
        if self.is_late:
            self.has_unknown = True
            raise SpentError

    def has_spent(self, share: float) -> bool:
        """Return whether this share of the work has been done, or the time is up."""
        return self.spent_s >= share * self._whole.work_limit_s or self.is_late

    def plan(
        self, task: Task, work_s: float | None = None, *, with_reasons: bool = False, by_folds_alone: bool = False
    ) -> Plan:
        """Plan a task with limited work (s), by default a fraction of what is left, and never more than is left.

        Only where reasons are wanted are more ways tried before the answer is that there is no plan. By folds alone,
        drags by the arms are not looked for. A plan holds firmly if there is such a plan, as that of `make_plan` does:
        this is searched second, since most trials have no plan at all.
        """
        self.spent_s += _SETTING_UP_S
        problem = Problem.of(task, self._whole.deadline)
        if by_folds_alone:
            problem = problem.without_arm_drags()
        plan = self._searched(problem, work_s, with_reasons=with_reasons, is_patient=with_reasons)
        if not plan.is_solved:
            return plan
        firm = self._searched(problem.firm(), work_s, with_reasons=False, is_patient=True)
        return firm if firm.is_solved else plan

    def _searched(self, problem: Problem, work_s: float | None, *, with_reasons: bool, is_patient: bool) -> Plan:
        left_s = max(self._whole.work_limit_s - self.spent_s, 0.0)
        wanted_s = max(left_s / _TRIALS_LEFT, SHORTEST_TRIAL_S) if work_s is None else work_s
        part = self._whole.part(min(wanted_s, left_s))
        reasons: tuple[Reason, ...] = ()
        for event in quickest(problem, part, Hints(), is_patient=is_patient):
            plan = event.found.plan
            if with_reasons and isinstance(event, Blocked):
                reasons = reasons_met(event.obstacles)
        self.spent_s += part.spent_s
        self.has_unknown |= plan.status == "budget_exceeded"
        return replace(plan, reasons=reasons)
