"""What has been answered for places on a grid: a hash table in one array of integers, compiled.

An entry is twice its key, plus the answer; 0 is empty; an entry that finds its place taken moves on to the next. When
the table is three quarters full it learns no more, and the answers stay the same.
"""

from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from planner.geometry.tolerance import LENGTH_M

CELL_BITS = 18
"""A coordinate is kept as this many bits of grid steps: with steps of `LENGTH_M`, 1.3 m either way."""

_SCATTER = 0x1E3779B97F4A7C15


class Memory(NamedTuple):
    """What has been answered: the hash table, its length a power of two, and how many entries it has."""

    table: NDArray[np.int64]
    entries: NDArray[np.int64]


def empty_memory(bits: int = 18) -> Memory:
    """A memory with room for 2 ** bits entries, of which it uses three quarters."""
    return Memory(np.zeros(1 << bits, dtype=np.int64), np.zeros(1, dtype=np.int64))


@njit(cache=True, nogil=True)
def steps(value: float) -> int:
    """A coordinate in steps of `LENGTH_M`."""
    return round(value / LENGTH_M)


@njit(cache=True, nogil=True)
def place_key(label: int, x: int, y: int, z: int) -> int:
    """The key of a place, in steps of `LENGTH_M` from the shoulder, and an approach's label."""
    half = 1 << (CELL_BITS - 1)
    return (((((label << CELL_BITS) + x + half) << CELL_BITS) + y + half) << CELL_BITS) + z + half


@njit(cache=True, nogil=True)
def slot_of(table: NDArray[np.int64], key: int) -> int:
    """Where in the table a key is, or should go."""
    scattered = key * _SCATTER
    slot = (scattered ^ (scattered >> 29) ^ (scattered >> 45)) & (len(table) - 1)
    while table[slot] != 0 and table[slot] >> 1 != key:
        slot = (slot + 1) & (len(table) - 1)
    return slot


@njit(cache=True, nogil=True)
def learn(memory: Memory, slot: int, key: int, answer: bool) -> None:
    """Remember an answer in the slot that was found for its key, while there is room."""
    if 4 * memory.entries[0] < 3 * len(memory.table):
        memory.table[slot] = 2 * key + (1 if answer else 0)
        memory.entries[0] += 1
