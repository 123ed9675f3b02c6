"""The least driving with which hands follow their paths, compiled.

Each hand keeps one approach. At every waypoint the base may drive to and fro as long as every hand, resting, is within
the comfort radius at each standoff on the way. The task is to choose the approaches and the standoffs so that the base
drives least.

The naive way finds the standoffs for every approach at every waypoint, combines the approaches of all hands, and
searches for the shortest way through each combination. Nearly all of that work is unnecessary. Instead:

- *By rising cost.* A set of standoffs is the bits of a number. With `t` steps of driving the base can be where it can
  be with `t - 1`, one step beside that, and where it was at the waypoint before with `t`: a few operations on numbers,
  and only places that occur are ever tested.
- *Bounds first.* The beginning, the apex and the end of a path alone mostly tell the least driving of a combination, or
  that it is infeasible.
- *Pruning by incumbents.* A place matters with `t` steps only if no end found so far is as good from there.
- *Limited steps.* Ways of more than `most` steps are left for a later call.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planner.geometry.driving import IMPOSSIBLE
from planner.kernels import kernel
from planner.robots.arm_query import ArmNumbers, Space, query, space_for
from planner.robots.comfort import (
    FORGETFUL,
    GOOD,
    KNOWN,
    PASSED,
    ROW_CELLS,
    TESTED,
    Memory,
    from_cell,
    is_comfortable_at,
    recall,
    row_slot,
)
from planner.robots.place import Place

UNSEEN = -2
"""The slot of a row that has not been looked up."""

_WHOLE_ROW = (1 << ROW_CELLS) - 1


class DrivingTask(NamedTuple):
    """The paths that hands follow.

    Attributes:
        arm: the arms, see `planner.robots.arm_query`.
        memory: earlier answers for this comfort radius; added to.
        labels: for each hand the memory's labels of the approaches it may use, best first, 0 after the last; shape
            (hands, k).
        places: for each hand and waypoint the place, in steps of `LENGTH_M`, shape (hands, n, 3).
        cells: for each hand and waypoint the place's cell in its row, shape (hands, n).
        slots: for each hand, approach and waypoint the row's slot in the memory, `UNSEEN` until it is looked up; shape
            (hands, k, n); added to.
        comfort: the comfort radius (m).
    """

    arm: ArmNumbers
    memory: Memory
    labels: NDArray[np.int64]
    places: NDArray[np.int64]
    cells: NDArray[np.int64]
    slots: NDArray[np.int64]
    comfort: float


@kernel
def ask_each(task: DrivingTask, space: Space, hand: int, approach: int, waypoint: int, wanted: int) -> int:
    """Return which of the wanted standoffs have one hand within the comfort radius, testing them one by one."""
    x, y, z = task.places[hand, waypoint]
    place, label, memory = Place(x, y, z), task.labels[hand, approach], task.memory
    slot, found, standoff = row_slot(label, memory.keys, memory.counts, place), 0, 0
    task.slots[hand, approach, waypoint] = slot
    if slot != FORGETFUL:
        cell = task.cells[hand, waypoint]
        found = recalled(memory.bits, memory.counts, slot, cell, wanted, task.comfort)
        if found >= 0:
            return found
        found = wanted & from_cell(memory.bits[slot, GOOD], cell)
        wanted &= ~from_cell(memory.bits[slot, KNOWN], cell)
    ask = query(task.arm, label, task.comfort)
    while wanted >> standoff:
        is_wanted = (wanted >> standoff) & 1 == 1
        if is_wanted and is_comfortable_at(ask, task.arm, memory, space, slot, place, standoff):
            found |= 1 << standoff
        standoff += 1
    return found


@kernel
def remembered(bits: NDArray[np.int64], slot: int, cell: int, wanted: int) -> int:
    """Return which wanted standoffs are within the comfort radius, if a row remembers all of them; else -1."""
    if slot < 0 or wanted & from_cell(_WHOLE_ROW, cell) & ~from_cell(bits[slot, KNOWN], cell):
        return -1
    return wanted & from_cell(bits[slot, GOOD], cell)


@kernel
def recalled(
    bits: NDArray[np.int64], counts: NDArray[np.int64], slot: int, cell: int, wanted: int, comfort: float
) -> int:
    """Return what `remembered` does, if this plan and others together have queried all of it; else -1.

    The plan is charged for what it learns by it. It takes few arguments: passing a task on costs more than all this.
    """
    if slot < 0:
        return -1
    new = wanted & from_cell(_WHOLE_ROW & ~bits[slot, KNOWN], cell)
    if new & ~from_cell(bits[slot, TESTED] | bits[slot, PASSED], cell):
        return -1
    recall(bits, counts, slot, new << cell if cell >= 0 else new >> -cell, comfort)
    return wanted & from_cell(bits[slot, GOOD], cell)


@kernel
def at_extremes(task: DrivingTask, space: Space, hand: int, near: int) -> NDArray[np.int64]:
    """Return the near standoffs within the comfort radius at the beginning, apex and end of a hand's path.

    Shape (k, 3), for each approach; all 0 where one of them is.
    """
    last = task.places.shape[1] - 1
    bits, counts, slots, cells = task.memory.bits, task.memory.counts, task.slots[hand], task.cells[hand]
    masks = np.zeros((task.labels.shape[1], 3), dtype=np.int64)
    for approach in range(task.labels.shape[1]):
        if task.labels[hand, approach] == 0:
            break
        for number, waypoint in ((1, (last + 1) // 2), (2, last), (0, 0)):
            slot, cell = slots[approach, waypoint], cells[waypoint]
            found = remembered(bits, slot, cell, near)
            found = found if found >= 0 else recalled(bits, counts, slot, cell, near, task.comfort)
            found = found if found >= 0 else ask_each(task, space, hand, approach, waypoint, near)
            masks[approach, number] = found
            if found == 0:
                masks[approach] = 0
                break
    return masks


UNBEATEN, EVERY, ANY = range(3)
"""Values for the ends wanted, see `planner.geometry.driving.Wanted`."""


class Incumbents(NamedTuple):
    """The best ends so far and the places that may improve them; sets are the bits of numbers, one for each level.

    Attributes:
        wanted: which ends.
        ends: the least steps to each standoff so far, shape (count,).
        possible: the standoffs that may be ends at all, shape (1,).
        near: the steps to each standoff with nothing in the way, a lower bound for any end; shape (count,).
        begun: where the base can be when the hands begin, shape (levels,).
        useful: from where an end can still be improved, shape (levels,).
    """

    wanted: int
    ends: NDArray[np.int64]
    possible: NDArray[np.int64]
    near: NDArray[np.int64]
    begun: NDArray[np.int64]
    useful: NDArray[np.int64]


@kernel
def no_incumbents(begun: NDArray[np.int64], most: int, wanted: int) -> Incumbents:
    """Return the incumbents of a search that starts, with no end found, and considers at most `most` steps."""
    count = len(begun)
    levels = min(most, 3 * count) + 1
    near, sets = begun.copy(), np.empty(levels, dtype=np.int64)
    _spread(near)
    _sets(begun, sets)
    ends, possible = np.full(count, IMPOSSIBLE, dtype=np.int64), np.array([(1 << count) - 1])
    best = Incumbents(wanted, ends, possible, near, ~sets & possible[0], np.empty(levels, dtype=np.int64))
    tell_useful(best)
    return best


@kernel
def tell_useful(best: Incumbents) -> None:
    """Update from where an end can still be improved.

    Where unbeaten ends are wanted, the base can drive on from one end to another with nothing in the way; else only the
    end itself counts.
    """
    count, ends = len(best.ends), best.ends
    limits = np.zeros(count, dtype=np.int64)
    if best.wanted == ANY and ends.min() < IMPOSSIBLE:
        pass
    elif best.wanted == EVERY:
        for j in range(count):
            for end in range(count):
                if (best.possible[0] >> end) & 1 and ends[end] > best.near[end]:
                    limits[j] = max(limits[j], ends[end] - abs(j - end))
    else:
        limits[:] = ends
        _spread(limits)
    _sets(limits, best.useful)


@kernel
def least_steps(begun: NDArray[np.int64], useful: NDArray[np.int64], begin: int, apex: int, end: int) -> int:
    """Return the least steps in which the base can be in three sets one after the other and still improve an end."""
    after_begin, after_apex = 0, 0
    for level in range(len(begun)):
        after_begin |= after_begin << 1 | after_begin >> 1 | begun[level] & begin
        after_apex |= after_apex << 1 | after_apex >> 1 | after_begin & apex
        if after_apex & end & useful[level]:
            return level
        if useful[level] == 0:
            return IMPOSSIBLE
    return IMPOSSIBLE


@kernel
def _sets(steps: NDArray[np.int64], sets: NDArray[np.int64]) -> None:
    """Set for each number of steps the standoffs that have larger entries in `steps`."""
    sets[:] = 0
    for j in range(len(steps)):
        for level in range(min(steps[j], len(sets))):
            sets[level] |= 1 << j


@kernel
def _spread(steps: NDArray[np.int64]) -> None:
    """Let the base drive from every place with nothing in its way."""
    for j in range(1, len(steps)):
        steps[j] = min(steps[j], steps[j - 1] + 1)
    for j in range(len(steps) - 2, -1, -1):
        steps[j] = min(steps[j], steps[j + 1] + 1)


@kernel
def _follow(
    task: DrivingTask, space: Space, chosen: NDArray[np.int64], best: Incumbents, answer: NDArray[np.int64]
) -> bool:
    """Follow the paths in one choice of approaches and record improved ends; return whether more steps may help."""
    bits, counts, slots, cells, useful = task.memory.bits, task.memory.counts, task.slots, task.cells, best.useful
    reached, last_begun = np.zeros(cells.shape[1], dtype=np.int64), 0
    for level in range(len(best.begun)):
        before, has_grown = best.begun[level], best.begun[level] != last_begun
        last_begun = before
        if useful[level] == 0:
            return False
        for waypoint in range(len(reached)):
            here = reached[waypoint]
            new = (before | here << 1 | here >> 1) & ~here & useful[level]
            for hand in range(len(chosen) if new else 0):
                approach = chosen[hand]
                slot, cell = slots[hand, approach, waypoint], cells[hand, waypoint]
                found = remembered(bits, slot, cell, new)
                found = found if found >= 0 else recalled(bits, counts, slot, cell, new, task.comfort)
                new = found if found >= 0 else ask_each(task, space, hand, approach, waypoint, new)
            reached[waypoint] = before = here | new
            has_grown = has_grown or new != 0
            if before == 0:
                break
        is_better = False
        for end in range(len(best.ends) if before & best.useful[level] else 0):
            if (before >> end) & 1 and level < best.ends[end] and (best.useful[level] >> end) & 1:
                best.ends[end], answer[2:, end] = level, chosen
                is_better = True
                if best.wanted == UNBEATEN:
                    tell_useful(best)
        if is_better:
            tell_useful(best)
        if not has_grown and level >= best.near.max():
            return False
    return bool(best.useful[-1] != 0)


@kernel
def least_driving(task: DrivingTask, begun: NDArray[np.int64], most: int, wanted: int) -> tuple[NDArray[np.int64], int]:
    """Return the least total steps of driving for each standoff at which the base may stand in the end.

    Args:
        task: the paths that the hands follow.
        begun: for each standoff the steps in which the base can be there when the hands begin, shape (count,); count at
            most 32.
        most: the largest number of steps considered.
        wanted: which ends, see `planner.geometry.driving.Wanted`.

    Returns:
        For each standoff a column of the steps (`IMPOSSIBLE` if there is no way), where the base begins, and each
        hand's approach, shape (2 + hands, count); and the least steps that a way left out for `most` might take.
    """
    hands, count, space = len(task.labels), len(begun), space_for(task.arm)
    answer = np.full((2 + hands, count), IMPOSSIBLE, dtype=np.int64)
    best = no_incumbents(begun, most, wanted)
    near = 0
    for j in range(count):
        near |= (1 if best.near[j] <= most else 0) << j
    more = most + 1 if best.near.max() > most else IMPOSSIBLE
    masks = np.empty((hands, task.labels.shape[1], 3), dtype=np.int64)
    for hand in range(hands):
        masks[hand] = at_extremes(task, space, hand, near)
        if not masks[hand].any():
            return answer, more
    choices, shared, bounds = _choices(masks, best)
    for number in np.argsort(bounds, kind="mergesort"):
        begin, apex, end = shared[number]
        if bounds[number] < IMPOSSIBLE and least_steps(best.begun, best.useful, begin, apex, end) < IMPOSSIBLE:
            if _follow(task, space, choices[number], best, answer):
                more = min(more, most + 1)
        elif bounds[number] == IMPOSSIBLE and best.useful[-1] != 0:
            more = min(more, most + 1)
    answer[0] = best.ends
    _settle(task, space, begun, wanted, answer)
    return answer, more


@kernel
def _choices(
    masks: NDArray[np.int64], best: Incumbents
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Return the feasible choices of approaches, the standoffs at which all hands are within reach, and lower bounds.

    Those standoffs are at the beginning, apex and end of the path. The bounds are on the steps of each choice. The
    possible ends are recorded.
    """
    hands, (choices, shared) = len(masks), _of_first_hand(masks)
    for hand in range(1, hands):
        able, count = np.flatnonzero(masks[hand, :, 0]), 0
        more = np.empty((len(choices) * len(able), hands), dtype=np.int64)
        both = np.empty((len(more), 3), dtype=np.int64)
        for number in range(len(choices)):
            for one in able:
                begin, apex, end = shared[number] & masks[hand, one]
                if begin and apex and end:
                    more[count], both[count] = choices[number], (begin, apex, end)
                    more[count, hand] = one
                    count += 1
        choices, shared = more[:count], both[:count]
    best.possible[0] = 0
    for _, _, end in shared:
        best.possible[0] |= end
    tell_useful(best)
    bounds = np.empty(len(choices), dtype=np.int64)
    for number in range(len(choices)):
        begin, apex, end = shared[number]
        bounds[number] = least_steps(best.begun, best.useful, begin, apex, end)
    return choices, shared, bounds


