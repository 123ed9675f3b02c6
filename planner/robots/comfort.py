"""A test of whether a tool is within the comfort radius at a place: computed once, then remembered. Compiled.

A place is within the comfort radius when it and four places on the circle of this radius round it are within reach.
Standoffs lie on a grid of 5 cm and drags on a grid of 10 cm, so the same places recur in the base frame, always in rows
along its x axis. The memory therefore holds rows: the places of one approach, one y and one z that lie a step apart in
x, one bit each. A row is looked up once and then answers for all standoffs.

Every place is put onto the grid of `LENGTH_M` before it is tested, so that remembered answers are exact, whichever
query came first. Mirroring lets both arms share the memory. The memory is a hash table with linear probing. When it is
three quarters full it stores no more rows, and the answers stay the same.

A place also counts only if the body leaves the arm room there (see `planner.robots.posture_room`).
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import LENGTH_M
from planner.robots.aim import ToolPose, aim_at, beside, is_within_height, is_within_length
from planner.robots.arm import ArmShape
from planner.robots.joint_slack import ring_slack
from planner.robots.kernel import is_reachable_near, shape_of
from planner.robots.posture_room import Room, has_room_about, may_be_hindered

COORDINATE_BITS = 18
"""Bits of a coordinate in `LENGTH_M` steps: 1.3 m either way from the shoulder."""

ROW_CELLS = 60
"""Number of places in a row, the middle one beside the shoulder; beyond them no arm is long enough."""

ROW_STEP = 5_000
"""Steps of `LENGTH_M` between the places of a row: 5 cm. Other steps are answered, but not remembered."""

ROWS, QUERIES = 0, 1
"""Indices of the counts: rows, and queries made."""

KNOWN, GOOD, TESTED, PASSED = range(4)
"""Indices of a row's bits: which places this plan has asked about, and which of them are within the comfort radius; and
the same of all plans that have had the memory."""

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
        hints: for each approach the pan that served last (rad) and its branch, shape (64, 2).
    """

    keys: NDArray[np.int64]
    bits: NDArray[np.int64]
    counts: NDArray[np.int64]
    hints: FloatArray


def empty_memory(size_bits: int = 16) -> Memory:
    """Return a memory with room for 2 ** size_bits rows, of which it uses three quarters."""
    size = 1 << size_bits
    bits, counts = np.zeros((size, 4), dtype=np.int64), np.zeros(2, dtype=np.int64)
    return Memory(np.zeros(size, dtype=np.int64), bits, counts, no_hints())


def no_hints() -> FloatArray:
    """Return the hints of a plan that has not asked anything yet."""
    return np.tile((0.5, 1.0), (64, 1))


class Place(NamedTuple):
    """A tool point, seen from the shoulder with the base at standoff 0, in steps of `LENGTH_M`."""

    x: int
    y: int
    z: int


class Question(NamedTuple):
    """The constants of the queries in one approach; numbers alone, because those are passed on without cost.

    Attributes:
        shape: the arm.
        rest: the shoulder's offset from the grid of `LENGTH_M` (m).
        axis: the approach axis.
        label: the approach's label in the memory, 1..63.
        comfort: the comfort radius (m).
        step: the distance between standoffs, in steps of `LENGTH_M`.
    """

    shape: ArmShape
    rest: tuple[float, float, float]
    axis: tuple[float, float, float]
    label: int
    comfort: float
    step: int


@njit(cache=True, nogil=True)
def in_steps(value: float) -> int:
    """Return a coordinate in steps of `LENGTH_M`."""
    return round(value / LENGTH_M)


@njit(cache=True, nogil=True)
def place_of(point: FloatArray, shoulder: FloatArray) -> Place:
    """Return the place of a tool point, with point and shoulder in the base frame (m)."""
    return Place(
        in_steps(point[0]) - in_steps(shoulder[0]),
        in_steps(point[1]) - in_steps(shoulder[1]),
        in_steps(point[2]) - in_steps(shoulder[2]),
    )


@njit(cache=True, nogil=True)
def question(
    numbers: FloatArray, shoulder: FloatArray, axes: FloatArray, label: int, comfort: float, step: int
) -> Question:
    """Return the query in the approach of a label."""
    rest = (
        shoulder[0] - in_steps(shoulder[0]) * LENGTH_M,
        shoulder[1] - in_steps(shoulder[1]) * LENGTH_M,
        shoulder[2] - in_steps(shoulder[2]) * LENGTH_M,
    )
    axis = (axes[label - 1, 0], axes[label - 1, 1], axes[label - 1, 2])
    return Question(shape_of(numbers), rest, axis, label, comfort, step)


