"""Bound from below the driving that folds still need, in a relaxed problem; see `planner.planning.driving_bound`.

A *site* is a place of the garment and a station. Drags and moves lead from site to site, ruled out only by the table's
size and the grid; at a site the base drives along its standoffs. Sites further from the start than a horizon are
outside: there the bound assumes that nothing is left to do. The functions are compiled.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planner.geometry.driving import IMPOSSIBLE
from planner.geometry.pose import BoolArray, FloatArray
from planner.kernels import kernel

OUTSIDE, NOWHERE = -1, -2
"""Markers in place of a site's number: beyond the horizon; no such site."""

FREE, HELD = 0, 1
"""The two kinds of states: the hands are empty, or hold on to the grips of a drag."""


class Sites(NamedTuple):
    """The sites within the horizon, and the ways between them.

    Attributes:
        drags: for each site and each drag, in order of length, the site to which it leads; shape (sites, drags).
        drag_s: the time for which the base drives in each drag (s), shape (drags,).
        moves: for each site and station the site to which a move leads, shape (sites, stations).
        move_s: a lower bound on the move's duration from each standoff (s), shape (sites, stations, standoffs).
        may_hold: at which sites hands that hold on after a drag may be of use to a fold, shape (sites,).
        motion_s: one arm motion (s).
        step_s: driving one step of the grid of standoffs (s).
        per_drag: steps of the grid of standoffs in one step of the grid of drags.
    """

    drags: NDArray[np.int64]
    drag_s: FloatArray
    moves: NDArray[np.int64]
    move_s: FloatArray
    may_hold: BoolArray
    motion_s: float
    step_s: float
    per_drag: int


@kernel
def to_go(sites: Sites, served: NDArray[np.int64], is_served: BoolArray) -> FloatArray:
    """Return the least time to visit places from which some folds can be done, their arm motions not counted.

    Args:
        sites: the relaxed problem.
        served: the steps of driving it takes to do each fold with empty hands, shape (folds, sites, standoffs).
        is_served: whether grips held from a drag may do instead, shape (folds, sites).

    Returns:
        Seconds, shape (sets of folds as bit masks, 2, sites, standoffs): `FREE` or `HELD`.
    """
    folds, count, standoffs = served.shape
    found = np.full((1 << folds, 2, count, standoffs), np.inf)
    found[0] = 0.0
    for left in range(1, 1 << folds):
        here = found[left]
        for site in range(count):
            for fold in range(folds):
                if (left >> fold) & 1:
                    _serve(sites, here, found[left & ~(1 << fold)], served[fold], is_served[fold], site)
        is_settled = False
        while not is_settled:
            is_settled = True
            for site in range(count - 1, -1, -1):
                if _relax(sites, here, site):
                    is_settled = False
    return found


@kernel
def _serve(
    sites: Sites,
    here: FloatArray,
    after: FloatArray,
    served: NDArray[np.int64],
    is_served: BoolArray,
    site: int,
) -> None:
    """Do a fold at a site; it may end at any standoff that the base can reach in the steps that the fold takes."""
    standoffs = here.shape[2]
    for start in range(standoffs):
        steps = served[site, start]
        if steps < IMPOSSIBLE:
            for end in range(max(0, start - steps), min(standoffs, start + steps + 1)):
                total = steps * sites.step_s + after[FREE, site, end]
                here[FREE, site, start] = min(here[FREE, site, start], total)
        if is_served[site]:
            here[HELD, site, start] = min(here[HELD, site, start], after[FREE, site, start])


@kernel
def _relax(sites: Sites, here: FloatArray, site: int) -> bool:
    """Look for shorter ways from a site, and return whether there were any."""
    standoffs, has_changed = here.shape[2], False
    for number in range(2 * standoffs):
        start = number if number < standoffs else 2 * standoffs - 1 - number
        least = here[FREE, site, start]
        for beside in (start - 1, start + 1):
            if 0 <= beside < standoffs:
                least = min(least, sites.step_s + here[FREE, site, beside])
        for count in range(sites.drags.shape[1]):
            goal, steps = sites.drags[site, count], (count + 1) * sites.per_drag
            if goal == NOWHERE or start + steps >= standoffs:
                break
            go_on = 0.0 if goal == OUTSIDE else here[FREE, goal, start + steps] + sites.motion_s
            if goal >= 0 and sites.may_hold[goal]:
                go_on = min(go_on, here[HELD, goal, start + steps])
            least = min(least, sites.drag_s[count] + go_on)
        for station in range(sites.moves.shape[1]):
            goal = sites.moves[site, station]
            if goal != NOWHERE:
                go_on = 0.0 if goal == OUTSIDE else here[FREE, goal, 0]
                least = min(least, sites.move_s[site, station, start] + go_on)
        if least < here[FREE, site, start]:
            here[FREE, site, start] = least
            has_changed = True
        if here[FREE, site, start] < here[HELD, site, start]:
            here[HELD, site, start] = here[FREE, site, start]
    return has_changed
