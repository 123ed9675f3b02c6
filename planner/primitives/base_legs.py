"""Plan the base's legs while the hands follow a path, with the least travel in all.

At every waypoint the hands can reach the path from some standoffs, given as a bit mask. The base may drive at a
waypoint, with the hands at rest, if the mask contains every standoff on the way. This is a shortest path in a strip of
(waypoints x standoffs). The strips are many and small, so the sweep over them is compiled.
"""

import numpy as np
from numpy.typing import NDArray

from planner.geometry.driving import IMPOSSIBLE
from planner.kernels import kernel


@kernel
def _relax(steps: NDArray[np.int64], mask: int, count: int) -> None:
    """Relax the steps by driving to and fro within the mask at one waypoint."""
    for j in range(count):
        if not (mask >> j) & 1:
            steps[j] = IMPOSSIBLE
        elif j > 0 and steps[j - 1] + 1 < steps[j]:
            steps[j] = steps[j - 1] + 1
    for j in range(count - 2, -1, -1):
        if (mask >> j) & 1 and steps[j + 1] + 1 < steps[j]:
            steps[j] = steps[j + 1] + 1


@kernel
def travel(strips: NDArray[np.uint32], count: int) -> NDArray[np.int64]:
    """Return the least travel along a path, for each of several strips and each pair of standoffs.

    Args:
        strips: bit masks of standoffs, shape (strips, waypoints).
        count: the number of standoffs.

    Returns:
        The steps driven from the standoff at the first waypoint to that at the last, `IMPOSSIBLE` if there is no way;
            shape (strips, count, count).
    """
    steps = np.full((len(strips), count, count), IMPOSSIBLE, dtype=np.int64)
    for number in range(len(strips)):
        for start in range(count):
            if (int(strips[number, 0]) >> start) & 1:
                steps[number, start, start] = 0
                for waypoint in range(strips.shape[1]):
                    _relax(steps[number, start], int(strips[number, waypoint]), count)
    return steps


def unbeaten(steps: NDArray[np.int64], onward: NDArray[np.int64] | None = None) -> list[int]:
    """Return the final standoffs that driving on from another one does not reach in as few steps.

    Args:
        steps: the steps to each final standoff, `IMPOSSIBLE` where it cannot be reached, shape (count,).
        onward: by how many steps one must come before another to beat it, shape (count, count); None: as many as the
            base drives from one to the other.
    """
    if onward is None:
        places = np.arange(len(steps))
        onward = np.abs(places[:, None] - places)
    by_cost = sorted(np.flatnonzero(steps < IMPOSSIBLE), key=lambda end: (steps[end], end))
    kept: list[int] = []
    for end in by_cost:
        if all(steps[end] < steps[other] + onward[other, end] for other in kept):
            kept.append(int(end))
    return sorted(kept)


def legs(strip: NDArray[np.uint32], start: int, end: int, count: int) -> tuple[int, ...]:
    """Return the standoff at each waypoint on a way of least travel that drives as late as possible.

    Args:
        strip: bit masks of standoffs, shape (waypoints,).
        start: the standoff at the first waypoint, before any driving there.
        end: the standoff after the last waypoint.
        count: the number of standoffs.

    Returns:
        For each waypoint, the standoff of the base when the hands leave it.
    """
    remaining = _remaining(strip, end, count)
    stands: list[int] = []
    at = start
    for waypoint, mask in enumerate(strip.tolist()):
        is_last = waypoint + 1 == len(strip)
        at = end if is_last else _next_stand(mask, remaining, waypoint, at)
        stands.append(at)
    return tuple(stands)


def _remaining(strip: NDArray[np.uint32], end: int, count: int) -> list[list[int]]:
    """Return for each waypoint the steps to the end from each standoff, counted before driving there."""
    steps = np.full(count, IMPOSSIBLE, dtype=np.int64)
    steps[end] = 0
    table: list[list[int]] = []
    for mask in strip[::-1].tolist():
        _relax(steps, mask, count)
        table.append(steps.tolist())
    return table[::-1]


def _next_stand(mask: int, remaining: list[list[int]], waypoint: int, at: int) -> int:
    """Return the nearest standoff at which to leave a waypoint such that the way stays shortest."""
    total, after = remaining[waypoint][at], remaining[waypoint + 1]
    ways = [j for j in stands_beside(mask, at) if after[j] + abs(j - at) == total]
    return min(ways, key=lambda j: (abs(j - at), j))


def stands_beside(mask: int, at: int) -> list[int]:
    """Return the standoffs to which the base can drive from `at` without leaving the mask, rising."""
    low = high = at
    while low > 0 and mask >> (low - 1) & 1:
        low -= 1
    while mask >> (high + 1) & 1:
        high += 1
    return list(range(low, high + 1))
