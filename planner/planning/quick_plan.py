"""Find a plan soon: adapt the plan for a similar garment as far as possible, and complete it with a greedy search.

While a garment is being drawn, each drawing differs from the one before by a vertex. The steps that were the quickest
can usually be done again, and usually are still the quickest. To check and validate them anew takes one look per step
instead of a search, so the page can show a plan at once while the search continues.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import islice, zip_longest

from planner.motion.plan_segment import PlanSegment, linked
from planner.motion.transfer_candidate import QUICK
from planner.planning.budget import Budget
from planner.planning.found_plan import FoundPlan
from planner.planning.greedy import greedy
from planner.planning.heuristic import arm_time
from planner.planning.problem import Problem
from planner.planning.search_counters import SearchCounters
from planner.primitives.primitive import Step
from planner.primitives.state import State

_LOOKS_MAX = 12
"""Ways to repeat a transfer that are looked at."""

_BEGUN = 4
"""First steps from which continuations are taken in turns, one each, before further first steps are tried."""

_PATIENT = replace(QUICK, alone=2 * QUICK.alone, together=2 * QUICK.together, late=1)
"""Tries for validating a repeated transfer: twice as many as elsewhere, since one that succeeds saves a search."""


def quickly_planned(
    problem: Problem, like: Sequence[FoundPlan], budget: Budget, *, is_patient: bool = False
) -> FoundPlan | None:
    """Return a plan adapted from similar ones, completed greedily if need be; None if none was found.

    The first plan whose segments can all be repeated is used as it is. Otherwise the plan of which most folds can be
    repeated is the beginning, and a greedy search finds the rest.

    Args:
        problem: the problem to plan.
        like: plans for similar problems.
        budget: ends the search once it is over.
        is_patient: whether the greedy search gives up later.
    """
    context, counters = problem.context, SearchCounters()
    stays = problem.stability_violation is None
    found = _plan_segments(problem, like, counters, budget, is_patient=is_patient) if stays else ()
    plan_segments = linked(found, problem.maker)
    statistics = counters.statistics(context.reach.memory, arm_time(context)(problem.start))
    context.forget()
    return (
        FoundPlan.of(problem, "solved", plan_segments, (), statistics, is_exhaustive=False) if plan_segments else None
    )


def _plan_segments(
    problem: Problem, like: Sequence[FoundPlan], counters: SearchCounters, budget: Budget, *, is_patient: bool
) -> tuple[PlanSegment, ...]:
    """Return all segments to the goal, or none where they were not found."""
    begun: tuple[PlanSegment, ...] = ()
    for plan in like:
        found = () if budget.is_over else _adapted(plan, problem, counters)
        if problem.is_goal(_after(problem, found)):
            return found
        begun = max(begun, found, key=lambda plan_segments: _after(problem, plan_segments).done.bit_count())
    rest = greedy(problem, _after(problem, begun), counters, budget, is_patient=is_patient)
    shift = sum(len(plan_segment.steps) for plan_segment in begun)
    return (*begun, *(replace(plan_segment, first=shift + plan_segment.first) for plan_segment in rest)) if rest else ()


def _after(problem: Problem, plan_segments: Sequence[PlanSegment]) -> State:
    return plan_segments[-1].steps[-1].after if plan_segments else problem.start


def _adapted(plan: FoundPlan, problem: Problem, counters: SearchCounters) -> tuple[PlanSegment, ...]:
    """Repeat the segments of a solved plan in another problem as far as possible, perhaps completely.

    The work done is added to the counters.
    """
    state = problem.start
    plan_segments: list[PlanSegment] = []
    for plan_segment in plan.plan_segments:
        found = None if problem.is_goal(state) else _repeated(plan_segment, problem, state, counters)
        if found is None:
            break
        plan_segments.append(found)
        state = found.steps[-1].after
    return tuple(plan_segments)


def _repeated(
    plan_segment: PlanSegment, problem: Problem, state: State, counters: SearchCounters
) -> PlanSegment | None:
    """Return a segment repeated from a state; None if its steps cannot be done again, or no arms can follow them."""
    ways = islice(_again(plan_segment.steps, problem, state, counters), _LOOKS_MAX)
    likest = next(ways, None)
    if likest is None or plan_segment.transfer is None:
        return None if likest is None else PlanSegment(plan_segment.first, likest, None)
    maker = problem.maker
    with counters.on_joints():
        transfer = maker.made_like(maker.candidate(likest), plan_segment.transfer) or maker.first_valid(ways, _PATIENT)
    return None if transfer is None else PlanSegment(plan_segment.first, transfer.steps, transfer)


def _again(
    steps: Sequence[Step], problem: Problem, state: State, counters: SearchCounters
) -> Iterator[tuple[Step, ...]]:
    """Yield sequences that repeat the steps from a state, the most similar first; hands keep holding where they held.

    There is time to try only a few sequences. They are taken in turns from a few that begin in the most similar ways,
    since whether a sequence can be validated depends mostly on where it begins.
    """
    if not steps:
        yield ()
        return
    counters.expanded += 1
    begun: list[Iterator[tuple[Step, ...]]] = []
    for step in steps[0].again(problem.context, state):
        counters.explored += 1
        if not _may_begin(step, steps, problem):
            continue
        ways = _begun_with(step, steps[1:], problem, counters)
        yield from islice(ways, 1)
        begun.append(ways)
        if len(begun) == _BEGUN:
            yield from _in_turns(begun)
            begun.clear()
    yield from _in_turns(begun)


def _in_turns(begun: Sequence[Iterator[tuple[Step, ...]]]) -> Iterator[tuple[Step, ...]]:
    return (way for turn in zip_longest(*begun) for way in turn if way is not None)


def _may_begin(step: Step, steps: Sequence[Step], problem: Problem) -> bool:
    """Return whether a sequence may begin with this step; checked first because finding what can follow takes long."""
    is_alike = bool(step.after.held) == bool(steps[0].after.held)
    return is_alike and (len(steps) == 1 or problem.maker.can_begin_and_end((step,)))


def _begun_with(
    step: Step, others: Sequence[Step], problem: Problem, counters: SearchCounters
) -> Iterator[tuple[Step, ...]]:
    for rest in _again(others, problem, step.after, counters):
        yield (step, *rest)
