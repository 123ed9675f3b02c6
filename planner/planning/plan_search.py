"""Search for the quickest plan, fall back on some plan meanwhile, and try why there is none."""

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import replace

from planner.motion.edge_hands import EdgeHands
from planner.motion.plan_segment import PlanSegment, duration_s
from planner.motion.search_limits import MORE_TRANSFERS, THOROUGH
from planner.planning.budget import Budget
from planner.planning.found_plan import FoundPlan
from planner.planning.path_search import PathSearch
from planner.planning.problem import Problem
from planner.planning.quick_plan import quickly_planned
from planner.planning.restricted_tasks import with_arms_apart, with_more_comfort, with_narrower_cones
from planner.planning.trial import Explainer, Trial
from planner.planning.trial_search import TrialSearch
from planner.search.a_star import Outcome
from planner.task.reason import Reason
from planner.task.statistics import Statistics

GREEDY_AFTER_S, PATIENT_GREEDY_AFTER_S = 1.0, 3.0
"""Work without a plan after which some plan to fall back on is looked for, and again, patiently (s, see `Budget`)."""

LESS_ROOM_AFTER_S = 1.0
"""Work after which a search that found only plans slower than assumed looks at restricted tasks (s, see `Budget`)."""

# A comfort radius below its default is rare, and a larger one then usually pays; a cone that could be narrower is in
# every request.
MORE_COMFORT_SHARE, NARROWER_SHARE = 2.0, 0.5
"""Work on each task with a larger comfort radius, and on all with narrower cones, as a share of earlier work."""

WORTH_SHOWING_S = 0.1
"""Least time by which a plan found meanwhile is quicker than the one shown before (s)."""

APART_SHARE, APART_LEAST_S = 2.0, 0.5
"""Work on the task whose arms stay apart, as a share of earlier work, and the least of it (s)."""

WORTH_THOROUGH = 0.01
"""Share of its cost by which a plan must be above its lower bound so that more tries are made for a quicker one."""

REASONS_WORK_S = 4.0
"""Work of all trials of the causes for one plan (s, see `Budget`)."""


