"""What became of a planning problem when it was tried, and who says why there is no plan."""

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
    """What became of a problem when it was tried.

    Attributes:
        context: the problem's work, with what was met.
        states: the states on the way that was found; None: none was.
        has_collided: whether there were ways that are in reach, but on which the arms touch something.
        measured: works out what stood in the way, not tried yet.
    """

    context: Context
    states: tuple[State, ...] | None
    has_collided: bool
    measured: Callable[[], tuple[Reason, ...]]

    @property
    def is_possible(self) -> bool:
        """Whether a way was found."""
        return self.states is not None

    @property
    def needed_friction(self) -> float:
        """The least friction coefficient with which the way that was found would do as well."""
        context = self.context
        rests = {(state.done, state.place): state for state in self.states or ()}
        found = (
            needed_friction(context.sequence.cloth(s.done), context.table_in_article(s.offset)) for s in rests.values()
        )
        return max(found, default=0.0)


TryFolds: TypeAlias = Callable[[Problem, bool, int], Trial]
"""Asked whether some folds of a problem, a bit mask, can be done, and whether arms may go through anything."""


class Explainer(Protocol):
    """Says why there is no plan: `planner.explain` does."""

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
            context: the problem, with what was met on the way.
            blocked: steps whose places are in reach but that the arms cannot follow, and what is in their way.
            reached: the situations that the search came to.
            impossible: folds that cannot be done even alone; then the search may have ended early. Empty: it has
                exhausted all states.
        """
        ...

    def tried(
        self, problem: Problem, met: Trial, try_folds: TryFolds, is_enough: Callable[[], bool]
    ) -> tuple[Reason, ...]:
        """Return the reasons among those that were met, each tried: with it removed there is a plan, or its fold.

        Args:
            problem: what was to be planned.
            met: what was met.
            try_folds: plans with causes removed.
            is_enough: asked before each trial; true ends them.
        """
        ...
