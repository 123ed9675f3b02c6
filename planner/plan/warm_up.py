"""Compile all that is compiled, or load it from the cache, so that no user's search is charged for it."""

from collections.abc import Callable
from functools import cache

import numpy as np

from planner.cloth.garment import Garment
from planner.plan.plan import Plan

_NAPKIN = {
    "name": "napkin",
    "outline": [[0.0, 0.0], [0.3, 0.0], [0.3, 0.3], [0.0, 0.3]],
    "folds": [{"name": "half", "kind": "blue", "start": [0.3, 0.15], "end": [0.0, 0.15]}],
    "placement": {"x_m": -0.75, "y_m": 0.15, "yaw_rad": -1.5707963267948966},
}

_FAR, _EDGE = np.array([1.2, 0.0, 0.8]), np.array([0.9, 0.2, 0.9])


@cache
def warm_up(plan: Callable[[Garment], Plan]) -> None:
    """Plan a napkin, play it, and ask why two places are out of reach: that touches every compiled function.

    Args:
        plan: makes a plan for a garment.
    """
    found = plan(Garment.from_dict(_NAPKIN))
    found.timeline().at(0.0)
    reach = found.work.reach
    for point in (_FAR, _EDGE):
        reach.shortfall(0, point, np.array([0]))
        reach.from_anywhere(0, point[None], np.array([0]), 1, 0.05)
        reach.shortfall_together(0, point[None, None], np.array([0]))
        reach.at_least_short(0, point[None, None], np.array([0]), 1, 0.05)
