"""Load a robot by its name."""

from functools import cache

from planner.errors import RequestError
from planner.robots.pr2 import Pr2

ROBOTS = {"pr2": Pr2}
"""The robots that there are, by name."""


@cache
def load_robot(name: str) -> Pr2:
    """Return the robot of a name; raise `RequestError` for an unknown name."""
    if name not in ROBOTS:
        raise RequestError("robot", f"there is no robot {name!r}, only {', '.join(ROBOTS)}")
    return ROBOTS[name]()
