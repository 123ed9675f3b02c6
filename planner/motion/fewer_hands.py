"""Take hands away from a plan where that makes it quicker.

The search prefers ways that hold the cloth firmly, with more hands, among ways that seem to take equally long. More
hands have further to go between transfers, which is known only once all transfers follow one another.
"""

from collections import Counter
from collections.abc import Iterator, Sequence

from planner.geometry.tolerance import TIME_S
from planner.motion.plan_segment import PlanSegment, duration_s, linked
from planner.motion.search_limits import SearchLimits
from planner.motion.transfer_planner import TransferPlanner
from planner.primitives.primitive import Step

WORTH_S = 0.1
"""The time that taking hands away from one segment must save in all (s): for less the cloth is rather held firmly."""


def with_fewer_hands(
    plan_segments: Sequence[PlanSegment], maker: TransferPlanner, search_limits: SearchLimits, worth_s: float = WORTH_S
) -> tuple[PlanSegment, ...]:
    """Return segments that follow one another, with fewer hands where that is quicker.

    Args:
        plan_segments: the segments of a validated plan.
        maker: plans the transfers.
        search_limits: how many ways are tried for each segment.
        worth_s: the time that each change must save (s).
    """
    best = tuple(plan_segments)
    for number, plan_segment in enumerate(plan_segments):
        if duration_s(best) <= sum(step.duration_s for one in best for step in one.steps) + TIME_S:
            break
        others = (
            linked((*best[:number], one, *best[number + 1 :]), maker)
            for one in _with_fewer(plan_segment, maker, search_limits)
        )
        quickest = min(others, key=duration_s, default=best)
        if duration_s(quickest) < duration_s(best) - worth_s - TIME_S:
            best = quickest
    return best


def _with_fewer(
    plan_segment: PlanSegment, maker: TransferPlanner, search_limits: SearchLimits
) -> Iterator[PlanSegment]:
    """Yield the first few valid segments between the same states for each choice of fewer arms."""
    ways = () if plan_segment.transfer is None else _ways(plan_segment.steps, search_limits)
    valid: Counter[tuple[object, ...]] = Counter()
    for candidate in maker.candidates(way for way in ways if valid[_arms(way)] < search_limits.late):
        transfer = maker.made(candidate)
        if transfer is not None:
            valid[candidate.kind] += 1
            yield PlanSegment(plan_segment.first, transfer.steps, transfer)


def _ways(steps: Sequence[Step], search_limits: SearchLimits) -> Iterator[tuple[Step, ...]]:
    """Yield the first few ways for each choice of fewer arms."""
    tried: Counter[tuple[object, ...]] = Counter()
    for number, step in enumerate(steps):
        for fewer in step.with_fewer_hands():
            way = (*steps[:number], fewer, *steps[number + 1 :])
            tried[_arms(way)] += 1
            if tried[_arms(way)] <= search_limits.variants:
                yield way


def _arms(steps: Sequence[Step]) -> tuple[object, ...]:
    """Return the key shared by ways of the same steps with the same arms."""
    return tuple(step.task for step in steps)
