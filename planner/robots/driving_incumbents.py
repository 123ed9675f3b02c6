"""The least driving found to each end, and the places that may still improve it: branch and bound, compiled.

Sets of standoffs are the bits of a number, one number for each count of steps (a *level*). With `t` steps the base can
be where it can be with `t - 1` and one step beside that, so that a bound is a few operations on numbers.

A place matters with `t` steps only if no end found so far is as good from there. Each end found shrinks these sets, and
the search stops when they are empty.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planner.geometry.driving import IMPOSSIBLE
from planner.kernels import kernel

UNBEATEN, EVERY, ANY = range(3)
"""Values for the ends wanted, see `planner.geometry.driving.Wanted`."""


class Incumbents(NamedTuple):
    """The best ends so far and the places that may improve them; sets are the bits of numbers, one for each level.

    Attributes:
        wanted: which ends.
        ends: the least steps to each standoff so far, shape (count,).
        possible: the standoffs that may be ends at all, shape (1,).
        near: the steps to each standoff with nothing in the way, a lower bound for any end; shape (count,).
        begun: where the base can be when the hands begin, shape (levels,).
        useful: from where an end can still be improved, shape (levels,).
    """

    wanted: int
    ends: NDArray[np.int64]
    possible: NDArray[np.int64]
    near: NDArray[np.int64]
    begun: NDArray[np.int64]
    useful: NDArray[np.int64]


@kernel
def no_incumbents(begun: NDArray[np.int64], most: int, wanted: int) -> Incumbents:
    """Return the incumbents of a search that starts, with no end found, and considers at most `most` steps."""
    count = len(begun)
    levels = min(most, 3 * count) + 1
    near, sets = begun.copy(), np.empty(levels, dtype=np.int64)
    _spread(near)
    _sets(begun, sets)
    ends, possible = np.full(count, IMPOSSIBLE, dtype=np.int64), np.array([(1 << count) - 1])
    best = Incumbents(wanted, ends, possible, near, ~sets & possible[0], np.empty(levels, dtype=np.int64))
    tell_useful(best)
    return best


@kernel
def tell_useful(best: Incumbents) -> None:
    """Update from where an end can still be improved.

    Where unbeaten ends are wanted, the base can drive on from one end to another with nothing in the way; else only the
    end itself counts.
    """
    count, ends = len(best.ends), best.ends
    limits = np.zeros(count, dtype=np.int64)
    if best.wanted == ANY and ends.min() < IMPOSSIBLE:
        pass
    elif best.wanted == EVERY:
        for j in range(count):
            for end in range(count):
                if (best.possible[0] >> end) & 1 and ends[end] > best.near[end]:
                    limits[j] = max(limits[j], ends[end] - abs(j - end))
    else:
        limits[:] = ends
        _spread(limits)
    _sets(limits, best.useful)


@kernel
def least_steps(begun: NDArray[np.int64], useful: NDArray[np.int64], begin: int, apex: int, end: int) -> int:
    """Return the least steps in which the base can be in three sets one after the other and still improve an end."""
    after_begin, after_apex = 0, 0
    for level in range(len(begun)):
        after_begin |= after_begin << 1 | after_begin >> 1 | begun[level] & begin
        after_apex |= after_apex << 1 | after_apex >> 1 | after_begin & apex
        if after_apex & end & useful[level]:
            return level
        if useful[level] == 0:
            return IMPOSSIBLE
    return IMPOSSIBLE


@kernel
def _sets(steps: NDArray[np.int64], sets: NDArray[np.int64]) -> None:
    """Set for each number of steps the standoffs that have larger entries in `steps`."""
    sets[:] = 0
    for j in range(len(steps)):
        for level in range(min(steps[j], len(sets))):
            sets[level] |= 1 << j


@kernel
def _spread(steps: NDArray[np.int64]) -> None:
    """Let the base drive from every place with nothing in its way."""
    for j in range(1, len(steps)):
        steps[j] = min(steps[j], steps[j - 1] + 1)
    for j in range(len(steps) - 2, -1, -1):
        steps[j] = min(steps[j], steps[j + 1] + 1)
