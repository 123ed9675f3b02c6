"""A memory of answers for places on a grid: a hash table in one array of integers, compiled.

An entry is twice its key, plus the answer; 0 is empty; collisions are resolved by linear probing. When the table is
three quarters full it stores no more, and the answers stay the same.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planner.kernels import kernel

CELL_BITS = 18
"""Bits of a coordinate in grid steps: with steps of `LENGTH_M`, 1.3 m either way."""

_SCATTER = 0x1E3779B97F4A7C15
"""Odd multiplier of the hash function, which spreads neighbouring keys over the table."""


class PlaceMemory(NamedTuple):
    """The memory of answers: the hash table, its length a power of two, and its number of entries."""

    table: NDArray[np.int64]
    entries: NDArray[np.int64]


def empty_memory(bits: int = 18) -> PlaceMemory:
    """Return a memory with room for 2 ** bits entries, of which it uses three quarters."""
    return PlaceMemory(np.zeros(1 << bits, dtype=np.int64), np.zeros(1, dtype=np.int64))


@kernel
def place_key(label: int, x: int, y: int, z: int) -> int:
    """Return the key of a place, in steps of `LENGTH_M` from the shoulder, and an approach's label."""
    half = 1 << (CELL_BITS - 1)
    return (((((label << CELL_BITS) + x + half) << CELL_BITS) + y + half) << CELL_BITS) + z + half


@kernel
def slot_of(table: NDArray[np.int64], key: int) -> int:
    """Return the slot in the table where a key is, or should go."""
    scattered = key * _SCATTER
    slot = (scattered ^ (scattered >> 29) ^ (scattered >> 45)) & (len(table) - 1)
    while table[slot] != 0 and table[slot] >> 1 != key:
        slot = (slot + 1) & (len(table) - 1)
    return slot


@kernel
def learn(memory: PlaceMemory, slot: int, key: int, answer: bool) -> None:
    """Store an answer in the slot that was found for its key, while there is room."""
    if 4 * memory.entries[0] < 3 * len(memory.table):
        memory.table[slot] = 2 * key + (1 if answer else 0)
        memory.entries[0] += 1
