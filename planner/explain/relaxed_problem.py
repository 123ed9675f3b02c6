"""A planning problem with some obstacles removed, and the interface for trying it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from planner.explain.change import NO_LIBERTIES, Change, Liberties, request_fields
from planner.planning.problem import Problem
from planner.planning.trial import Trial
from planner.primitives.context import Context


@dataclass(frozen=True, slots=True, eq=False)
class RelaxedProblem:
    """A planning problem with some causes removed.

    Attributes:
        problem: the problem, with all changes that a request can ask for.
        liberties: the changes that none can ask for.
    """

    problem: Problem
    liberties: Liberties = NO_LIBERTIES

    @staticmethod
    def of(problem: Problem) -> "RelaxedProblem":
        """Return a problem as it is."""
        return RelaxedProblem(problem)

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
