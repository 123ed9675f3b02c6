"""Take hands away from a plan where that makes it quicker.

The search prefers ways that hold the cloth firmly, with more hands, among ways that seem to take equally long. More
hands have further to go between transfers, which is known only once all transfers follow one another.
"""

from collections import Counter
from collections.abc import Iterator, Sequence

from planner.geometry.tolerance import TIME_S
from planner.motion.act import Act, duration_s, in_turn
from planner.motion.transfer_planner import TransferPlanner
from planner.motion.tries import Tries
from planner.primitives.primitive import Step

WORTH_S = 0.1
"""The time that taking hands away from one act must save in all (s): for less the cloth is rather held firmly."""


def with_fewer_hands(
    acts: Sequence[Act], maker: TransferPlanner, tries: Tries, worth_s: float = WORTH_S
) -> tuple[Act, ...]:
    """Return acts that follow one another, with fewer hands where that is quicker.

    Args:
        acts: the acts of a validated plan.
        maker: plans the transfers.
        tries: how many ways are tried for each act.
        worth_s: the time that each change must save (s).
    """
    best = tuple(acts)
    for number, act in enumerate(acts):
        if duration_s(best) <= sum(step.duration_s for one in best for step in one.steps) + TIME_S:
            break
        others = (in_turn((*best[:number], one, *best[number + 1 :]), maker) for one in _with_fewer(act, maker, tries))
        quickest = min(others, key=duration_s, default=best)
        if duration_s(quickest) < duration_s(best) - worth_s - TIME_S:
            best = quickest
    return best


def _with_fewer(act: Act, maker: TransferPlanner, tries: Tries) -> Iterator[Act]:
    """Yield the first few valid acts between the same states for each choice of fewer arms."""
    ways = () if act.transfer is None else _ways(act.steps, tries)
    valid: Counter[tuple[object, ...]] = Counter()
    for candidate in maker.candidates(way for way in ways if valid[_arms(way)] < tries.late):
        transfer = maker.made(candidate)
        if transfer is not None:
            valid[candidate.kind] += 1
            yield Act(act.first, transfer.steps, transfer)


def _ways(steps: Sequence[Step], tries: Tries) -> Iterator[tuple[Step, ...]]:
    """Yield the first few ways for each choice of fewer arms."""
    tried: Counter[tuple[object, ...]] = Counter()
    for number, step in enumerate(steps):
        for fewer in step.with_fewer_hands():
            way = (*steps[:number], fewer, *steps[number + 1 :])
            tried[_arms(way)] += 1
            if tried[_arms(way)] <= tries.variants:
                yield way


def _arms(steps: Sequence[Step]) -> tuple[object, ...]:
    """Return the key shared by ways of the same steps with the same arms."""
    return tuple(step.task for step in steps)
