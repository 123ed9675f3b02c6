"""The base's legs while the hands follow a path: where it stands at each waypoint, least travel in all.

At every waypoint the path can be reached from some back-offs, given as a bit mask. The base may drive between
waypoints, the hands resting, if every back-off on the way is in the mask. This is a shortest path in a
strip of (waypoints x back-offs); the strips are many and small, so the sweep over them is compiled.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from planner.geometry.driving import IMPOSSIBLE


@njit(cache=True)
def _relax(steps: NDArray[np.int64], mask: int, count: int) -> None:
    """Drive to and fro within the mask at one waypoint."""
    for j in range(count):
        if not (mask >> j) & 1:
            steps[j] = IMPOSSIBLE
        elif j > 0 and steps[j - 1] + 1 < steps[j]:
            steps[j] = steps[j - 1] + 1
    for j in range(count - 2, -1, -1):
        if (mask >> j) & 1 and steps[j + 1] + 1 < steps[j]:
            steps[j] = steps[j + 1] + 1


@njit(cache=True)
def travel(strips: NDArray[np.uint32], count: int) -> NDArray[np.int64]:
    """The least travel along a path, for each of several strips and each pair of back-offs.

    Args:
        strips: bit masks of back-offs, shape (strips, waypoints).
        count: the number of back-offs.

    Returns:
        From the back-off at the first waypoint to that at the last the number of steps driven, `IMPOSSIBLE` if there
        is no way; shape (strips, count, count).
    """
    steps = np.full((len(strips), count, count), IMPOSSIBLE, dtype=np.int64)
    for number in range(len(strips)):
        for start in range(count):
            if (int(strips[number, 0]) >> start) & 1:
                steps[number, start, start] = 0
                for waypoint in range(strips.shape[1]):
                    _relax(steps[number, start], int(strips[number, waypoint]), count)
    return steps


def unbeaten(steps: NDArray[np.int64]) -> list[int]:
    """The end back-offs that cannot be had in as few steps by driving on from another end; steps of shape (count,)."""
    by_cost = sorted(np.flatnonzero(steps < IMPOSSIBLE), key=lambda end: (steps[end], end))
    kept: list[int] = []
    for end in by_cost:
        if all(steps[end] < steps[other] + abs(end - other) for other in kept):
            kept.append(int(end))
    return sorted(kept)


def legs(strip: NDArray[np.uint32], start: int, end: int, count: int) -> tuple[int, ...]:
    """The back-off at each waypoint on a way of least travel, driving as late as can be.

    Args:
        strip: bit masks of back-offs, shape (waypoints,).
        start: back-off at the first waypoint, before any driving there.
        end: back-off after the last.
        count: the number of back-offs.

    Returns:
        For each waypoint where the base stands when the hands leave it.
    """
    remaining = _remaining(strip, end, count)
    stands: list[int] = []
    at = start
    for waypoint in range(len(strip)):
        is_last = waypoint + 1 == len(strip)
        at = end if is_last else _next_stand(int(strip[waypoint]), remaining, waypoint, at)
        stands.append(at)
    return tuple(stands)


def _remaining(strip: NDArray[np.uint32], end: int, count: int) -> list[NDArray[np.int64]]:
    """For each waypoint the steps from each back-off, before driving there, to the end."""
    steps = np.full(count, IMPOSSIBLE, dtype=np.int64)
    steps[end] = 0
    table: list[NDArray[np.int64]] = []
    for mask in strip[::-1]:
        _relax(steps, int(mask), count)
        table.append(steps.copy())
    return table[::-1]


def _next_stand(mask: int, remaining: list[NDArray[np.int64]], waypoint: int, at: int) -> int:
    """Where to stand when leaving a waypoint: the nearest place from which the way stays shortest."""
    total, after = remaining[waypoint][at], remaining[waypoint + 1]
    ways = [j for j in _within_reach(mask, at) if after[j] + abs(j - at) == total]
    return min(ways, key=lambda j: (abs(j - at), j))


def _within_reach(mask: int, at: int) -> list[int]:
    """The back-offs to which the base can drive from one without leaving the mask."""
    low = high = at
    while low > 0 and mask >> (low - 1) & 1:
        low -= 1
    while mask >> (high + 1) & 1:
        high += 1
    return list(range(low, high + 1))