@njit(cache=True, nogil=True)
def row_slot(ask: Question, keys: NDArray[np.int64], counts: NDArray[np.int64], place: Place) -> int:
    """Return the slot in the memory of the row of a place; begin the row if there is none yet."""
    half = 1 << (COORDINATE_BITS - 1)
    if abs(place.y) >= half or abs(place.z) >= half or ask.step % ROW_STEP != 0:
        return FORGETFUL
    key = ((((place.x % ROW_STEP) << COORDINATE_BITS) + place.y + half) << COORDINATE_BITS) + place.z + half
    key = (key << 6) + ask.label
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


@njit(cache=True, nogil=True)
def cell_of(x: int) -> int:
    """Return the cell of a place in its row from its x; it may lie beyond the row's ends."""
    return x // ROW_STEP + ROW_CELLS // 2


@njit(cache=True, nogil=True)
def cells_of(x: int, count: int) -> int:
    """Return the bits of `count` cells of a row, the first at the place's x; none for cells beyond its ends."""
    first = max(cell_of(x), 0)
    after = min(cell_of(x) + count, ROW_CELLS)
    return ((1 << max(after - first, 0)) - 1) << min(first, ROW_CELLS)


@njit(cache=True, nogil=True)
def from_cell(bits: int, cell: int) -> int:
    """Return the bits of a row from a cell on: one for each standoff by the row's step."""
    return bits >> min(cell, 63) if cell >= 0 else bits << min(-cell, 63)


@njit(cache=True, nogil=True)
def aim_from(ask: Question, place: Place, back_off: int) -> ToolPose:
    """Return the tool pose at a place with the base at a standoff."""
    x, rest, axis = place.x + back_off * ask.step, ask.rest, ask.axis
    ahead, left, up = x * LENGTH_M - rest[0], place.y * LENGTH_M - rest[1], place.z * LENGTH_M - rest[2]
    return aim_at(ask.shape, ahead, left, up, axis[0], axis[1], axis[2])


@njit(cache=True, nogil=True, inline="always")
def is_comfortable_at(
    ask: Question, memory: Memory, room: Room, arcs: FloatArray, slot: int, place: Place, back_off: int
) -> bool:
    """Return whether a tool is within the comfort radius at a place from a standoff, from memory if it is known there.

    Inlined into its callers: passing so many arrays costs as much as many an answer.

    `arcs`, shape (MOST_ARCS, 2), is scratch space.
    """
    cell = cell_of(place.x + back_off * ask.step)
    bit = 1 << cell if slot != FORGETFUL and 0 <= cell < ROW_CELLS else 0
    if memory.bits[slot, KNOWN] & bit != 0:
        return bool(memory.bits[slot, GOOD] & bit != 0)
    aim, answer = aim_from(ask, place, back_off), False
    if is_within_length(ask.shape, aim) and is_within_height(ask.shape, aim):
        if memory.bits[slot, TESTED] & bit != 0:
            answer = memory.bits[slot, PASSED] & bit != 0
        else:
            answer = is_comfortable(ask.shape, aim, ask.comfort, arcs, memory.hints[ask.label])[0]
            if answer and may_be_hindered(aim):
                answer = has_room_about(ask.shape, room, ask.label, aim, arcs)
            memory.bits[slot, TESTED] |= bit
            memory.bits[slot, PASSED] |= bit if answer else 0
        memory.counts[QUERIES] += YES if answer and ask.comfort > 0.0 else NO
    if bit != 0:
        memory.bits[slot, KNOWN] |= bit
        if answer:
            memory.bits[slot, GOOD] |= bit
    return answer


@njit(cache=True, nogil=True)
def is_comfortable(
    shape: ArmShape, aim: ToolPose, comfort: float, arcs: FloatArray, hint: FloatArray
) -> tuple[bool, int]:
    """Return whether a tool pose and four on the circle of radius `comfort` round it are reachable; queries made.

    Mostly the pan that served last, `hint`, serves all five. If not, the pose that it serves least is tested first.
    """
    if comfort <= 0.0:
        return is_reachable_near(shape, aim, arcs, hint), 1
    least, worst = ring_slack(shape, aim, comfort, hint[0], hint[1])
    if least >= 0.0:
        return True, 5
    pan, branch = hint
    if not is_reachable_near(shape, beside(aim, comfort, worst), arcs, hint):
        return False, 1
    if ring_slack(shape, aim, comfort, hint[0], hint[1])[0] >= 0.0:
        return True, 5
    for number in range(5):
        if number != worst and not is_reachable_near(shape, beside(aim, comfort, number), arcs, hint):
            hint[0], hint[1] = pan, branch
            return False, 2 + number - (1 if number > worst else 0)
    return True, 5
