"""Load a robot by its name."""

from functools import cache

from planner.errors import RequestError
from planner.robots.described_robot import shipped_robots
from planner.robots.pr2 import Pr2

ROBOTS = {"pr2": Pr2}
"""The robots for which plans are made, by name; more are described by cards (`described_robot`)."""


@cache
def load_robot(name: str) -> Pr2:
    """Return the robot of a name; raise `RequestError` where plans are not made for it."""
    if name not in ROBOTS:
        planned = ", ".join(ROBOTS)
        if name in shipped_robots():
            raise RequestError("robot", f"{name!r} has a card, but plans are made for {planned} alone so far")
        raise RequestError("robot", f"there is no robot {name!r}; plans are made for {planned}")
    return ROBOTS[name]()
