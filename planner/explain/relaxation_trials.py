"""Relaxations: changes that may remove a cause, tried within limits, and reduced to the least that is enough."""

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from planner.errors import FoldingError
from planner.explain.change import (
    COLLISIONS_IGNORED,
    NO_LIBERTIES,
    Bisection,
    Change,
    Liberties,
    SpentError,
    request_fields,
)
from planner.explain.reasons import reasons_met
from planner.planning.problem import Problem
from planner.planning.trial import Trial
from planner.primitives.context import Context
from planner.task.reason import Code, Reason


@dataclass(frozen=True, slots=True, eq=False)
class RelaxedProblem:
    """A planning problem with some causes removed.

    Attributes:
        problem: the problem, with all changes that a request can ask for.
        liberties: the changes that none can ask for.
    """

    problem: Problem
    liberties: Liberties = NO_LIBERTIES

    @property
    def may_collide(self) -> bool:
        """Whether the arms may pass through anything."""
        return self.liberties.may_collide

    @property
    def context(self) -> Context:
        """The planning context."""
        return self.problem.context

    @property
    def searched(self) -> Problem:
        """The problem to search, with nothing computed yet."""
        free = self.liberties
        return self.problem.with_long_arms(free.more_hands) if free.has_long_arms else self.problem.varied()

    def changed(self, change: Change, amount: float = 0.0) -> "RelaxedProblem":
        """Return the problem with a change made by an amount; raise `FoldingError` where that gives no valid task."""
        before, free = self.problem.task, change.frees(self.liberties, amount)
        after, problem = change.applied(before, amount), self.problem
        is_wider = (free.behind_max_m, free.grips_apart_m) != (
            self.liberties.behind_max_m,
            self.liberties.grips_apart_m,
        )
        if after is not before or is_wider:
            problem = problem.varied(
                garment=None if after.garment is before.garment else after.garment,
                scene=None if after.scene is before.scene else after.scene,
                placement=after.start.placement,
                comfort_m=after.limits.comfort_radius_m,
                behind_max_m=free.behind_max_m,
                grips_apart_m=free.grips_apart_m,
            )
        return RelaxedProblem(problem, free)

    def change_from(self, base: "RelaxedProblem") -> Mapping[str, Any] | None:
        """Return the fields of a request that turn another problem into this; None where no request can ask for it."""
        return request_fields(base.problem.task, self.problem.task) if self.liberties == NO_LIBERTIES else None


Ask = Callable[[RelaxedProblem, int], Trial]
"""Tries whether some folds of a relaxed problem, a bit mask, can be done."""


@dataclass(frozen=True, slots=True, eq=False)
class Relaxation:
    """A change that may remove a cause.

    Attributes:
        reason: the cause.
        change: the change.
        amounts: by how much, tried in turn, the last the most permissive; empty where the change has no degree.
        reported: makes the reason to report from the cause, once an amount was tried.
        needed: the amount that the path found really needs, where that is known.
    """

    reason: Reason
    change: Change
    amounts: tuple[float, ...] = ()
    reported: Callable[[Reason, float], Reason] = lambda reason, _: reason
    needed: Callable[[Trial], float] | None = None

    @property
    def kind(self) -> str:
        """What is changed."""
        return self.change.kind

    @property
    def most(self) -> float:
        """The largest amount; 0 where there are none."""
        return max(self.amounts, default=0.0)

    def reason_with(self, amount: float) -> Reason:
        """Return the reason to report once an amount was tried."""
        return self.reported(self.reason, amount)


class Trials:
    """Trials whether some folds can be done; a change that gives no valid problem counts as no help."""

    def __init__(self, ask: Ask, is_enough: Callable[[], bool], folds: int) -> None:
        """Take what tries a problem, what is polled before, and the folds that must become possible, as a bit mask."""
        self._ask = ask
        self._is_enough = is_enough
        self._folds = folds
        self._known: dict[tuple[Change, RelaxedProblem, float, bool], tuple[RelaxedProblem, Trial] | None] = {}

    def trial(self, relaxed: RelaxedProblem, *, with_arms: bool) -> Trial:
        """Return the trial of a problem; without arms it is enough that all places are in reach."""
        self._require_time()
        return self._ask(relaxed if with_arms else relaxed.changed(COLLISIONS_IGNORED), self._folds)

    def measured(self, trial: Trial) -> tuple[Reason, ...]:
        """Return the reasons that a trial met."""
        self._require_time()
        return reasons_met(trial.obstacles)

    def touched(self, trial: Trial) -> Reason | None:
        """Return what the arms touch in a trial, as a reason; None where it met no collision."""
        return next((reason for reason in self.measured(trial) if reason.code is Code.COLLISION), None)

    def with_change(
        self, change: Change, base: RelaxedProblem, amount: float, *, with_arms: bool
    ) -> tuple[RelaxedProblem, Trial] | None:
        """Return a problem with a change made and its trial; None where the change gives no valid problem."""
        key = (change, base, amount, with_arms)
        if key not in self._known:
            changed = changed_or_none(base, change, amount)
            self._known[key] = None if changed is None else (changed, self.trial(changed, with_arms=with_arms))
        return self._known[key]

    def is_enough(self, change: Change, base: RelaxedProblem, amount: float, *, with_arms: bool = True) -> bool:
        """Return whether the folds can be done once a change is made to a problem by an amount."""
        found = self.with_change(change, base, amount, with_arms=with_arms)
        return found is not None and found[1].is_possible

    def least(
        self, relaxation: Relaxation, base: RelaxedProblem, low: float, amounts: Sequence[float], *, with_arms: bool
    ) -> float | None:
        """Return the least amount up to the first sufficient one of some amounts; None if none is sufficient."""
        for amount in amounts:
            needed = self._needed(relaxation, base, amount, with_arms=with_arms)
            if needed is not None:
                return self.settled(relaxation, base, low, needed, with_arms=with_arms)
            low = amount
        return None

    def settled(
        self, relaxation: Relaxation, base: RelaxedProblem, low: float, high: float, *, with_arms: bool
    ) -> float:
        """Return the least sufficient amount in an interval; its upper end is sufficient."""
        search = Bisection(low, high, relaxation.change.step, is_near=True)
        with suppress(SpentError):
            while (amount := search.amount) is not None:
                search.note(amount, self._needed(relaxation, base, amount, with_arms=with_arms))
                search.is_near = relaxation.needed is not None and search.fails < 0.5 * search.works
        return search.works

    def _require_time(self) -> None:
        if self._is_enough():
            raise SpentError

    def _needed(self, relaxation: Relaxation, base: RelaxedProblem, amount: float, *, with_arms: bool) -> float | None:
        """Return how much of an amount the path found with it really needs; None if it is not sufficient."""
        found = self.with_change(relaxation.change, base, amount, with_arms=with_arms)
        if found is None or not found[1].is_possible:
            return None
        return amount if relaxation.needed is None else min(relaxation.needed(found[1]), amount)


def changed_or_none(base: RelaxedProblem, change: Change, amount: float) -> RelaxedProblem | None:
    """Return a problem with a change made; None where that gives no valid problem."""
    try:
        return base.changed(change, amount)
    except FoldingError:
        return None
