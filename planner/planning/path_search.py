"""Search for a path that the arms can follow: propose, validate, charge.

A* proposes the path that seems to be the quickest. It is validated; where it is rejected, or takes longer than it
seemed, that is charged, and A* proposes again, until a path takes no longer than it seemed.

A search is a generator that pauses often, so that whoever runs it can do something else in between, and stops it by
taking no more from it.
"""

import math
from collections.abc import Iterable, Iterator
from enum import Enum
from itertools import islice, zip_longest
from typing import Any

from planner.geometry.tolerance import TIME_S
from planner.motion.edge_hands import EdgeHands
from planner.motion.plan_segment import PlanSegment, duration_s
from planner.motion.transfer_candidate import QUICK, SearchLimits
from planner.planning.budget import Budget, OutOfTimeError
from planner.planning.driving_bound import DrivingBound
from planner.planning.edges import Edges
from planner.planning.events import Obstacles
from planner.planning.heuristic import HEURISTICS, Heuristic, arm_time
from planner.planning.motion_validator import MotionValidator
from planner.planning.problem import Problem
from planner.planning.search_counters import SearchCounters
from planner.planning.sequence_costs import ChargedEdges, Reached
from planner.planning.single_fold import SingleFold
from planner.primitives.obstacle import situation
from planner.primitives.primitive import Step
from planner.primitives.state import State
from planner.search.a_star import Outcome, SearchResult, a_star

# Most plans are found with fewer.
LOOK_ALONE_AFTER = 180
"""Looks at states, or at what may leave them, after which a search checks each fold alone.

Each search counts its own, so that one that follows another still meets what it gives as reasons.
"""

_COLLISIONS_MAX = 12
"""Motions that the arms could not follow for which the blocking contact is looked up."""


class Pause(Enum):
    """Where a search pauses."""

    LOOK = "before a look at a state, or at what may leave it"
    ROUND = "a path was rejected, or takes longer than it seemed"
    END = "the search has ended, and may have missed something quicker"


class _Seen:
    """What a search has seen, and what its validator says of the steps to it: a `Judge` of its edges."""

    def __init__(self, validator: MotionValidator) -> None:
        self.validator = validator
        self.folds_done = 0
        self.states: set[State] = set()

    def possible(self, state: State, steps: Iterable[Step]) -> list[tuple[Step, float]]:
        possible = self.validator.possible(state, steps)
        for step, _ in possible:
            self.folds_done |= step.after.done
            self.states.add(step.after)
        return possible

    def is_in_doubt(self, held: State) -> bool:
        self.states.add(held)
        return self.validator.is_in_doubt(held)