class PlanSearch(PathSearch):
    """A search for the quickest plan, with its budget and the obstacles met."""

    def __init__(
        self,
        problem: Problem,
        heuristic: str,
        budget: Budget,
        max_expanded: int,
        known: FoundPlan | None = None,
        like: Sequence[FoundPlan] = (),
        on_found: Callable[[FoundPlan], None] | None = None,
        explainer: Explainer | None = None,
        *,
        is_patient: bool = True,
    ) -> None:
        """Prepare a search; its time starts now.

        Args:
            problem: the problem to plan.
            heuristic: the name of a consistent lower bound on the remaining time.
            budget: the work and the time for the search.
            max_expanded: the most states to expand.
            known: a plan for the problem; the search looks only for a quicker one.
            like: plans for similar problems, to fall back on.
            on_found: called with a plan found meanwhile, while the search for the quickest continues; where there is no
                plan, with the reasons that the search met, before they are tried.
            explainer: says why there is no plan; None if this is not wanted, since it takes further planning.
            is_patient: whether to try more ways for each step where the first few gave no plan.
        """
        self._edge_hands = EdgeHands(problem.context, problem.robot, problem.maker)
        super().__init__(problem, heuristic, budget, max_expanded, known, explainer, self._edge_hands)
        self._started = time.perf_counter()
        self._like = like
        self._on_found = on_found
        self._is_patient = is_patient
        self._fall_backs = [(GREEDY_AFTER_S, False), (PATIENT_GREEDY_AFTER_S, True)]
        self._shown_s = math.inf if known is None else known.plan.cost_s or 0.0
        self._tried_s = 0.0
        self._has_tried_less = self._has_tried_apart = False
        self._others: list[Problem] = []

    def plan(self) -> FoundPlan:
        """Return the quickest plan, or none with the reasons for it if there is an explainer."""
        found = self._plan()
        for problem in (self._problem, *self._others):  # a plan's steps keep their contexts
            problem.context.forget()
            problem.context.patience.end()
        return found

    def _plan(self) -> FoundPlan:
        unrest = self._problem.unrest
        if unrest is not None:
            return self._answer(Outcome.INFEASIBLE, (), self._tried(self._unrestful(unrest)), is_cut_short=False)
        result, _ = self._validated_path(self._problem.start)
        is_cut_short = result.outcome is Outcome.BUDGET_EXCEEDED and not self._blocking
        is_worth_more = self._is_patient or bool(self._found)
        if not is_cut_short and not self._blocking and self._is_in_doubt and is_worth_more:
            is_cut_short = self._is_cut_short_trying_more()
        if self._found:
            return self._answer(Outcome.SOLVED, self._found, (), is_cut_short, is_last=True)
        if self._known is not None:
            return self._answer(Outcome.SOLVED, self._known.plan_segments, (), is_cut_short, is_last=True)
        if self._blocking or result.outcome is Outcome.INFEASIBLE:
            return self._answer(Outcome.INFEASIBLE, (), self._reasons(), is_cut_short)
        return self._answer(result.outcome, (), (), is_cut_short)

    @property
    def _is_in_doubt(self) -> bool:
        """Whether something quicker than the known plan may be among the rejected steps and is worth more tries."""
        return self._validator.has_doubts and self._limit_s > (self._bound_s or 0.0)

    @property
    def _is_worth_thorough(self) -> bool:
        """Whether there is no plan, or a quicker one may save so much that more tries are worth their work."""
        least_s = (1.0 - WORTH_THOROUGH) * self._limit_s if self._has_plan else math.inf
        return self._validator.has_doubts and least_s > (self._bound_s or 0.0)

    def _is_cut_short_trying_more(self) -> bool:
        """Search again in restricted tasks, and with more tries if that is worth it; return whether the budget ran out.

        A few failures rule a step out, so that a plan that drives round the table is found soon. Ways that were left
        untried may still do without.

        The reasons keep to the first round: they say what was in the way of the quickest ways.
        """
        self._try_with_less_room()
        if self._is_worth_thorough:
            first, reached = self._validator, set(self._reached)
            self._validator = self._validator_with(THOROUGH, MORE_TRANSFERS)
            self._validated_path(self._problem.start)
            self._validator, self._reached = first, reached
        return self._is_out_of_budget()

    def _try_with_less_room(self) -> None:
        """Look once for a quicker plan in restricted tasks.

        A plan for a restricted task is also a plan for this one. With more room, the first few ways tried may all be
        worse.
        """
        if self._has_tried_less:
            return
        self._has_tried_less = True
        spent_s = self._budget.spent_s
        for problem in with_more_comfort(self._problem):
            self._try_tighter(problem, MORE_COMFORT_SHARE * spent_s)
        left_s = NARROWER_SHARE * spent_s
        for problem in with_narrower_cones(self._problem):
            left_s -= self._try_tighter(problem, left_s)

    def _try_with_arms_apart(self) -> None:
        """Look once for a plan with hands only where there is room beside the other arm at home, with limited work.

        Where a way was rejected, mostly the arms were in each other's way. Such a plan is found soon and limits what
        else is worth a try.
        """
        if self._has_tried_apart:
            return
        self._has_tried_apart = True
        for problem in with_arms_apart(self._problem):
            self._budget.beside_s += self._try_tighter(problem, max(APART_LEAST_S, APART_SHARE * self._budget.spent_s))

    def _try_tighter(self, problem: Problem, work_s: float) -> float:
        """Look for a quicker plan in a restricted task with limited work (s); return the work done (s).

        The search is left out where no quicker plan can exist.
        """
        if work_s <= 0.0 or not self._is_in_doubt:
            return 0.0
        self._others.append(problem)
        budget = self._budget.part(0.0)
        search = PathSearch(problem, self._heuristic, budget, self._max_expanded, self._known)
        begun_s = budget.spent_s
        budget.work_limit_s = begun_s + work_s
        self._found = search.quicker(self._found)
        return budget.spent_s - begun_s

    def _reasons(self) -> tuple[Reason, ...]:
        """Return why there is no plan, with each cause tried: removing it gives a plan, or at least allows its fold."""
        found = Trial(self._context, None, bool(self._validator.rejected), self._measured)
        return self._tried(found)

    def _tried(self, met: Trial) -> tuple[Reason, ...]:
        """Return those reasons met that proved true when tried; report them untried first, since trying takes long."""
        if self._explainer is None:
            return ()
        why = met.measured()
        if self._on_found is not None:
            self._on_found(self._answer(Outcome.INFEASIBLE, (), why, is_cut_short=False))
        known = replace(met, measured=lambda: why)
        return self._explainer.tried(self._problem, known, self._try_folds, self._have_tried_enough)

    def _try_folds(self, problem: Problem, may_collide: bool, folds: int) -> Trial:
        """Try whether some folds of a relaxed problem can be done; it shares what is known of the robot's reach."""
        self._others.append(problem)
        budget = self._budget.part(0.0)
        search = TrialSearch(problem, budget, folds, self._explainer)
        begun_s = budget.spent_s
        found = search.trial(may_collide=may_collide)
        spent_s = budget.spent_s - begun_s
        self._tried_s += spent_s
        self._budget.beside_s += spent_s
        return found

    def _have_tried_enough(self) -> bool:
        return self._tried_s > REASONS_WORK_S or self._budget.is_late

    def _begin_next_round(self) -> None:
        super()._begin_next_round()
        if self._validator.rejected:
            self._try_with_arms_apart()
        self._show(self._found)
        if self._found and self._budget.spent_s > LESS_ROOM_AFTER_S:
            self._try_with_less_room()

    def _show(self, plan_segments: tuple[PlanSegment, ...]) -> None:
        """Show segments, if any, while the search for quicker ones continues, unless a plan as quick was shown."""
        if self._on_found is None or not plan_segments or duration_s(plan_segments) > self._shown_s - WORTH_SHOWING_S:
            return
        self._shown_s = duration_s(plan_segments)
        self._on_found(self._answer(Outcome.SOLVED, plan_segments, (), is_cut_short=True))

    def _look(self) -> None:
        super()._look()
        if not self._fall_backs or self._has_plan or self._blocking:
            return
        if self._budget.spent_s >= self._fall_backs[0][0]:
            self._fall_back(is_patient=self._fall_backs.pop(0)[1])

    def _fall_back(self, *, is_patient: bool) -> None:
        """Look for some plan, and continue with it as the known plan."""
        problem = self._budget.watch(self._problem.anew())
        self._known = quickly_planned(problem, self._like, self._is_out_of_budget, is_patient=is_patient)
        if self._known is None:
            return
        self._shown_s = self._known.plan.cost_s or 0.0
        self._started += self._known.plan.statistics.search_time_s + self._known.plan.statistics.joint_time_s
        if self._on_found is not None:
            self._on_found(self._known)

    def _answer(
        self,
        outcome: Outcome,
        plan_segments: tuple[PlanSegment, ...],
        why: tuple[Reason, ...],
        is_cut_short: bool,
        *,
        is_last: bool = False,
    ) -> FoundPlan:
        """Return an answer; only the last one takes the work to have hands hold edges: the search is charged for it."""
        reach = self._context.reach
        elapsed = time.perf_counter() - self._started - self._joint_time_s
        statistics = Statistics(
            self._edges.expanded,
            self._explored,
            reach.queries,
            reach.query_time_s,
            elapsed,
            self._joint_time_s,
            None if outcome is Outcome.INFEASIBLE else self._bound_s,
            self._budget.ways,
            is_cut_short,
        )
        if self._known is not None:
            statistics = statistics.after(self._known.plan.statistics)
        is_exhaustive = not is_cut_short and (bool(self._blocking) or not self._validator.has_doubts)
        held = plan_segments
        if is_last:
            held = self._edge_hands.held(plan_segments, lambda: self._budget.is_late)
        if self._known is not None and held == self._known.plan_segments:
            return self._known.told_again(self._problem.task, statistics, is_exhaustive=is_exhaustive)
        return FoundPlan.of(self._problem, outcome.value, held, why, statistics, is_exhaustive=is_exhaustive)
