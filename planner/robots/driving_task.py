"""The paths that hands follow, and the standoffs from which they are within the comfort radius on the way. Compiled.

Sets of standoffs are the bits of a number, so that a row of the memory (see `planner.robots.comfort`) answers for all
of them at once. Only what is not remembered is tested, place by place.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planner.kernels import kernel
from planner.robots.arm_query import ArmNumbers, Space, query
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
    """Return what `remembered` does, if this plan and others together have asked about all of it; else -1.

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
