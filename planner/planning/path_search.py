"""Search for a path that the arms can follow: A* over states, whose best path is validated lazily, again and again."""

import math
import time
from collections.abc import Iterable, Iterator
from dataclasses import replace
from itertools import islice, zip_longest
from typing import Any

from planner.cloth.g_state import Unrest
from planner.geometry.tolerance import TIME_S
from planner.motion.edge_hands import EdgeHands
from planner.motion.plan_segment import PlanSegment, duration_s
from planner.motion.search_limits import QUICK, SearchLimits
from planner.planning.budget import Budget, OutOfTimeError
from planner.planning.driving_bound import DrivingBound
from planner.planning.edges import Edges
from planner.planning.found_plan import FoundPlan
from planner.planning.heuristic import HEURISTICS, Heuristic
from planner.planning.motion_validator import MotionValidator
from planner.planning.problem import Problem
from planner.planning.sequence_costs import ChargedEdges, Reached
from planner.planning.single_fold import SingleFold
from planner.planning.trial import Explainer, Trial
from planner.primitives.obstacle import BlockingContact, situation
from planner.primitives.primitive import Step
from planner.primitives.state import State
from planner.search.a_star import Outcome, SearchResult, a_star
from planner.task.reason import Reason
from planner.weakly import weakly

# Most plans are found with fewer.
LOOK_ALONE_AFTER = 180
"""Looks at states, or at what may leave them, after which a search checks each fold alone.

Each search counts its own, so that one that follows another still meets what it gives as reasons.
"""

_COLLISIONS_MAX = 12
"""Motions that the arms could not follow for which the blocking contact is looked up."""


