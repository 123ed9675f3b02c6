"""Search for the quickest plan: A* over states, lazy validation of its path, and the obstacles that it met."""

import math
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import islice, zip_longest

from planner.cloth.g_state import Unrest
from planner.geometry.tolerance import TIME_S
from planner.motion.act import Act, duration_s
from planner.motion.tries import MORE_RUNS, QUICK, THOROUGH
from planner.planning.budget import Budget
from planner.planning.driving_bound import DrivingBound
from planner.planning.edges import Edges
from planner.planning.effort import Effort
from planner.planning.found_plan import FoundPlan
from planner.planning.greedy import WEIGHT, greedy
from planner.planning.heuristic import HEURISTICS, Heuristic, arm_time
from planner.planning.motion_validator import MotionValidator, OutOfTimeError
from planner.planning.problem import Problem
from planner.planning.quick_plan import quickly_planned
from planner.planning.single_fold import SingleFold
from planner.planning.tightened import with_more_comfort, with_narrower_cones
from planner.planning.trial import Explainer, Trial
from planner.primitives.obstacle import BlockingContact, situation
from planner.primitives.primitive import Step
from planner.primitives.state import State
from planner.search.a_star import Outcome, SearchResult, a_star
from planner.task.plan import Statistics
from planner.task.reason import Reason

# Most plans are found with fewer.
LOOK_ALONE_AFTER = 180
"""Looks at states, or at what may leave them, after which the search checks each fold alone."""

GREEDY_AFTER_S = 1.0
"""Work without a plan after which the search looks for some plan to fall back on (s, see `Budget`)."""

LESS_ROOM_AFTER_S = 1.0
"""Work after which a search that found only plans slower than assumed looks at tightened tasks (s, see `Budget`)."""

# A comfort radius below its default is rare, and a larger one then usually pays; a cone that could be narrower is in
# every request.
MORE_COMFORT_SHARE, NARROWER_SHARE = 2.0, 0.5
"""Work on each task with a larger comfort radius, and on all with narrower cones, as a share of earlier work."""

TRIAL_EXPANDED_MAX, GLANCE_WORK_S, TRIAL_WORK_S, REASONS_WORK_S = 200, 0.4, 1.0, 4.0
"""Budget of the searches that try whether a fold can be done once a cause is removed: states expanded in each, work of
one without joint paths, of one with them, and of all for one plan (s, see `Budget`)."""

_COLLISIONS_MAX = 12
"""Motions that the arms could not follow for which the blocking contact is looked up."""


