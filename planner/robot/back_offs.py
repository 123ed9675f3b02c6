"""From which back-offs is a tool comfortable at each of many points? The search's questions, compiled.

Asked naively this is points x approaches x back-offs x five comfort points of exact queries, and a search
asks again and again. Four things make it cheap without changing an answer:

- *Dying early.* A path is followed in one orientation, so an approach is dropped at the first point that
  can be had from no back-off. A path's ends and middle are asked first: they are the likeliest to fail.
- *Centre first.* The comfort points are asked only where the point itself is reachable.
- *Memory.* Back-offs lie on a grid of 5 cm and drags on one of 10 cm, so the same places return in the
  base frame. Every place is put onto the grid of `LENGTH_M` before it is asked, so that what is remembered
  for it is exact, whichever question came first. Mirroring has both arms share the memory.

The memory is a hash table in one array of integers: an entry is twice its key, plus the answer; 0 is
empty; an entry that finds its place taken moves on to the next. When it is three quarters full it
learns no more, and the answers stay the same.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.geometry.tolerance import LENGTH_M
from planner.robot.arm import ArmShape
from planner.robot.kernel import MOST_ARCS, Aim, aim_at, is_reachable_near, is_within_length

CELL_BITS = 18
"""A coordinate is kept as this many bits of `LENGTH_M` steps: 1.3 m either way from the shoulder."""

_SCATTER = 0x1E3779B97F4A7C15


class Memory(NamedTuple):
    """What has been answered: the hash table, its length a power of two, and how many entries it has."""

    table: NDArray[np.int64]
    entries: NDArray[np.int64]


def empty_memory(bits: int = 18) -> Memory:
    """A memory with room for 2 ** bits entries, of which it uses three quarters."""
    return Memory(np.zeros(1 << bits, dtype=np.int64), np.zeros(1, dtype=np.int64))


@njit(cache=True, nogil=True)
def _steps(value: float) -> int:
    """A coordinate in steps of `LENGTH_M`."""
    return round(value / LENGTH_M)


@njit(cache=True, nogil=True)
def _key(label: int, x: int, y: int, z: int) -> int:
    """The key of a place, in steps of `LENGTH_M` from the shoulder, and an approach's label."""
    half = 1 << (CELL_BITS - 1)
    return (((((label << CELL_BITS) + x + half) << CELL_BITS) + y + half) << CELL_BITS) + z + half


@njit(cache=True, nogil=True)
def _slot(table: NDArray[np.int64], key: int) -> int:
    """Where in the table a key is, or should go."""
    scattered = key * _SCATTER
    slot = (scattered ^ (scattered >> 32)) & (len(table) - 1)
    while table[slot] != 0 and table[slot] >> 1 != key:
        slot = (slot + 1) & (len(table) - 1)
    return slot


@njit(cache=True, nogil=True)
def is_comfortable(shape: ArmShape, aim: Aim, comfort: float, arcs: FloatArray, hint: FloatArray) -> tuple[bool, int]:
    """Whether an aim and four on the circle of radius `comfort` round it are reachable; queries made."""
    if not is_reachable_near(shape, aim, arcs, hint):
        return False, 1
    if comfort <= 0.0:
        return True, 1
    queries = 1
    for dx, dy in ((comfort, 0.0), (-comfort, 0.0), (0.0, comfort), (0.0, -comfort)):
        queries += 1
        beside = Aim(aim.x + dx, aim.y + dy, aim.z, aim.ax, aim.ay, aim.az)
        if not is_reachable_near(shape, beside, arcs, hint):
            return False, queries
    return True, queries


class Question(NamedTuple):
    """What stays the same while one approach is followed along a path.

    Attributes:
        shape: the arm.
        shoulder: where the shoulder is, in the frame of the points (m), shape (3,).
        axis: the approach axis, shape (3,).
        label: what to call the approach in the memory, at least 1.
        back_offs: how many there are.
        step: from one back-off to the next (m).
        comfort: radius of the comfort circle (m).
        arcs: room to work in, shape (MOST_ARCS, 2).
        hint: the pan that served last (rad), shape (1,).
    """

    shape: ArmShape
    shoulder: FloatArray
    axis: FloatArray
    label: int
    back_offs: int
    step: float
    comfort: float
    arcs: FloatArray
    hint: FloatArray


@njit(cache=True, nogil=True)
def _recalled(ask: Question, memory: Memory, point: FloatArray, back_off: int) -> tuple[bool, int]:
    """Whether a tool point is comfortable from a back-off, from memory if it is known there; queries made."""
    shoulder = ask.shoulder
    x, y, z = _steps(point[0] + back_off * ask.step), _steps(point[1]), _steps(point[2])
    ahead, left, up = x * LENGTH_M - shoulder[0], y * LENGTH_M - shoulder[1], z * LENGTH_M - shoulder[2]
    aim = aim_at(ask.shape, ahead, left, up, ask.axis[0], ask.axis[1], ask.axis[2])
    if not is_within_length(ask.shape, aim):
        return False, 0
    key = _key(ask.label, x - _steps(shoulder[0]), y - _steps(shoulder[1]), z - _steps(shoulder[2]))
    slot = _slot(memory.table, key)
    if memory.table[slot] != 0:
        return memory.table[slot] & 1 == 1, 0
    answer, queries = is_comfortable(ask.shape, aim, ask.comfort, ask.arcs, ask.hint)
    if 4 * memory.entries[0] < 3 * len(memory.table):
        memory.table[slot] = 2 * key + (1 if answer else 0)
        memory.entries[0] += 1
    return answer, queries