class PathSearch:
    """A search for the quickest path to some folds done, with its budget and the obstacles met."""

    def __init__(
        self,
        problem: Problem,
        heuristic: str,
        budget: Budget,
        max_expanded: int,
        known: FoundPlan | None = None,
        explainer: Explainer | None = None,
        hands: EdgeHands | None = None,
    ) -> None:
        """Prepare a search.

        Args:
            problem: the problem to plan.
            heuristic: the name of a consistent lower bound on the remaining time.
            budget: the work and the time for the search.
            max_expanded: the most states to expand.
            known: a plan for the problem; the search looks only for a quicker one.
            explainer: says why there is no path; None if this is not wanted.
            hands: has hands hold edges; None where it does not matter how they hold.
        """
        self._problem = problem
        self._hands = hands
        self._context = problem.context
        self._heuristic = heuristic
        self._budget = budget
        self._max_expanded = max_expanded
        self._known = known
        self._explainer = explainer
        self._wanted = (1 << len(problem.context.sequence.folds)) - 1
        self._achieved = 0
        self._reached: set[State] = set()
        self._blocking: list[int] = []
        self._validator = self._validator_with(QUICK)
        budget.watch(problem)
        budget.limit(problem.context.patience)
        self._found: tuple[PlanSegment, ...] = ()
        self._bound_s: float | None = None
        self._edges = Edges(problem.context, weakly(self._possible), weakly(self._meets_query))
        self._explored = self._looks = 0
        self._joint_time_s = 0.0
        self._is_looked_at_alone = False

    def quicker(self, found: tuple[PlanSegment, ...]) -> tuple[PlanSegment, ...]:
        """Return the segments of the quickest path found, or given ones where no quicker path is found."""
        self._found = found
        self._validated_path(self._problem.start)
        return self._found

    def _validator_with(self, search_limits: SearchLimits, transfers_max: float = math.inf) -> MotionValidator:
        """Return a validator with nothing rejected, and limits on what it tries."""
        is_over = weakly(self._is_out_of_budget)
        return MotionValidator(
            self._problem.maker, is_over, search_limits, transfers_max, self._hands, weakly(self._show)
        )

    def _show(self, plan_segments: tuple[PlanSegment, ...]) -> None:
        """Show segments that can be performed while quicker ones are looked for; a search by itself shows none."""

    def _validated_path(self, start: State) -> tuple[SearchResult[Any, Step], tuple[PlanSegment, ...]]:
        """Return the search's result for the quickest validated path, and the segments of that path."""
        bound = self._bound(start)
        while True:
            result = self._path(start, bound)
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
                found = self._validator.plan_segments([edge.action for edge in result.path])
            except OutOfTimeError:
                return replace(result, outcome=Outcome.BUDGET_EXCEEDED), self._found
            finally:
                self._joint_time_s += time.perf_counter() - begun
            self._keep(self._validator.slower if found is None else found)
            if found is not None or self._is_settled():
                return result, self._found
            self._begin_next_round()

    def _path(self, start: State, bound: Heuristic) -> SearchResult[Any, Step]:
        """Return the search's result for the path that seems to be the quickest by what is known."""
        self._edges.begin()
        limits = (self._max_expanded, self._is_over, self._limit_s)
        sequence_costs = self._validator.sequence_costs
        if not sequence_costs:
            return a_star(start, self._edges.leaving, self._is_goal, bound, *limits)
        return a_star(
            Reached(start, sequence_costs.at_start),
            ChargedEdges(self._edges, sequence_costs).leaving,
            lambda node: self._is_goal(node.state),
            lambda node: bound(node.state),
            *limits,
        )

    def _is_settled(self) -> bool:
        """Return whether to end the search although the path found is slower than assumed, or was rejected."""
        return False

    def _begin_next_round(self) -> None:
        """Forget the states reached: the next path is searched for with raised costs."""
        self._reached.clear()

    def _keep(self, plan_segments: tuple[PlanSegment, ...]) -> None:
        """Keep segments that can be performed if they are quicker than those kept."""
        if plan_segments and (not self._found or duration_s(plan_segments) < duration_s(self._found)):
            self._found = plan_segments

    def _bound(self, start: State) -> Heuristic:
        """Return the requested lower bound; it includes driving where the folds have too many orders to search."""
        if self._heuristic == "arm_time" and self._context.sequence.dag.is_loose:
            return DrivingBound(self._context, start, self._is_out_of_budget)
        return HEURISTICS[self._heuristic](self._context)

    def _is_goal(self, state: State) -> bool:
        return state.done & self._wanted == self._wanted

    def _note_bound(self, result: SearchResult[Any, Step]) -> None:
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

    def _possible(self, state: State, steps: Iterable[Step]) -> list[tuple[Step, float]]:
        """Return the steps leaving a state that may succeed, each with the least known cost (s)."""
        possible = self._validator.possible(state, steps)
        for step, _ in possible:
            self._achieved |= step.after.done
            self._reached.add(step.after)
        return possible

    def _meets_query(self, held: State) -> bool:
        """Return whether the search should also consider a grasp that it met with the base elsewhere."""
        self._reached.add(held)
        return self._validator.is_in_doubt(held)

    @property
    def _has_plan(self) -> bool:
        return self._known is not None or bool(self._found)

    def _is_over(self) -> bool:
        """Return whether the search must end; polled at each look."""
        self._look()
        return bool(self._blocking) or self._is_out_of_budget()

    def _look(self) -> None:
        """Count a look at a state; after some looks in vain, check each fold alone."""
        self._budget.looks += 1
        self._looks += 1
        if self._looks > LOOK_ALONE_AFTER and not self._has_plan and not self._is_looked_at_alone:
            self._is_looked_at_alone = True
            alone = SingleFold(self._context, self._problem.start.station, self._is_out_of_budget)
            self._blocking = [fold for fold in self._next_unseen() if alone.is_impossible(fold)]

    def _is_out_of_budget(self) -> bool:
        return self._budget.is_over

    def _next_unseen(self) -> list[int]:
        """Return the folds that no state has done yet although no fold that they depend on is left."""
        available = self._context.sequence.dag.available(self._achieved)
        return [fold for fold in available if self._wanted & ~self._achieved & 1 << fold]

    def _unrestful(self, unrest: Unrest) -> Trial:
        """Return the trial of a problem whose cloth does not stay where it lies at the start."""
        explainer = self._explainer
        return Trial(
            self._context,
            None,
            False,
            lambda: () if explainer is None else (explainer.at_start(self._context, unrest),),
        )

    def _measured(self) -> tuple[Reason, ...]:
        """Return the reasons that the search met, not tried yet."""
        if self._explainer is None:
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
