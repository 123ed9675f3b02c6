"""The outcome of trying a planning problem, and the interface of what explains why there is no plan."""

from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass
from typing import Protocol, TypeAlias

from planner.cloth.g_state import Unrest, needed_friction
from planner.planning.problem import Problem
from planner.primitives.context import Context
from planner.primitives.obstacle import BlockingContact, Situation
from planner.primitives.primitive import Step
from planner.primitives.state import State
from planner.task.reason import Reason


@dataclass(frozen=True, slots=True, eq=False)
class Trial:
    """The outcome of trying a planning problem.

    Attributes:
        context: the planning context, with the obstacles met.
        states: the states on the path found; None if there is none.
        has_collided: whether some ways are in reach, but the arms touch something on them.
        measured: computes the reasons that the search met, not tried yet.
    """

    context: Context
    states: tuple[State, ...] | None
    has_collided: bool
    measured: Callable[[], tuple[Reason, ...]]

    @property
    def is_possible(self) -> bool:
        """Whether a path was found."""
        return self.states is not None

    @property
    def needed_friction(self) -> float:
        """The least friction coefficient with which the path found would still be possible."""
        context = self.context
        rests = {(state.done, state.place): state for state in self.states or ()}
        found = (
            needed_friction(context.sequence.cloth(s.done), context.table_in_article(s.offset)) for s in rests.values()
        )
        return max(found, default=0.0)


TryFolds: TypeAlias = Callable[[Problem, bool, int], Trial]
"""Tries whether some folds of a problem, a bit mask, can be done, and whether arms may pass through anything.

Its arguments are the problem, whether the arms may collide, and the folds."""


class Explainer(Protocol):
    """Explains why there is no plan; `planner.explain` implements it."""

    def at_start(self, context: Context, unrest: Unrest) -> Reason:
        """Return the reason why cloth does not stay as it lies at the start."""
        ...

    def met(
        self,
        context: Context,
        blocked: Iterable[tuple[Step, BlockingContact | None]],
        reached: Collection[Situation],
        impossible: Collection[int],
    ) -> tuple[Reason, ...]:
        """Return the reasons that a search met, not tried yet.

        Args:
            context: the planning context, with the obstacles met.
            blocked: steps whose places are in reach but that the arms cannot follow, with their blocking contacts.
            reached: the situations that the search reached.
            impossible: folds that cannot be done even alone, for which the search may have ended early; empty if the
                search has exhausted all states.
        """
        ...

    def tried(
        self, problem: Problem, met: Trial, try_folds: TryFolds, is_enough: Callable[[], bool]
    ) -> tuple[Reason, ...]:
        """Return those reasons that prove true when tried: removing the cause gives a plan, or allows its fold.

        Args:
            problem: the problem to plan.
            met: the trial of the problem, with the reasons met.
            try_folds: plans with causes removed.
            is_enough: polled before each trial; true ends them.
        """
        ...
