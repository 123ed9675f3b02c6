"""Adapt a plan for one garment to a similar one: repeat its primitives, and check and validate them anew.

While a garment is being drawn, each drawing differs from the one before by a vertex. The primitives that were the
quickest can usually be done again, and usually are still the quickest. Checking this takes one step per primitive
instead of a search, so the page can show a plan at once while the search continues.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import islice, zip_longest

from planner.motion.plan_segment import PlanSegment
from planner.motion.transfer_candidate import QUICK
from planner.planning.effort import Effort
from planner.planning.found_plan import FoundPlan
from planner.planning.problem import Problem
from planner.primitives.primitive import Step
from planner.primitives.state import State

_LOOKS_MAX = 12
"""Ways to repeat a transfer that are looked at."""

_BEGUN = 4
"""First steps from which continuations are taken in turns, one each, before further first steps are tried."""

_PATIENT = replace(QUICK, alone=2 * QUICK.alone, together=2 * QUICK.together, late=1)
"""Tries for validating a repeated transfer: twice as many as elsewhere, since one that succeeds saves a search."""


def adapted(plan: FoundPlan, problem: Problem, effort: Effort) -> tuple[PlanSegment, ...]:
    """Repeat the segments of a solved plan in another problem as far as possible, perhaps completely.

    The work done is added to the effort.
    """
    state = problem.start
    plan_segments: list[PlanSegment] = []
    for plan_segment in plan.plan_segments:
        found = None if problem.is_goal(state) else _act(plan_segment, problem, state, effort)
        if found is None:
            break
        plan_segments.append(found)
        state = found.steps[-1].after
    return tuple(plan_segments)


def _act(plan_segment: PlanSegment, problem: Problem, state: State, effort: Effort) -> PlanSegment | None:
    ways = islice(_again(plan_segment.steps, problem, state, effort), _LOOKS_MAX)
    likest = next(ways, None)
    if likest is None or plan_segment.transfer is None:
        return None if likest is None else PlanSegment(plan_segment.first, likest, None)
    maker = problem.maker
    with effort.on_joints():
        transfer = maker.made_like(maker.candidate(likest), plan_segment.transfer) or maker.first_valid(ways, _PATIENT)
    return None if transfer is None else PlanSegment(plan_segment.first, transfer.steps, transfer)


def _again(steps: Sequence[Step], problem: Problem, state: State, effort: Effort) -> Iterator[tuple[Step, ...]]:
    """Yield sequences that repeat the steps from a state, the most similar first; hands keep holding where they held.

    There is time to try only a few sequences. They are taken in turns from a few that begin in the most similar ways,
    since whether a sequence can be validated depends mostly on where it begins.
    """
    if not steps:
        yield ()
        return
    effort.expanded += 1
    begun: list[Iterator[tuple[Step, ...]]] = []
    for step in steps[0].again(problem.context, state):
        effort.explored += 1
        if not _may_begin(step, steps, problem):
            continue
        ways = _begun_with(step, steps[1:], problem, effort)
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


def _begun_with(step: Step, others: Sequence[Step], problem: Problem, effort: Effort) -> Iterator[tuple[Step, ...]]:
    for rest in _again(others, problem, step.after, effort):
        yield (step, *rest)
