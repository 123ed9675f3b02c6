"""A test of whether a tool is within the comfort radius at a place: computed once, then remembered. Compiled.

A place is within the comfort radius when it and four places on the circle of this radius round it are within reach.
Standoffs lie on a grid of 5 cm and drags on a grid of 10 cm, so the same places recur in the base frame, always in rows
along its x axis. The memory therefore holds rows: the places of one approach, one y and one z that lie a step apart in
x, one bit each. A row is looked up once and then answers for all standoffs.

Every place is put onto the grid of `LENGTH_M` before it is tested, so that remembered answers are exact, whichever
query came first. All arms share the memory: mirror images of each other under the same labels, others under labels of
their own. The memory is a hash table with linear probing. When it is
three quarters full it stores no more rows, and the answers stay the same.

Whether a place is within the radius is answered by the arm (see `planner.robots.arm_query`).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planner.kernels import inlined, kernel
from planner.robots.arm_query import ArmNumbers, ArmQuery, Space, is_in_length, is_within_margin
from planner.robots.place import STANDOFF_STEP, Place

COORDINATE_BITS = 18
"""Bits of a coordinate in `LENGTH_M` steps: 1.3 m either way from the shoulder."""

LABEL_BITS = 9
"""Bits of a label: up to 64 for each of up to eight arms."""

ROW_CELLS = 60
"""Number of places in a row, the middle one beside the shoulder; beyond them no arm is long enough."""

ROWS, QUERIES = 0, 1
"""Indices of the counts: rows, and queries made."""

KNOWN, GOOD, TESTED, PASSED = range(4)
"""Indices of a row's bits: which places this plan has queried, and which of them are within the comfort radius; and
the same of all plans that have had the memory. A place that passed without a test is beyond the arm's length."""

YES, NO = 5, 1
"""Queries charged for a place: all five if it is within the comfort radius; if not, mostly one tells. A plan is charged
for what another has tested too, so that its work does not depend on what came before it."""

FORGETFUL = -1
"""The slot of a row that finds no room in the memory."""

_SCATTER = 0x1E3779B97F4A7C15
"""Odd multiplier of the hash function, which spreads neighbouring keys over the table."""


class Memory(NamedTuple):
    """The memory of answers.

    Attributes:
        keys: the rows' keys, shape (size,), size a power of two; 0 is empty.
        bits: the rows' numbers, see `KNOWN`, shape (size, 4).
        counts: see `ROWS` and `QUERIES`, shape (2,).
    """

    keys: NDArray[np.int64]
    bits: NDArray[np.int64]
    counts: NDArray[np.int64]


def empty_memory(size_bits: int = 16) -> Memory:
    """Return a memory with room for 2 ** size_bits rows, of which it uses three quarters."""
    size = 1 << size_bits
    bits, counts = np.zeros((size, 4), dtype=np.int64), np.zeros(2, dtype=np.int64)
    return Memory(np.zeros(size, dtype=np.int64), bits, counts)


@kernel
def row_slot(label: int, keys: NDArray[np.int64], counts: NDArray[np.int64], place: Place) -> int:
    """Return the slot in the memory of the row of a place; begin the row if there is none yet."""
    half = 1 << (COORDINATE_BITS - 1)
    if abs(place.y) >= half or abs(place.z) >= half:
        return FORGETFUL
    key = ((((place.x % STANDOFF_STEP) << COORDINATE_BITS) + place.y + half) << COORDINATE_BITS) + place.z + half
    key = (key << LABEL_BITS) + label
    scattered = key * _SCATTER
    slot = (scattered ^ (scattered >> 29) ^ (scattered >> 45)) & (len(keys) - 1)
    while keys[slot] != key:
        if keys[slot] == 0:
            if 4 * counts[ROWS] >= 3 * len(keys):
                return FORGETFUL
            keys[slot] = key
            counts[ROWS] += 1
            break
        slot = (slot + 1) & (len(keys) - 1)
    return slot


@kernel
def cell_of(x: int) -> int:
    """Return the cell of a place in its row from its x; it may lie beyond the row's ends."""
    return x // STANDOFF_STEP + ROW_CELLS // 2


@kernel
def cells_of(x: int, count: int) -> int:
    """Return the bits of `count` cells of a row, the first at the place's x; none for cells beyond its ends."""
    first = max(cell_of(x), 0)
    after = min(cell_of(x) + count, ROW_CELLS)
    return ((1 << max(after - first, 0)) - 1) << min(first, ROW_CELLS)


@kernel
def from_cell(bits: int, cell: int) -> int:
    """Return the bits of a row from a cell on: one for each standoff by the row's step."""
    return bits >> min(cell, 63) if cell >= 0 else bits << min(-cell, 63)


@kernel
def to_cell(bits: int, cell: int) -> int:
    """Return the bits of a row's cells for bits of standoffs by its step, the first of which is at a cell."""
    return (bits << min(cell, ROW_CELLS) if cell >= 0 else bits >> min(-cell, 63)) & ((1 << ROW_CELLS) - 1)


@kernel
def recall(bits: NDArray[np.int64], counts: NDArray[np.int64], slot: int, cells: int, comfort: float) -> None:
    """Let this plan know what others have found out about cells of a row, and charge it for that.

    All at once: one by one takes ten times as long.

    Args:
        bits: the memory's rows.
        counts: its counts.
        slot: the row's slot.
        cells: the bits of cells that this plan has not queried yet and others have.
        comfort: the comfort radius (m).
    """
    tested = bits[slot, TESTED] & cells
    good = tested & bits[slot, PASSED]
    bits[slot, KNOWN] |= cells
    bits[slot, GOOD] |= good
    counts[QUERIES] += NO * _count_of(tested & ~good) + (YES if comfort > 0.0 else NO) * _count_of(good)


@kernel
def _count_of(bits: int) -> int:
    count = 0
    while bits:
        bits &= bits - 1
        count += 1
    return count


@inlined
def is_comfortable_at(
    ask: ArmQuery, arm: ArmNumbers, memory: Memory, space: Space, slot: int, place: Place, standoff: int
) -> bool:
    """Return whether a tool is within the comfort radius at a place from a standoff, from memory if it is known there.

    Inlined into its callers: passing so many arrays costs as much as many an answer.

    `space` is working memory.
    """
    cell = cell_of(place.x + standoff * STANDOFF_STEP)
    bit = 1 << cell if slot != FORGETFUL and 0 <= cell < ROW_CELLS else 0
    if memory.bits[slot, KNOWN] & bit != 0:
        return bool(memory.bits[slot, GOOD] & bit != 0)
    answer, is_tested = False, memory.bits[slot, TESTED] & bit != 0
    if is_tested:
        answer = memory.bits[slot, PASSED] & bit != 0
    elif memory.bits[slot, PASSED] & bit == 0:
        is_tested = is_in_length(ask, place, standoff)
        if is_tested:
            answer = is_within_margin(ask, arm, space, place, standoff)
            memory.bits[slot, TESTED] |= bit
        memory.bits[slot, PASSED] |= bit if answer or not is_tested else 0
    if is_tested:
        memory.counts[QUERIES] += YES if answer and ask.comfort > 0.0 else NO
    if bit != 0:
        memory.bits[slot, KNOWN] |= bit
        if answer:
            memory.bits[slot, GOOD] |= bit
    return answer
