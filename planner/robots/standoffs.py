"""The standoffs from which a tool is within the comfort radius at each of many points: the search's queries, compiled.

The naive way takes points x approaches x standoffs x five points of exact queries, and a search repeats them again and
again. Besides the memory (see `planner.robots.comfort`) two things make it cheap:

- *Early rejection.* A path is followed in one orientation, so an approach is dropped at the first point that no
  standoff reaches. A path's end and middle are tested first: they are the likeliest to fail.
- *Only what matters.* Of two hands the second is queried where the first can be. Where the end is given, an approach is
  dropped if the last point is out of reach from there.
- *Centre first.* The points on the comfort circle are tested only where the centre is reachable.

Arguments dominate the cost of a call, so an arm comes in few arrays (see `planner.robots.arm_query`).
"""

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.kernels import kernel
from planner.robots.arm_query import ArmNumbers, ArmQuery, Space, is_in_height, query, space_for
from planner.robots.comfort import (
    FORGETFUL,
    GOOD,
    KNOWN,
    Memory,
    cell_of,
    cells_of,
    is_comfortable_at,
    row_slot,
    to_cell,
)
from planner.robots.place import Place, place_of

ALL = -1
"""Every standoff, of however many."""


@kernel
def _is_out_of_reach(
    ask: ArmQuery, arm: ArmNumbers, memory: Memory, space: Space, place: Place, count: int, among: int
) -> bool:
    """Return whether none of some standoffs reaches a place: of all of them where `among` is `ALL`."""
    if not is_in_height(ask, place):
        return True
    slot, standoff = row_slot(ask.label, memory.keys, memory.counts, place), 0
    if slot != FORGETFUL:
        wanted = cells_of(place.x, count)
        if among != ALL:
            wanted &= to_cell(among, cell_of(place.x))
        if memory.bits[slot, GOOD] & wanted != 0:
            return False
        if memory.bits[slot, KNOWN] & wanted == wanted:
            return True
    while standoff < count:
        is_one = among == ALL or (among >> standoff) & 1 == 1
        if is_one and is_comfortable_at(ask, arm, memory, space, slot, place, standoff):
            return False
        standoff += 1
    return True


@kernel
def _arrivals(
    ask: ArmQuery, arm: ArmNumbers, memory: Memory, space: Space, place: Place, before: int, count: int, among: int
) -> int:
    """Return those of some standoffs at which the base may be at a place, having come from some at the place before.

    These are the standoffs it came from that reach the place too, and those to which it can drive on from there.
    """
    mask, slot = 0, row_slot(ask.label, memory.keys, memory.counts, place)
    for standoff in range(count):
        is_next = standoff > 0 and (mask >> (standoff - 1)) & 1 == 1
        if (among >> standoff) & 1 == 1 and ((before >> standoff) & 1 == 1 or is_next):
            mask |= (1 if is_comfortable_at(ask, arm, memory, space, slot, place, standoff) else 0) << standoff
    for standoff in range(count - 2, -1, -1):
        is_new = (among >> standoff) & 1 == 1 and (before >> standoff) & 1 == 0 and (mask >> standoff) & 1 == 0
        if is_new and (mask >> (standoff + 1)) & 1 == 1:
            mask |= (1 if is_comfortable_at(ask, arm, memory, space, slot, place, standoff) else 0) << standoff
    return mask


@kernel
def standoff_masks(
    arm: ArmNumbers,
    shoulder: FloatArray,
    memory: Memory,
    points: FloatArray,
    labels: NDArray[np.int64],
    count: int,
    comfort: float,
    before: int,
    among: NDArray[np.int64],
    ends: int,
) -> NDArray[np.uint32]:
    """Return for each approach and point a bit mask of the standoffs within the comfort radius.

    Args:
        arm: the arm.
        shoulder: its shoulder, in the frame of the points (m), shape (3,).
        memory: earlier answers for this comfort radius; added to.
        points: tool points at standoff 0 (m), shape (n, 3).
        labels: the memory's labels of the approaches tested, shape (k,).
        count: the number of standoffs, at most 32.
        comfort: the comfort radius (m).
        before: bit mask of the standoffs from which the base may come to the first point.
        among: bit masks of the standoffs that matter at each point, shape (n,).
        ends: bit mask of the standoffs at one of which the base is to be in the end.
    """
    space = space_for(arm)
    masks = np.zeros((len(labels), len(points)), dtype=np.uint32)
    places = [place_of(point, shoulder) for point in points]
    full = (1 << count) - 1
    for approach in range(len(labels)):
        ask = query(arm, labels[approach], comfort)
        is_dead, last = False, len(points) - 1
        for i in (last, len(points) // 2):
            matter = int(among[i]) & (ends if i == last else full)
            is_dead = is_dead or (i > 0 and _is_out_of_reach(ask, arm, memory, space, places[i], count, matter))
        if is_dead:
            continue
        mask = before
        for i in range(len(points)):
            mask = _arrivals(ask, arm, memory, space, places[i], mask, count, int(among[i]))
            if i == last and mask & ends == 0:
                mask = 0
            masks[approach, i] = mask
            if mask == 0:
                masks[approach, :] = 0
                break
    return masks


@kernel
def anywhere(
    arm: ArmNumbers,
    shoulder: FloatArray,
    memory: Memory,
    points: FloatArray,
    labels: NDArray[np.int64],
    count: int,
    comfort: float,
) -> BoolArray:
    """Return for each approach and point, each on its own, whether some standoff is within the comfort radius.

    The arguments are those of `standoff_masks`, but there may be any number of standoffs, which all matter.
    """
    space = space_for(arm)
    answers = np.zeros((len(labels), len(points)), dtype=np.bool_)
    places = [place_of(point, shoulder) for point in points]
    for approach in range(len(labels)):
        ask = query(arm, labels[approach], comfort)
        for i in range(len(points)):
            answers[approach, i] = not _is_out_of_reach(ask, arm, memory, space, places[i], count, ALL)
    return answers
