"""The entry point of this package: explains to planning why there is no plan."""

from collections.abc import Callable, Collection, Iterable

from planner.cloth.g_state import Unrest
from planner.explain.reasons import note_collision, reason_at_start, reasons
from planner.explain.relaxation_sets import confirmed_reasons
from planner.explain.relaxed_problem import RelaxedProblem
from planner.planning.problem import Problem
from planner.planning.trial import Trial, TryFolds
from planner.primitives.context import Context
from planner.primitives.obstacle import BlockingContact, Situation
from planner.primitives.primitive import Step
from planner.task.reason import Reason


class Explanation:
    """Explains why there is no plan; implements `planner.planning.trial.Explainer`."""

    def at_start(self, context: Context, unrest: Unrest) -> Reason:
        """Return the reason why cloth does not stay as it lies at the start."""
        return reason_at_start(context, unrest)

    def met(
        self,
        context: Context,
        blocked: Iterable[tuple[Step, BlockingContact | None]],
        reached: Collection[Situation],
        impossible: Collection[int],
    ) -> tuple[Reason, ...]:
        """Return the reasons that a search met, not tried yet."""
        for step, contact in blocked:
            note_collision(context, step, contact)
        return reasons(context, reached, impossible)

    def tried(
        self, problem: Problem, met: Trial, try_folds: TryFolds, is_enough: Callable[[], bool]
    ) -> tuple[Reason, ...]:
        """Return minimal sets of the reasons met, each tried."""

        def ask(relaxed: RelaxedProblem, folds: int) -> Trial:
            return try_folds(relaxed.searched, relaxed.may_collide, folds)

        return confirmed_reasons(RelaxedProblem.of(problem), met, ask, is_enough)


class FirstExplanation(Explanation):
    """Returns the reasons met without trying any, for callers that try changes themselves."""

    def tried(
        self, problem: Problem, met: Trial, try_folds: TryFolds, is_enough: Callable[[], bool]
    ) -> tuple[Reason, ...]:
        """Return the reasons met."""
        return met.measured()
