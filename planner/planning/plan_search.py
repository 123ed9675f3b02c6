"""The search for the quickest plan: A* over states, its path made real, the obstacles it met."""

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

LOOK_ALONE_AFTER = 180
"""Most plans are found with so few looks at a state or at what may leave it; after them folds are looked at alone."""

GREEDY_AFTER_S = 1.0
"""A search that has found nothing after so much work looks for some plan to fall back on (s, see `Budget`)."""

LESS_ROOM_AFTER_S = 1.0
"""A search that has only found what takes longer than it seemed, after so much work, looks at tighter tasks (s)."""

MORE_COMFORT_SHARE, NARROWER_SHARE = 2.0, 0.5
"""The work on each task with more comfort, and on all with narrower cones, as a share of what was done before. Comfort
below its default is seldom asked for, and mostly pays; all requests have a cone that could be narrower."""

TRIAL_EXPANDED_MAX, GLANCE_WORK_S, TRIAL_WORK_S, REASONS_WORK_S = 200, 0.4, 1.0, 4.0
"""The budget of the searches that try whether a fold can be done once a cause is removed: in states, each; in work one
that looks for no joint paths, one that does, and all of them for one plan (s, see `Budget`)."""

_COLLISIONS_MAX = 12
"""Of so many motions that the arms could not follow it is looked at what was in their way."""