@kernel
def _of_first_hand(masks: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the choices of the first hand's approach alone, and the standoffs within its reach."""
    able = np.flatnonzero(masks[0, :, 0])
    choices, shared = np.zeros((len(able), len(masks)), dtype=np.int64), np.empty((len(able), 3), dtype=np.int64)
    for number in range(len(able)):
        choices[number, 0], shared[number] = able[number], masks[0, able[number]]
    return choices, shared


@kernel
def _settle(task: DrivingTask, space: Space, begun: NDArray[np.int64], wanted: int, answer: NDArray[np.int64]) -> None:
    """Remove ends that were beaten later on, and find where the base begins on the way to the others."""
    count = len(begun)
    alone, found = np.empty(count, dtype=np.int64), np.empty_like(answer)
    for end in range(count):
        for other in range(count if wanted == UNBEATEN else 0):
            if other != end and answer[0, other] + abs(end - other) <= answer[0, end]:
                answer[0, end] = IMPOSSIBLE
        for first in range(count if answer[0, end] < IMPOSSIBLE else 0):
            alone[:] = IMPOSSIBLE
            alone[first] = begun[first]
            if begun[first] + abs(end - first) <= answer[0, end]:
                best = no_incumbents(alone, answer[0, end], EVERY)
                best.possible[0] = 1 << end
                tell_useful(best)
                _follow(task, space, answer[2:, end].copy(), best, found)
                if best.ends[end] == answer[0, end]:
                    answer[1, end] = first
                    break
