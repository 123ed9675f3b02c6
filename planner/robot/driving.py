"""The least driving with which hands follow their paths. The search's one question, compiled.

Each hand keeps one approach. At every waypoint the base may drive to and fro as long as every hand, resting, is in
comfort at each back-off on the way. Which approaches, and where to stand, so that the base drives least?

The naive way finds the back-offs for every approach at every waypoint, combines the approaches of all hands, and looks
for the shortest way through each combination. Nearly all of that is idle. Instead:

- *In the order of cost.* A set of back-offs is the bits of a number. With `t` steps of driving the base can be where it
  can be with `t - 1`, one step beside that, and where it was at the waypoint before with `t`: a few operations on
  numbers, and only places that come up are ever asked for.
- *Bounds first.* The beginning, the apex and the end of a path, looked at alone, mostly tell how far the base must
  drive at least in a combination, or that it is hopeless.
- *Only what can still be better.* A place matters with `t` steps only if no end found so far is as good from there.
- *No more than asked.* What takes more than `most` steps is left for another time.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from planner.geometry.driving import IMPOSSIBLE
from planner.geometry.pose import FloatArray
from planner.robot.comfort import (
    GOOD,
    KNOWN,
    ROW_CELLS,
    ROW_STEP,
    Memory,
    Place,
    from_cell,
    is_comfortable_at,
    question,
    row_slot,
)
from planner.robot.kernel import MOST_ARCS
from planner.robot.posture_room import Room

UNBEATEN, EVERY, ANY = range(3)
"""Which ends are wanted, see `planner.geometry.driving.Wanted`."""

UNSEEN = -2
"""The slot of a row that nobody has asked for."""

_WHOLE_ROW = (1 << ROW_CELLS) - 1


class Task(NamedTuple):
    """What hands are to follow.

    Attributes:
        numbers: the arm, see `planner.robot.kernel.shape_of`.
        shoulder: where its shoulder is, in the base frame (m), shape (3,).
        memory: what was answered before, for this comfort; added to.
        axes: all approach axes, shape (m, 3).
        labels: for each hand what the memory calls the approaches it may use, best first, 0 after the last; shape
            (hands, k).
        places: for each hand, one or two, and waypoint the place, in steps of `LENGTH_M`, shape (hands, n, 3).
        cells: for each hand and waypoint the place's cell in its row, shape (hands, n).
        slots: for each hand, approach and waypoint where in the memory its row is, if the base drives by the row's
            step; `UNSEEN` until it has been asked for. Shape (hands, k, n); added to.
        comfort: radius of the comfort circle (m).
        step: from one back-off to the next, in steps of `LENGTH_M`.
        room: what the arms may be hindered by.
    """

    numbers: FloatArray
    shoulder: FloatArray
    memory: Memory
    axes: FloatArray
    labels: NDArray[np.int64]
    places: NDArray[np.int64]
    cells: NDArray[np.int64]
    slots: NDArray[np.int64]
    comfort: float
    step: int
    room: Room


@njit(cache=True, nogil=True)
def _ask(task: Task, arcs: FloatArray, hand: int, approach: int, waypoint: int, wanted: int) -> int:
    """Those of the wanted back-offs from which one hand is in comfort, asked one by one."""
    x, y, z = task.places[hand, waypoint]
    place = Place(x, y, z)
    ask = question(task.numbers, task.shoulder, task.axes, task.labels[hand, approach], task.comfort, task.step)
    slot, found, back_off = row_slot(ask, task.memory.keys, task.memory.counts, place), 0, 0
    if task.step == ROW_STEP:
        task.slots[hand, approach, waypoint] = slot
    while wanted >> back_off:
        is_wanted = (wanted >> back_off) & 1 == 1
        if is_wanted and is_comfortable_at(ask, task.memory, task.room, arcs, slot, place, back_off):
            found |= 1 << back_off
        back_off += 1
    return found


@njit(cache=True, nogil=True)
def _remembered(bits: NDArray[np.int64], slot: int, cell: int, wanted: int) -> int:
    """Those of the wanted back-offs from which a hand is in comfort, if all of that is remembered in a row; else -1."""
    if slot < 0 or wanted & from_cell(_WHOLE_ROW, cell) & ~from_cell(bits[slot, KNOWN], cell):
        return -1
    return wanted & from_cell(bits[slot, GOOD], cell)


@njit(cache=True, nogil=True)
def _extremes(task: Task, arcs: FloatArray, hand: int, near: int) -> NDArray[np.int64]:
    """The back-offs near enough at which a hand is in comfort at its path's begin, apex and end.

    Shape (k, 3), for each approach; all 0 where one of them is.
    """
    last = task.places.shape[1] - 1
    bits, slots, cells = task.memory.bits, task.slots[hand], task.cells[hand]
    masks = np.zeros((task.labels.shape[1], 3), dtype=np.int64)
    for approach in range(task.labels.shape[1]):
        if task.labels[hand, approach] == 0:
            break
        for number, waypoint in ((1, (last + 1) // 2), (2, last), (0, 0)):
            found = _remembered(bits, slots[approach, waypoint], cells[waypoint], near)
            found = found if found >= 0 else _ask(task, arcs, hand, approach, waypoint, near)
            masks[approach, number] = found
            if found == 0:
                masks[approach] = 0
                break
    return masks


@njit(cache=True, nogil=True)
def _sets(steps: NDArray[np.int64], sets: NDArray[np.int64]) -> None:
    """For each number of steps the back-offs for which there are more."""
    sets[:] = 0
    for j in range(len(steps)):
        for level in range(min(steps[j], len(sets))):
            sets[level] |= 1 << j


@njit(cache=True, nogil=True)
def _spread(steps: NDArray[np.int64]) -> None:
    """Let the base drive from wherever it is, nothing in its way."""
    for j in range(1, len(steps)):
        steps[j] = min(steps[j], steps[j - 1] + 1)
    for j in range(len(steps) - 2, -1, -1):
        steps[j] = min(steps[j], steps[j + 1] + 1)


class Race(NamedTuple):
    """How far the search for ends has come; sets of back-offs are the bits of numbers, one for each number of steps.

    Attributes:
        wanted: which ends.
        ends: the least steps to each back-off so far, shape (count,).
        possible: the back-offs that may be ends at all, shape (1,).
        near: the steps to each back-off, nothing in the way: no end takes less; shape (count,).
        begun: where the base can be when the hands begin, shape (levels,).
        useful: from where an end can still be improved, shape (levels,).
    """

    wanted: int
    ends: NDArray[np.int64]
    possible: NDArray[np.int64]
    near: NDArray[np.int64]
    begun: NDArray[np.int64]
    useful: NDArray[np.int64]


@njit(cache=True, nogil=True)
def _race(begun: NDArray[np.int64], most: int, wanted: int) -> Race:
    """The start of a search; at `most` steps it ends."""
    count = len(begun)
    levels = min(most, 3 * count) + 1
    near, sets = begun.copy(), np.empty(levels, dtype=np.int64)
    _spread(near)
    _sets(begun, sets)
    ends, possible = np.full(count, IMPOSSIBLE, dtype=np.int64), np.array([(1 << count) - 1])
    race = Race(wanted, ends, possible, near, ~sets & possible[0], np.empty(levels, dtype=np.int64))
    _tell_useful(race)
    return race


@njit(cache=True, nogil=True)
def _tell_useful(race: Race) -> None:
    """Work out from where an end can still be improved.

    An end can be driven on to from another, nothing in the way, where unbeaten ends are wanted; else only the end
    itself counts.
    """
    count, ends = len(race.ends), race.ends
    limits = np.zeros(count, dtype=np.int64)
    if race.wanted == ANY and ends.min() < IMPOSSIBLE:
        pass
    elif race.wanted == EVERY:
        for j in range(count):
            for end in range(count):
                if (race.possible[0] >> end) & 1 and ends[end] > race.near[end]:
                    limits[j] = max(limits[j], ends[end] - abs(j - end))
    else:
        limits[:] = ends
        _spread(limits)
    _sets(limits, race.useful)


@njit(cache=True, nogil=True)
def _bound(begun: NDArray[np.int64], useful: NDArray[np.int64], begin: int, apex: int, end: int) -> int:
    """The least steps in which the base can be in three sets one after the other and still improve an end."""
    after_begin, after_apex = 0, 0
    for level in range(len(begun)):
        after_begin |= after_begin << 1 | after_begin >> 1 | begun[level] & begin
        after_apex |= after_apex << 1 | after_apex >> 1 | after_begin & apex
        if after_apex & end & useful[level]:
            return level
        if useful[level] == 0:
            return IMPOSSIBLE
    return IMPOSSIBLE


@njit(cache=True, nogil=True)
def _follow(task: Task, arcs: FloatArray, chosen: NDArray[np.int64], race: Race, answer: NDArray[np.int64]) -> bool:
    """Follow the paths in one choice of approaches and note the ends improved; whether more steps may help."""
    bits, slots, cells, useful = task.memory.bits, task.slots, task.cells, race.useful
    reached, last_begun = np.zeros(cells.shape[1], dtype=np.int64), 0
    for level in range(len(race.begun)):
        before, has_grown = race.begun[level], race.begun[level] != last_begun
        last_begun = before
        if useful[level] == 0:
            return False
        for waypoint in range(len(reached)):
            here = reached[waypoint]
            new = (before | here << 1 | here >> 1) & ~here & useful[level]
            for hand in range(len(chosen) if new else 0):
                approach = chosen[hand]
                found = _remembered(bits, slots[hand, approach, waypoint], cells[hand, waypoint], new)
                new = found if found >= 0 else _ask(task, arcs, hand, approach, waypoint, new)
            reached[waypoint] = before = here | new
            has_grown = has_grown or new != 0
            if before == 0:
                break
        is_better = False
        for end in range(len(race.ends) if before & race.useful[level] else 0):
            if (before >> end) & 1 and level < race.ends[end] and (race.useful[level] >> end) & 1:
                race.ends[end], answer[2:, end] = level, chosen
                is_better = True
                if race.wanted == UNBEATEN:
                    _tell_useful(race)
        if is_better:
            _tell_useful(race)
        if not has_grown and level >= race.near.max():
            return False
    return bool(race.useful[-1] != 0)


@njit(cache=True, nogil=True)
def least_driving(task: Task, begun: NDArray[np.int64], most: int, wanted: int) -> tuple[NDArray[np.int64], int]:
    """The least steps of driving in all, for each back-off at which the base may stand in the end.

    Args:
        task: what the hands are to follow.
        begun: for each back-off the steps in which the base can be there when the hands begin, shape (count,); count
            at most 32.
        most: ways of more steps than this are left out.
        wanted: which ends.

    Returns:
        For each back-off a column of the steps (`IMPOSSIBLE` if there is no way), where the base begins, and each
        hand's approach, shape (2 + hands, count); and the least steps that a way left out for `most` might take.
    """
    hands, count, arcs = len(task.labels), len(begun), np.empty((MOST_ARCS, 2))
    answer = np.full((2 + hands, count), IMPOSSIBLE, dtype=np.int64)
    race = _race(begun, most, wanted)
    near = 0
    for j in range(count):
        near |= (1 if race.near[j] <= most else 0) << j
    more = most + 1 if race.near.max() > most else IMPOSSIBLE
    masks = np.full((2, task.labels.shape[1], 3), near, dtype=np.int64)
    for hand in range(hands):
        masks[hand] = _extremes(task, arcs, hand, near)
        if not masks[hand].any():
            return answer, more
    pairs, bounds = _pairs(masks, hands, race)
    chosen = np.empty(hands, dtype=np.int64)
    for number in np.argsort(bounds, kind="mergesort"):
        one, other = pairs[number]
        begin, apex, end = masks[0, one] & masks[1, other]
        if bounds[number] < IMPOSSIBLE and _bound(race.begun, race.useful, begin, apex, end) < IMPOSSIBLE:
            chosen[0] = one
            if hands == 2:
                chosen[1] = other
            if _follow(task, arcs, chosen, race, answer):
                more = min(more, most + 1)
        elif bounds[number] == IMPOSSIBLE and race.useful[-1] != 0:
            more = min(more, most + 1)
    answer[0] = race.ends
    _settle(task, arcs, begun, wanted, answer)
    return answer, more


@njit(cache=True, nogil=True)
def _pairs(masks: NDArray[np.int64], hands: int, race: Race) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The choices of approaches that are not hopeless and the least steps of each; notes what ends are possible."""
    ones = np.flatnonzero(masks[0, :, 0])
    others = np.flatnonzero(masks[1, :, 0]) if hands == 2 else np.zeros(1, dtype=np.int64)
    pairs = np.empty((len(ones) * len(others), 2), dtype=np.int64)
    bounds = np.empty(len(pairs), dtype=np.int64)
    count, race.possible[0] = 0, 0
    for one in ones:
        for other in others:
            begin, apex, end = masks[0, one] & masks[1, other]
            if begin and apex and end:
                pairs[count] = one, other
                race.possible[0] |= end
                count += 1
    _tell_useful(race)
    for number in range(count):
        one, other = pairs[number]
        begin, apex, end = masks[0, one] & masks[1, other]
        bounds[number] = _bound(race.begun, race.useful, begin, apex, end)
    return pairs[:count], bounds[:count]


@njit(cache=True, nogil=True)
def _settle(task: Task, arcs: FloatArray, begun: NDArray[np.int64], wanted: int, answer: NDArray[np.int64]) -> None:
    """Leave out ends that were beaten later on, and find where the base begins on the way to the others."""
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
                race = _race(alone, answer[0, end], EVERY)
                race.possible[0] = 1 << end
                _tell_useful(race)
                _follow(task, arcs, answer[2:, end], race, found)
                if race.ends[end] == answer[0, end]:
                    answer[1, end] = first
                    break