class PlanSearch:
    """One search: its budget, and what it met on the way."""

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
        """A search that has not begun; its time runs.

        Args:
            problem: what is to be planned.
            heuristic: the name of a consistent lower bound on the time to the end.
            budget: the work and the time for it.
            max_expanded: the budget in states.
            known: a plan for the problem; only a quicker one is looked for.
            like: plans for problems like it, for one to fall back on.
            on_found: told of a plan that was found meanwhile, while the search for the quickest goes on; where there is
                none, of the reasons that were met, while they are tried.
            explainer: says why there is no plan; None: nobody asks, and to find out takes more plans.
            is_patient: whether more ways are tried for each step where the first few gave no plan.
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
        self._found: tuple[Act, ...] = ()
        self._bound_s: float | None = None
        self._edges = Edges(problem.context, self._possible, self._is_wanted)
        self._explored = 0
        self._joint_time_s = 0.0
        self._is_looked_at_alone = self._has_tried_less = False

    def plan(self) -> FoundPlan:
        """Return the quickest plan, or why there is none, if somebody asks."""
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
        """Whether something quicker than what is known may be among what was rejected and could be tried more."""
        return self._validator.has_doubts and self._limit_s > (self._bound_s or 0.0)

    def _is_cut_short_trying_more(self) -> bool:
        """Search once more, with less room, and for want of a plan with more tries; whether the budget ran out.

        Reasons rest on the first round: what was in the way of the quickest ways.
        """
        self._try_with_less_room()
        if math.isinf(self._limit_s):
            first, reached = self._validator, set(self._reached)
            self._validator = MotionValidator(self._problem.maker, self._is_out_of_budget, THOROUGH, MORE_RUNS)
            self._real_path(self._problem.start)
            self._validator, self._reached = first, reached
        return self._is_out_of_budget()

    def _try_with_less_room(self) -> None:
        """Look for something quicker where less is allowed, once.

        What can be done there can be done here. Of more ways the first few tried may all be worse ones.
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
        """Look for something quicker in a tighter task with so much work (s) if there may be any; return the work."""
        if work_s <= 0.0 or not self._is_in_doubt:
            return 0.0
        budget = Budget(0.0, self._budget.deadline_s, self._budget.should_stop)
        search = PlanSearch(problem, self._heuristic, budget, self._max_expanded, self._known)
        search._found, search._greedy_at_s, search._has_tried_less = self._found, math.inf, True
        begun_s = budget.spent_s
        budget.work_limit_s = begun_s + work_s
        search._real_path(problem.start)
        self._found = search._found
        problem.context.forget()
        return budget.spent_s - begun_s

    def trial(self, folds: int, *, may_collide: bool) -> Trial:
        """Look whether some folds (a bit mask), and all they wait for, can be done; the quickest way matters not.

        Args:
            folds: the folds.
            may_collide: whether that is in reach is enough: joint paths are not looked for.
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
        """The quickest path that is real, and what it is then."""
        bound, is_over = self._bound(start), self._is_over
        question = (start, self._edges.leaving, self._is_goal, bound, self._max_expanded, is_over)
        while True:
            self._edges.begin()
            result = a_star(*question, limit=self._limit_s)
            self._explored += result.explored
            self._note_bound(result)
            if result.outcome is not Outcome.SOLVED:
                return result, self._found
            if result.cost >= self._limit_s:
                return replace(result, outcome=Outcome.INFEASIBLE), self._found
            begun = time.perf_counter()
            try:
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
        """Keep what can be done if it takes less than what is kept."""
        if acts and (not self._found or duration_s(acts) < duration_s(self._found)):
            self._found = acts

    def _some_path(self, start: State) -> SearchResult[State, Step]:
        """A path that may not be the quickest, nor real."""
        self._edges.begin()
        bound = self._bound(start)
        question = (start, self._edges.leaving, self._is_goal, lambda state: WEIGHT * bound(state))
        return a_star(*question, self._max_expanded, self._is_over, is_consistent=False)

    def _bound(self, start: State) -> Heuristic:
        """The lower bound asked for; it knows of driving where there are too many orders of folds to search."""
        if self._is_trial:
            return arm_time(self._context, self._wanted)
        if self._heuristic == "arm_time" and self._context.sequence.dag.is_loose:
            return DrivingBound(self._context, start, self._is_out_of_budget)
        return HEURISTICS[self._heuristic](self._context)

    def _is_goal(self, state: State) -> bool:
        return state.done & self._wanted == self._wanted

    def _note_bound(self, result: SearchResult[State, Step]) -> None:
        """Note what any plan takes at least: what the search says as long as no step was rejected or raised.

        Later the search knows of steps only that nothing better was found for them, which is no proof.
        """
        if not self._validator.has_doubts and self._bound_s is None:
            self._bound_s = min(result.bound, self._limit_s + TIME_S)

    @property
    def _limit_s(self) -> float:
        """What takes as long is no quicker than what is known (s)."""
        known_s = [math.inf] if self._known is None else [self._known.plan.cost_s or 0.0]
        if self._found:
            known_s.append(duration_s(self._found))
        return min(known_s) - TIME_S

    def _unrestful(self, unrest: Unrest) -> Trial:
        """What became of a problem whose cloth does not stay where it lies at the start."""
        explainer = self._explainer
        return Trial(
            self._context,
            None,
            False,
            lambda: () if explainer is None else (explainer.at_start(self._context, unrest),),
        )

    def _reasons(self) -> tuple[Reason, ...]:
        """Why there is no plan, each cause tried: with it removed there is one, or at least its fold can be done."""
        found = Trial(self._context, None, bool(self._validator.rejected), self._measured)
        return self._tried(found)

    def _tried(self, met: Trial) -> tuple[Reason, ...]:
        """Return the reasons among what was met, each tried; what was met is told before, since to try takes long."""
        if self._explainer is None:
            return ()
        why = met.measured()
        if self._on_found is not None:
            self._on_found(self._answer(Outcome.INFEASIBLE, (), why, is_cut_short=False))
        known = replace(met, measured=lambda: why)
        return self._explainer.tried(self._problem, known, self._try_folds, self._have_tried_enough)

    def _try_folds(self, problem: Problem, may_collide: bool, folds: int) -> Trial:
        """Look whether some folds of a relaxed problem can be done; it shares what is known of the robot's reach."""
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
        if self._explainer is None:
            return ()
        reached = {situation(state) for state in self._reached}
        return self._explainer.met(self._context, self._blocked(), reached, self._blocking)

    def _blocked(self) -> Iterator[tuple[Step, BlockingContact | None]]:
        """Yield steps that the arms could not follow, and what was in their way."""
        for number, run in enumerate(self._some_rejected()):
            if number and self._budget.is_late:
                break
            yield run[-1], self._problem.maker.contact(run)

    def _some_rejected(self) -> list[tuple[Step, ...]]:
        """A few runs that could not be made real, of each task the first ones: the quickest ways."""
        by_task: dict[tuple[object, ...], list[tuple[Step, ...]]] = {}
        for run in self._validator.rejected:
            by_task.setdefault(run[-1].task, []).append(run)
        in_turns = (run for turn in zip_longest(*by_task.values()) for run in turn if run is not None)
        return list(islice(in_turns, _COLLISIONS_MAX))

    def _possible(self, state: State, steps: Iterable[Step]) -> Iterator[tuple[Step, float]]:
        """Of the steps that leave a state those that may be real, each with the least that it costs (s)."""
        for step, cost_s in self._validator.possible(state, steps):
            self._achieved |= step.after.done
            self._reached.add(step.after)
            yield step, cost_s

    def _is_wanted(self, held: State) -> bool:
        """Whether a grasp that the search came to is to be had with the base elsewhere too."""
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
        """Look for some plan; from then on that is known."""
        self._known = quickly_planned(self._budget.watch(self._problem.anew()), self._like, self._is_out_of_budget)
        if self._known is None:
            return
        self._started += self._known.plan.statistics.search_time_s + self._known.plan.statistics.joint_time_s
        if self._on_found is not None:
            self._on_found(self._known)

    def _is_out_of_budget(self) -> bool:
        return self._budget.is_over

    def _next_unseen(self) -> list[int]:
        """The folds that no state has done yet though nothing is left that they wait for."""
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
