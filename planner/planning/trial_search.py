"""Try whether some folds of a problem can be done at all, not necessarily in the quickest way."""

from planner.motion.plan_segment import PlanSegment
from planner.planning.budget import Budget
from planner.planning.effort import Effort
from planner.planning.greedy import WEIGHT, greedy
from planner.planning.heuristic import Heuristic, arm_time
from planner.planning.path_search import PathSearch
from planner.planning.problem import Problem
from planner.planning.trial import Explainer, Trial
from planner.primitives.primitive import Step
from planner.primitives.state import State
from planner.search.a_star import Outcome, SearchResult, a_star
from planner.task.reason import Reason

_EXPANDED_MAX, _GLANCE_WORK_S, _TRIAL_WORK_S = 200, 0.4, 1.0
"""States expanded in a trial, and its work: without joint paths, and with them (s, see `Budget`)."""


class TrialSearch(PathSearch):
    """A search for any path to some folds done, and to all folds that they depend on."""

    def __init__(self, problem: Problem, budget: Budget, folds: int, explainer: Explainer | None) -> None:
        """Prepare a trial.

        Args:
            problem: the problem to try.
            budget: the time for the trial; its work is limited here.
            folds: the folds, as a bit mask.
            explainer: says what stood in the way; None if this is not wanted.
        """
        super().__init__(problem, "arm_time", budget, _EXPANDED_MAX, explainer=explainer)
        self._wanted = folds

    def trial(self, *, may_collide: bool) -> Trial:
        """Return the outcome; with `may_collide` it is enough that the places are in reach, without joint paths."""
        self._budget.work_limit_s = self._budget.spent_s + (_GLANCE_WORK_S if may_collide else _TRIAL_WORK_S)
        start = self._problem.start
        unrest = self._problem.unrest
        if unrest is not None:
            return self._unrestful(unrest)
        plan_segments = None if may_collide else self._greedy_acts(start)
        if plan_segments is not None:
            return Trial(
                self._context,
                (start, *(step.after for plan_segment in plan_segments for step in plan_segment.steps)),
                False,
                tuple,
            )
        result = self._some_path(start) if may_collide else self._validated_path(start)[0]
        states = (start, *(edge.action.after for edge in result.path)) if result.outcome is Outcome.SOLVED else None
        return Trial(self._context, states, bool(self._validator.rejected), self._measured)

    def _greedy_acts(self, start: State) -> tuple[PlanSegment, ...] | None:
        return greedy(self._problem, start, Effort(), self._is_out_of_budget, self._wanted)

    def _some_path(self, start: State) -> SearchResult[State, Step]:
        """Return a path that need be neither the quickest nor validated."""
        self._edges.begin()
        bound = self._bound(start)
        question = (start, self._edges.leaving, self._is_goal, lambda state: WEIGHT * bound(state))
        return a_star(*question, self._max_expanded, self._is_over, is_consistent=False)

    def _is_settled(self) -> bool:
        return bool(self._found)

    def _bound(self, start: State) -> Heuristic:
        return arm_time(self._context, self._wanted)

    def _measured(self) -> tuple[Reason, ...]:
        return () if self._budget.is_late else super()._measured()
