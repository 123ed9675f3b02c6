"""Find some plan soon with a search that goes straight for the goal.

It is the search for the quickest plan with the remaining time weighted several times over (weighted A*, Pohl 1970), so
that it prefers to finish what it has begun. Its plan can be performed, but may be far from the quickest. It gives up
early, since after that it is usually no quicker than the optimal search; a patient one, for tasks in which that has
found nothing for long, tries several times as much.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

from planner.motion.plan_segment import PlanSegment, is_transfer, transfers_of
from planner.motion.transfer import Transfer
from planner.motion.transfer_candidate import QUICK
from planner.planning.budget import Budget
from planner.planning.edges import Edges
from planner.planning.heuristic import arm_time
from planner.planning.problem import Problem
from planner.planning.search_counters import SearchCounters
from planner.primitives.primitive import Step
from planner.primitives.state import State, StateKey
from planner.search.a_star import Outcome, a_star

WEIGHT = 10.0
"""Weight of the remaining time against the time so far."""

_EXPANDED_MAX, _PATIENT_EXPANDED_MAX, _EXPANDED_PER_FOLD = 50, 300, 2
"""States that are expanded, by a patient search too, and further states for each fold."""

_LOOKS_PER_STATE = 12
"""States and deferred successors looked at, per state that may be expanded."""

_FAILURES_MAX, _PATIENT_FAILURES_MAX = 8, 40
"""Transfers that may fail before the search, or a patient one, gives up."""

_ALONE, _TOGETHER = replace(QUICK, ways=4, late=1), replace(QUICK, ways=1, late=1)
"""Tries with one hand, and with both hands, whose failures are mostly final and slow to find."""


def greedy(
    problem: Problem,
    start: State,
    counters: SearchCounters,
    budget: Budget,
    wanted: int | None = None,
    *,
    is_patient: bool = False,
) -> tuple[PlanSegment, ...] | None:
    """Find segments that lead from a state to the goal.

    Args:
        problem: the problem to plan.
        start: the state to start from.
        counters: counters that the work is added to.
        budget: ends the search once it is over.
        wanted: the folds to be done, as a bit mask that includes the folds they depend on; None for all.
        is_patient: whether to give up later.

    Returns:
        The segments, the first beginning with primitive 0; None where the search soon found no way that the arms can
            follow.
    """
    return _Greedy(problem, counters, budget, wanted, is_patient=is_patient).plan_segments(start)


class _Greedy:
    """A greedy search in one planning problem, and the `Judge` of its edges, which it does not keep."""

    def __init__(
        self, problem: Problem, counters: SearchCounters, budget: Budget, wanted: int | None, *, is_patient: bool
    ) -> None:
        self._problem = problem
        self._counters = counters
        self._budget = budget
        self._failures_max = _PATIENT_FAILURES_MAX if is_patient else _FAILURES_MAX
        expanded_max = _PATIENT_EXPANDED_MAX if is_patient else _EXPANDED_MAX
        self._expanded_max = expanded_max + _EXPANDED_PER_FOLD * len(problem.context.sequence.folds)
        self._looks_left = _LOOKS_PER_STATE * self._expanded_max + 1
        self._wanted = (1 << len(problem.context.sequence.folds)) - 1 if wanted is None else wanted
        self._remaining = arm_time(problem.context, self._wanted)
        self._struck: set[tuple[StateKey, StateKey]] = set()
        self._doubted: set[tuple[object, ...]] = set()
        self._made: dict[tuple[StateKey, ...], Transfer | None] = {}

    def plan_segments(self, start: State) -> tuple[PlanSegment, ...] | None:
        edges = Edges(self._problem.context, self)
        while len(self._struck) < self._failures_max and not self._budget.is_over:
            path = self._path(start, edges)
            if not path:
                return None
            with self._counters.on_joints():
                found = self._validated(path)
            if found is not None:
                return found
        return None

    def possible(self, _state: State, steps: Iterable[Step]) -> Iterator[tuple[Step, float]]:
        return ((step, step.duration_s) for step in steps if _ends(step) not in self._struck)

    def is_in_doubt(self, held: State) -> bool:
        return held.grasp in self._doubted

    def _path(self, start: State, edges: Edges) -> list[Step]:
        """Return the steps of a path to the goal; empty where none is found soon."""
        edges.begin()
        for result in a_star(
            start,
            edges.leaving,
            lambda state: state.done & self._wanted == self._wanted,
            lambda state: WEIGHT * self._remaining(state),
            self._expanded_max,
            is_consistent=False,
        ):
            if result.outcome is Outcome.UNFINISHED:
                self._looks_left -= 1
                if self._looks_left < 0 or self._budget.is_over:
                    break
        self._counters.expanded += result.expanded
        self._counters.explored += result.explored
        return [edge.action for edge in result.path]

    def _validated(self, steps: Sequence[Step]) -> tuple[PlanSegment, ...] | None:
        """Validate steps, transfer by transfer; where a transfer fails, reject its last step."""
        plan_segments = []
        for first, part in transfers_of(steps):
            plan_segment = None if self._budget.is_over else self._segment(first, part)
            if plan_segment is None:
                self._struck.add(_ends(part[-1]))
                self._doubted.update(step.after.grasp for step in part if step.after.held)
                return None
            plan_segments.append(plan_segment)
        return tuple(plan_segments)

    def _segment(self, first: int, steps: tuple[Step, ...]) -> PlanSegment | None:
        if not is_transfer(steps):
            return PlanSegment(first, steps, None)
        key = (steps[0].before.key, *(step.after.key for step in steps))
        if key not in self._made:
            search_limits = _ALONE if all(len(step.grips) == 1 for step in steps) else _TOGETHER
            self._made[key] = self._problem.maker.validated(steps, search_limits)
        transfer = self._made[key]
        return None if transfer is None else PlanSegment(first, transfer.steps, transfer)


def _ends(step: Step) -> tuple[StateKey, StateKey]:
    return step.before.key, step.after.key