class PathSearch:
    """A search for the quickest path to some folds done, with the obstacles met.

    Attributes:
        problem: the problem to plan.
        budget: the work and the time for the search.
        found: the segments of the quickest path found; None without any. Where no fold is left, there are none.
        known_s: the cost of a known plan, which a path has to beat (s); infinite without one.
        bound_s: a lower bound on the cost of any plan, as long as no step was rejected or made more expensive: after
            that, a raised cost only says that the tries found nothing better, which is no proof.
        blocking: folds that cannot be done even alone.
        counters: what the search has done.
        result: the path proposed last, or how the search ended.
    """

    def __init__(
        self,
        problem: Problem,
        budget: Budget,
        max_expanded: int,
        *,
        wanted: int | None = None,
        hands: EdgeHands | None = None,
    ) -> None:
        """Prepare a search.

        Args:
            problem: the problem to plan; the budget watches it.
            budget: the work and the time for the search.
            max_expanded: the most states to expand at a time.
            wanted: the folds to be done, as a bit mask; None for all.
            hands: has hands hold edges; None where it does not matter how they hold.
        """
        self.problem, self.budget = problem, budget
        self._max_expanded, self._hands = max_expanded, hands
        self._wanted = wanted
        self._all = (1 << len(problem.context.sequence.folds)) - 1 if wanted is None else wanted
        self._seen = _Seen(self._validator_with(QUICK, math.inf))
        self._edges = Edges(problem.context, self._seen)
        self._looks = 0
        self._is_looked_at_alone = False
        self.found: tuple[PlanSegment, ...] | None = None
        self.known_s = math.inf
        self.bound_s: float | None = None
        self.blocking: list[int] = []
        self.counters = SearchCounters()
        self.result: SearchResult[Any, Step] = SearchResult(Outcome.UNFINISHED, (), math.inf, 0.0, 0, 0)
        budget.watch(problem)

    def run(self) -> Iterator[Pause]:
        """Propose, validate and charge, until a path takes no longer than it seemed, or there is none.

        Yields:
            A pause before each look at a state, and after each round in vain.
        """
        bound = self._bound()
        while True:
            yield from self.propose(bound)
            if not self.has_doubts and self.bound_s is None:
                self.bound_s = min(self.result.bound, self.limit_s + TIME_S)
            if self.result.outcome is Outcome.BUDGET_EXCEEDED:
                return
            validator = self._seen.validator
            try:
                with self.counters.on_joints():
                    if validator.catch_up(self.result.cost):
                        continue
                    if self.result.cost >= self.limit_s:
                        self.result = self.result._replace(outcome=Outcome.INFEASIBLE)
                        return
                    found = validator.plan_segments(self.path)
            except OutOfTimeError:
                self.result = self.result._replace(outcome=Outcome.BUDGET_EXCEEDED)
                return
            self.keep(validator.slower or None if found is None else found)
            if found is not None:
                return
            self._seen.states.clear()
            yield Pause.ROUND

    def propose(self, bound: Heuristic, *, is_consistent: bool = True) -> Iterator[Pause]:
        """Search the path that seems to be the quickest by what is known; it is in `result` then."""
        self._edges.begin()
        for result in self._paths(bound, is_consistent=is_consistent):
            self.result = result
            if result.outcome is Outcome.UNFINISHED:
                self._look()
                yield Pause.LOOK
                if self.blocking or self.budget.is_over:
                    self.result = result._replace(outcome=Outcome.BUDGET_EXCEEDED)
                    break
        self.counters.explored += self.result.explored
        self.counters.expanded = self._edges.expanded

    def _paths(self, bound: Heuristic, *, is_consistent: bool) -> Iterator[SearchResult[Any, Step]]:
        start, costs = self.problem.start, self._seen.validator.sequence_costs
        limits = (self._max_expanded, self.limit_s)
        if not costs:
            return a_star(start, self._edges.leaving, self._is_goal, bound, *limits, is_consistent=is_consistent)
        return a_star(
            Reached(start, costs.at_start),
            ChargedEdges(self._edges, costs).leaving,
            lambda node: self._is_goal(node.state),
            lambda node: bound(node.state),
            *limits,
            is_consistent=is_consistent,
        )

    def keep(self, plan_segments: tuple[PlanSegment, ...] | None) -> None:
        """Keep segments that can be performed, if any, if they are quicker than those kept and the known plan."""
        if plan_segments is not None and duration_s(plan_segments) <= self.limit_s:
            self.found = plan_segments

    def run_again(self, search_limits: SearchLimits, transfers_max: float) -> Iterator[Pause]:
        """Search once more, with other limits on what is tried and nothing rejected yet.

        The obstacles keep to the first search: they say what was in the way of the quickest ways.
        """
        validator, states = self._seen.validator, set(self._seen.states)
        self._seen.validator = self._validator_with(search_limits, transfers_max)
        yield from self.run()
        self._seen.validator, self._seen.states = validator, states

    @property
    def path(self) -> tuple[Step, ...]:
        """The steps of the path proposed last; empty without any."""
        return tuple(edge.action for edge in self.result.path)

    @property
    def limit_s(self) -> float:
        """The cost from which on a plan is no quicker than the known one (s)."""
        return min(self.known_s, math.inf if self.found is None else duration_s(self.found)) - TIME_S

    @property
    def has_plan(self) -> bool:
        """Whether some plan is known or was found."""
        return self.known_s < math.inf or self.found is not None

    @property
    def is_settled(self) -> bool:
        """Whether there is a plan, or it is known that there is none."""
        return self.has_plan or bool(self.blocking)

    @property
    def has_doubts(self) -> bool:
        """Whether some steps were rejected, or cost more than the bounds: others, left untried, may then succeed."""
        return self._seen.validator.has_doubts

    @property
    def has_rejected(self) -> bool:
        """Whether some ways are in reach, but the arms could not follow them."""
        return bool(self._seen.validator.rejected)

    @property
    def obstacles(self) -> Obstacles:
        """What stood in the way."""
        reached = frozenset(situation(state) for state in self._seen.states)
        return Obstacles(self.problem, self.budget, self._some_rejected(), reached, self.blocking)

    def _validator_with(self, search_limits: SearchLimits, transfers_max: float) -> MotionValidator:
        """Return a validator with nothing rejected, and limits on what it tries."""
        return MotionValidator(self.problem.maker, self.budget, search_limits, transfers_max, self._hands)

    def _bound(self) -> Heuristic:
        """Return the requested lower bound; it includes driving where the folds have too many orders to search."""
        context, name = self.problem.context, self.problem.task.limits.heuristic
        if self._wanted is not None:
            return arm_time(context, self._wanted)
        if name == "arm_time" and context.sequence.dag.is_loose:
            return DrivingBound(context, self.problem.start, self.budget)
        return HEURISTICS[name](context)

    def _is_goal(self, state: State) -> bool:
        return state.done & self._all == self._all

    def _look(self) -> None:
        """Count a look at a state; after some looks in vain, check each fold alone."""
        self.budget.looks += 1
        self._looks += 1
        if self._looks > LOOK_ALONE_AFTER and not self.has_plan and not self._is_looked_at_alone:
            self._is_looked_at_alone = True
            context = self.problem.context
            alone = SingleFold(context, self.problem.start.station, self.budget)
            # Folds that no state has done yet although no fold that they depend on is left.
            achieved = self._seen.folds_done
            unseen = [f for f in context.sequence.dag.available(achieved) if self._all & ~achieved & 1 << f]
            self.blocking = [fold for fold in unseen if alone.is_impossible(fold)]

    def _some_rejected(self) -> list[tuple[Step, ...]]:
        """Return a few rejected transfers, the first ones of each task, which are its quickest."""
        by_task: dict[tuple[object, ...], list[tuple[Step, ...]]] = {}
        for steps in self._seen.validator.rejected:
            by_task.setdefault(steps[-1].task, []).append(steps)
        in_turns = (steps for turn in zip_longest(*by_task.values()) for steps in turn if steps is not None)
        return list(islice(in_turns, _COLLISIONS_MAX))
