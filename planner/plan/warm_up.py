"""Compile all that is compiled, or load it from the cache, so that no user's first plan waits for it."""

from planner.cloth.garment import Garment
from planner.plan.make_plan import make_plan

_NAPKIN = {
    "name": "napkin",
    "outline": [[0.0, 0.0], [0.3, 0.0], [0.3, 0.3], [0.0, 0.3]],
    "folds": [{"name": "half", "kind": "blue", "start": [0.3, 0.15], "end": [0.0, 0.15]}],
    "placement": {"x_m": -0.75, "y_m": 0.15, "yaw_rad": -1.5707963267948966},
}


def warm_up() -> None:
    """Plan a napkin and play it, which touches every compiled function."""
    make_plan(Garment.from_dict(_NAPKIN)).timeline().at(0.0)