class PlanSearch:
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
        self._explainer, self._is_patient = explainer, is_patient
        self._problem = problem
        self._context = problem.context
        self._heuristic = heuristic
        self._max_expanded = max_expanded
        self._started = time.perf_counter()
        self._budget = budget
        self._greedy_at_s = GREEDY_AFTER_S
        self._known = known
        self._like = like
        self._on_found = on_found
        self._wanted = (1 << len(problem.context.sequence.folds)) - 1
        self._is_trial = False
        self._tried_s = 0.0
        self._achieved = 0
        self._reached: set[State] = set()
        self._blocking: list[int] = []
        self._validator = MotionValidator(problem.maker, self._is_out_of_budget, QUICK)
        budget.watch(problem)
        problem.context.patience.is_over = lambda: budget.is_late
        problem.context.patience.is_long_over = lambda: budget.is_overdue
        self._found: tuple[Act, ...] = ()
        self._bound_s: float | None = None
        self._edges = Edges(problem.context, self._possible, self._is_wanted)
        self._explored = 0
        self._joint_time_s = 0.0
        self._is_looked_at_alone = self._has_tried_less = False

    def plan(self) -> FoundPlan:
        """Return the quickest plan, or none with the reasons for it if there is an explainer."""
        found = self._plan()
        self._context.forget()
        return found

    def _plan(self) -> FoundPlan:
        unrest = self._problem.unrest
        if unrest is not None:
            return self._answer(Outcome.INFEASIBLE, (), self._tried(self._unrestful(unrest)), is_cut_short=False)
        result, _ = self._real_path(self._problem.start)
        is_cut_short = result.outcome is Outcome.BUDGET_EXCEEDED and not self._blocking
        is_worth_more = self._is_patient or bool(self._found)
        if not is_cut_short and not self._blocking and self._is_in_doubt and is_worth_more:
            is_cut_short = self._is_cut_short_trying_more()
        if self._found:
            return self._answer(Outcome.SOLVED, self._found, (), is_cut_short)
        if self._known is not None:
            return self._answer(Outcome.SOLVED, self._known.acts, (), is_cut_short)
        if self._blocking or result.outcome is Outcome.INFEASIBLE:
            return self._answer(Outcome.INFEASIBLE, (), self._reasons(), is_cut_short)
        return self._answer(result.outcome, (), (), is_cut_short)

    @property
    def _is_in_doubt(self) -> bool:
        """Whether something quicker than the known plan may be among the rejected steps and is worth more tries."""
        return self._validator.has_doubts and self._limit_s > (self._bound_s or 0.0)

    def _is_cut_short_trying_more(self) -> bool:
        """Search again in tightened tasks, and with more tries if there is no plan; return whether the budget ran out.

        The reasons keep to the first round: they say what was in the way of the quickest ways.
        """
        self._try_with_less_room()
        if math.isinf(self._limit_s):
            first, reached = self._validator, set(self._reached)
            self._validator = MotionValidator(self._problem.maker, self._is_out_of_budget, THOROUGH, MORE_RUNS)
            self._real_path(self._problem.start)
            self._validator, self._reached = first, reached
        return self._is_out_of_budget()

    def _try_with_less_room(self) -> None:
        """Look once for a quicker plan in tightened tasks.

        A plan for a tightened task is also a plan for this one. With more room, the first few ways tried may all be
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

    def _try_tighter(self, problem: Problem, work_s: float) -> float:
        """Look for a quicker plan in a tightened task with limited work (s); return the work done (s).

        The search is left out where no quicker plan can exist.
        """
        if work_s <= 0.0 or not self._is_in_doubt:
            return 0.0
        budget = Budget(0.0, self._budget.deadline_s, self._budget.should_stop)
        search = PlanSearch(problem, self._heuristic, budget, self._max_expanded, self._known)
        search._found, search._greedy_at_s, search._has_tried_less = self._found, math.inf, True
        begun_s = budget.spent_s
        budget.work_limit_s = begun_s + work_s
        search._real_path(problem.start)
        self._found = search._found
        return budget.spent_s - begun_s

    def trial(self, folds: int, *, may_collide: bool) -> Trial:
        """Try whether some folds, and all folds that they depend on, can be done, not necessarily in the quickest way.

        Args:
            folds: the folds, as a bit mask.
            may_collide: whether it is enough that the places are in reach; joint paths are then not looked for.
        """
        self._wanted, self._greedy_at_s = folds, math.inf
        self._is_trial = True
        start = self._problem.start
        unrest = self._problem.unrest
        if unrest is not None:
            return self._unrestful(unrest)
        acts = None if may_collide else greedy(self._problem, start, Effort(), self._is_out_of_budget, folds)
        if acts is not None:
            return Trial(self._context, (start, *(step.after for act in acts for step in act.steps)), False, tuple)
        result = self._some_path(start) if may_collide else self._real_path(start)[0]
        states = (start, *(edge.after for edge in result.path)) if result.outcome is Outcome.SOLVED else None
        return Trial(self._context, states, bool(self._validator.rejected), self._measured)

    def _real_path(self, start: State) -> tuple[SearchResult[State, Step], tuple[Act, ...]]:
        """Return the search's result for the quickest validated path, and the acts of that path."""
        bound, is_over = self._bound(start), self._is_over
        question = (start, self._edges.leaving, self._is_goal, bound, self._max_expanded, is_over)
        while True:
            self._edges.begin()
            result = a_star(*question, limit=self._limit_s)
            self._explored += result.explored
            self._note_bound(result)
            if result.outcome is Outcome.BUDGET_EXCEEDED:
                return result, self._found
            begun = time.perf_counter()
            try:
                if self._validator.catch_up(result.cost):
                    continue
                if result.cost >= self._limit_s:
                    return replace(result, outcome=Outcome.INFEASIBLE), self._found
                found = self._validator.acts([edge.action for edge in result.path])
            except OutOfTimeError:
                return replace(result, outcome=Outcome.BUDGET_EXCEEDED), self._found
            finally:
                self._joint_time_s += time.perf_counter() - begun
            self._keep(self._validator.slower if found is None else found)
            if found is not None or (self._is_trial and self._found):
                return result, self._found
            self._reached.clear()
            if self._found and self._budget.spent_s > LESS_ROOM_AFTER_S:
                self._try_with_less_room()

    def _keep(self, acts: tuple[Act, ...]) -> None:
        """Keep acts that can be performed if they are quicker than those kept."""
        if acts and (not self._found or duration_s(acts) < duration_s(self._found)):
            self._found = acts

    def _some_path(self, start: State) -> SearchResult[State, Step]:
        """Return a path that need be neither the quickest nor validated."""
        self._edges.begin()
        bound = self._bound(start)
        question = (start, self._edges.leaving, self._is_goal, lambda state: WEIGHT * bound(state))
        return a_star(*question, self._max_expanded, self._is_over, is_consistent=False)

    def _bound(self, start: State) -> Heuristic:
        """Return the requested lower bound; it includes driving where the folds have too many orders to search."""
        if self._is_trial:
            return arm_time(self._context, self._wanted)
        if self._heuristic == "arm_time" and self._context.sequence.dag.is_loose:
            return DrivingBound(self._context, start, self._is_out_of_budget)
        return HEURISTICS[self._heuristic](self._context)

    def _is_goal(self, state: State) -> bool:
        return state.done & self._wanted == self._wanted

    def _note_bound(self, result: SearchResult[State, Step]) -> None:
        """Note the search's lower bound on any plan, as long as no step was rejected or made more expensive.

        After that, a raised cost only says that the tries found nothing better, which is no proof.
        """
        if not self._validator.has_doubts and self._bound_s is None:
            self._bound_s = min(result.bound, self._limit_s + TIME_S)

    @property
    def _limit_s(self) -> float:
        """The cost from which on a plan is no quicker than the known one (s)."""
        known_s = [math.inf] if self._known is None else [self._known.plan.cost_s or 0.0]
        if self._found:
            known_s.append(duration_s(self._found))
        return min(known_s) - TIME_S

    def _unrestful(self, unrest: Unrest) -> Trial:
        """Return the trial of a problem whose cloth does not stay where it lies at the start."""
        explainer = self._explainer
        return Trial(
            self._context,
            None,
            False,
            lambda: () if explainer is None else (explainer.at_start(self._context, unrest),),
        )

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
        budget = self._budget.part(0.0)
        search = PlanSearch(problem, self._heuristic, budget, TRIAL_EXPANDED_MAX, explainer=self._explainer)
        begun_s = budget.spent_s
        budget.work_limit_s = begun_s + (GLANCE_WORK_S if may_collide else TRIAL_WORK_S)
        found = search.trial(folds, may_collide=may_collide)
        spent_s = budget.spent_s - begun_s
        self._tried_s += spent_s
        self._budget.beside_s += spent_s
        return found

    def _have_tried_enough(self) -> bool:
        return self._tried_s > REASONS_WORK_S or self._budget.is_late

    def _measured(self) -> tuple[Reason, ...]:
        if self._explainer is None or (self._is_trial and self._budget.is_late):
            return ()
        reached = {situation(state) for state in self._reached}
        return self._explainer.met(self._context, self._blocked(), reached, self._blocking)

    def _blocked(self) -> Iterator[tuple[Step, BlockingContact | None]]:
        """Yield steps that the arms could not follow, each with its blocking contact."""
        for number, steps in enumerate(self._some_rejected()):
            if number and self._budget.is_late:
                break
            yield steps[-1], self._problem.maker.contact(steps)

    def _some_rejected(self) -> list[tuple[Step, ...]]:
        """Return a few rejected transfers, the first ones of each task, which are its quickest."""
        by_task: dict[tuple[object, ...], list[tuple[Step, ...]]] = {}
        for steps in self._validator.rejected:
            by_task.setdefault(steps[-1].task, []).append(steps)
        in_turns = (steps for turn in zip_longest(*by_task.values()) for steps in turn if steps is not None)
        return list(islice(in_turns, _COLLISIONS_MAX))

    def _possible(self, state: State, steps: Iterable[Step]) -> Iterator[tuple[Step, float]]:
        """Yield the steps leaving a state that may succeed, each with the least known cost (s)."""
        for step, cost_s in self._validator.possible(state, steps):
            self._achieved |= step.after.done
            self._reached.add(step.after)
            yield step, cost_s

    def _is_wanted(self, held: State) -> bool:
        """Return whether the search should also consider a grasp that it met with the base elsewhere."""
        self._reached.add(held)
        return self._validator.is_in_doubt(held)

    def _is_over(self) -> bool:
        self._budget.looks += 1
        has_plan = self._known is not None or bool(self._found)
        if self._budget.looks > LOOK_ALONE_AFTER and not has_plan and not self._is_looked_at_alone:
            self._is_looked_at_alone = True
            alone = SingleFold(self._context, self._problem.start.station, self._is_out_of_budget)
            self._blocking = [fold for fold in self._next_unseen() if alone.is_impossible(fold)]
        if not has_plan and not self._blocking and self._budget.spent_s >= self._greedy_at_s:
            self._greedy_at_s = math.inf
            self._fall_back()
        return bool(self._blocking) or self._is_out_of_budget()

    def _fall_back(self) -> None:
        """Look for some plan, and continue with it as the known plan."""
        self._known = quickly_planned(self._budget.watch(self._problem.anew()), self._like, self._is_out_of_budget)
        if self._known is None:
            return
        self._started += self._known.plan.statistics.search_time_s + self._known.plan.statistics.joint_time_s
        if self._on_found is not None:
            self._on_found(self._known)

    def _is_out_of_budget(self) -> bool:
        return self._budget.is_over

    def _next_unseen(self) -> list[int]:
        """Return the folds that no state has done yet although no fold that they depend on is left."""
        available = self._context.sequence.dag.available(self._achieved)
        return [fold for fold in available if self._wanted & ~self._achieved & 1 << fold]

    def _answer(
        self, outcome: Outcome, acts: tuple[Act, ...], why: tuple[Reason, ...], is_cut_short: bool
    ) -> FoundPlan:
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
        if self._known is not None and acts is self._known.acts:
            return self._known.told_again(self._problem.task, statistics, is_exhaustive=is_exhaustive)
        return FoundPlan.of(self._problem, outcome.value, acts, why, statistics, is_exhaustive=is_exhaustive)
