"""The robot that is shown for a drawing: one of one's own may be removed, or become invalid, while drawings name it."""

from planner.errors import FieldError
from planner.robots.card import RobotCard
from planner.robots.load_robot import load_robot
from planner.task.task import DEFAULT_ROBOT


def shown_robot(name: str) -> RobotCard:
    """Return a robot's card, or the default robot's where there is none of this name or it is not valid.

    The drawing stays readable and can be given another robot; planning it says what is wrong.
    """
    try:
        return load_robot(name).card
    except FieldError:
        return load_robot(DEFAULT_ROBOT).card