@njit(cache=True, nogil=True)
def _is_out_of_reach(ask: Question, memory: Memory, point: FloatArray) -> tuple[bool, int]:
    """Whether a point can be had from no back-off at all; queries made."""
    queries = 0
    nearest, farthest = _within_length(ask, point)
    for back_off in range(nearest, farthest):
        answer, asked = _recalled(ask, memory, point, back_off)
        queries += asked
        if answer:
            return False, queries
    return True, queries


@njit(cache=True, nogil=True)
def _within_length(ask: Question, point: FloatArray) -> tuple[int, int]:
    """The first back-off, and the one after the last, at which the wrist may be within the arm's length.

    Backing off moves the wrist along x, and what is within the length is one stretch of that line.
    """
    shape, tool = ask.shape, ask.shape.tool
    x, y = point[0] - ask.shoulder[0] - tool * ask.axis[0], point[1] - ask.shoulder[1] - tool * ask.axis[1]
    z = point[2] - ask.shoulder[2] - tool * ask.axis[2]
    length = shape.upper + shape.fore + LENGTH_M
    if abs(z) >= length:
        return 0, 0
    outward = shape.offset + math.sqrt(length * length - z * z) + LENGTH_M
    if abs(y) >= outward:
        return 0, 0
    if ask.step <= 0.0:
        return 0, ask.back_offs
    half = math.sqrt(outward * outward - y * y)
    first, last = math.floor((-half - x) / ask.step), math.ceil((half - x) / ask.step)
    return max(int(first), 0), min(int(last) + 1, ask.back_offs)


@njit(cache=True, nogil=True)
def _arrivals(ask: Question, memory: Memory, point: FloatArray, before: int) -> tuple[int, int]:
    """The back-offs at which the base may be at a point, having come from some at the point before; queries made.

    Those it came from that reach the point too, and those to which it can drive on from there.
    """
    mask, queries = 0, 0
    for back_off in range(ask.back_offs):
        is_next = back_off > 0 and (mask >> (back_off - 1)) & 1 == 1
        if (before >> back_off) & 1 == 1 or is_next:
            answer, asked = _recalled(ask, memory, point, back_off)
            queries += asked
            mask |= (1 if answer else 0) << back_off
    for back_off in range(ask.back_offs - 2, -1, -1):
        is_new = (before >> back_off) & 1 == 0 and (mask >> back_off) & 1 == 0
        if is_new and (mask >> (back_off + 1)) & 1 == 1:
            answer, asked = _recalled(ask, memory, point, back_off)
            queries += asked
            mask |= (1 if answer else 0) << back_off
    return mask, queries


@njit(cache=True, nogil=True)
def back_off_masks(
    shape: ArmShape,
    memory: Memory,
    shoulder: FloatArray,
    points: FloatArray,
    axes: FloatArray,
    labels: NDArray[np.int64],
    count: int,
    step: float,
    comfort: float,
    enough: int,
    before: int,
) -> tuple[NDArray[np.uint32], int]:
    """For each approach and point the back-offs from which the tool is there in comfort; queries made.

    Args:
        shape: the arm.
        memory: what was answered before, for this comfort; added to.
        shoulder: where the shoulder is, in the frame of the points (m), shape (3,).
        points: tool points at back-off 0 (m), shape (n, 3).
        axes: approach axes, shape (k, 3).
        labels: what to call each approach in the memory, 1..63, shape (k,).
        count: how many back-offs there are, at most 32.
        step: from one back-off to the next (m): the points move along x by it.
        comfort: radius of the circle (m).
        enough: after so many approaches that can follow the path the others are left at 0.
        before: bit mask of the back-offs from which the base may come to the first point.
    """
    arcs = np.empty((MOST_ARCS, 2))
    hint = np.array([0.5 * (shape.pan.low + shape.pan.high)])
    masks = np.zeros((len(axes), len(points)), dtype=np.uint32)
    queries = alive = 0
    for approach in range(len(axes)):
        if alive == enough:
            break
        ask = Question(shape, shoulder, axes[approach], labels[approach], count, step, comfort, arcs, hint)
        is_dead = False
        for i in (len(points) - 1, len(points) // 2):
            if i > 0 and not is_dead:
                is_dead, asked = _is_out_of_reach(ask, memory, points[i])
                queries += asked
        if is_dead:
            continue
        mask = before
        for i in range(len(points)):
            mask, asked = _arrivals(ask, memory, points[i], mask)
            queries += asked
            masks[approach, i] = mask
            if mask == 0:
                masks[approach, :] = 0
                break
        alive += 1 if mask != 0 else 0
    return masks, queries


@njit(cache=True, nogil=True)
def anywhere(
    shape: ArmShape,
    memory: Memory,
    shoulder: FloatArray,
    points: FloatArray,
    axes: FloatArray,
    labels: NDArray[np.int64],
    count: int,
    step: float,
    comfort: float,
) -> tuple[BoolArray, int]:
    """For each approach and point, each on its own, whether some back-off has the tool there in comfort; queries made.

    The arguments are those of `back_off_masks`, but there may be any number of back-offs.
    """
    arcs = np.empty((MOST_ARCS, 2))
    hint = np.array([0.5 * (shape.pan.low + shape.pan.high)])
    answers = np.zeros((len(axes), len(points)), dtype=np.bool_)
    queries = 0
    for approach in range(len(axes)):
        ask = Question(shape, shoulder, axes[approach], labels[approach], count, step, comfort, arcs, hint)
        for i in range(len(points)):
            is_out, asked = _is_out_of_reach(ask, memory, points[i])
            answers[approach, i] = not is_out
            queries += asked
    return answers, queries
