"""The events of planning; the last one is `Done`."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from planner.planning.budget import Budget
from planner.planning.found_plan import FoundPlan
from planner.planning.problem import Problem
from planner.primitives.obstacle import BlockingContact, Situation
from planner.primitives.primitive import Step


@dataclass(frozen=True, slots=True)
class Improved:
    """A plan that can be performed; the search for a quicker one goes on.

    Attributes:
        found: the plan, with a lower bound on the cost of any plan in its statistics.
    """

    found: FoundPlan


@dataclass(frozen=True, slots=True, eq=False)
class Obstacles:
    """The obstacles that a search met, besides those that its context has collected.

    Attributes:
        problem: the problem searched.
        budget: the budget of the search.
        rejected: a few transfers that the arms could not follow, the quickest of each task.
        reached: the situations that the search reached.
        impossible: folds that cannot be done even alone, for which the search may have ended early; empty if the search
            has exhausted all states.
    """

    problem: Problem
    budget: Budget
    rejected: Sequence[tuple[Step, ...]] = ()
    reached: frozenset[Situation] = frozenset()
    impossible: Sequence[int] = ()

    def contacts(self) -> Iterator[tuple[Step, BlockingContact | None]]:
        """Yield steps that the arms could not follow, each with its blocking contact, while there is time."""
        for number, steps in enumerate(self.rejected):
            if number and self.budget.deadline.is_over:
                break
            yield steps[-1], self.problem.maker.contact(steps)


@dataclass(frozen=True, slots=True)
class Blocked:
    """There is no plan.

    Attributes:
        found: the answer, with the reasons that are known by then.
        obstacles: what stood in the way.
    """

    found: FoundPlan
    obstacles: Obstacles


@dataclass(frozen=True, slots=True)
class Done:
    """The search has ended.

    Attributes:
        found: the quickest plan, or none.
    """

    found: FoundPlan


Event: TypeAlias = Improved | Blocked | Done
