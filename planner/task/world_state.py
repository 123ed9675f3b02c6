"""The state of the world between two primitives: the cloth, the base, and what is held.

Any g-state (paper, section 4) may be the start of a task. Between the steps of a plan it records the plan's progress,
so that planning can continue from there.
"""

from dataclasses import dataclass
from typing import Any

from planner.geometry.given import PlanePoint
from planner.geometry.pose import Pose2
from planner.json_form import STRICT, JsonForm
from planner.task.grip import BaseStop


@dataclass(frozen=True, slots=True)
class HeldPoint:
    """A point of the cloth that one arm holds.

    Attributes:
        arm: the arm's name.
        point: the point, article frame (m).
    """

    arm: str
    point: PlanePoint


@dataclass(frozen=True, slots=True)
class WorldState:
    """Cloth, base and hands at one moment.

    Attributes:
        folds_done: the indices of the folds done, in the order in which they were made.
        placement: the article frame in the table frame.
        base: the base's place.
        held: the points that are held, arm by arm; empty when all hands are free.
        dragged_m: the length of the drag after which the cloth is still held (m); 0 if nothing is held, or if it is
            held after a fold, for the red fold that follows.
    """

    __pydantic_config__ = STRICT

    folds_done: tuple[int, ...]
    placement: Pose2
    base: BaseStop
    held: tuple[HeldPoint, ...] = ()
    dragged_m: float = 0.0

    def to_dict(self) -> dict[str, Any]:
        """Return the state as JSON."""
        written: dict[str, Any] = WORLD_STATES.write(self)
        return written

    @property
    def done(self) -> int:
        """The folds done, as a bit mask."""
        return sum(1 << fold for fold in set(self.folds_done))


WORLD_STATES = JsonForm(WorldState)
"""Reads and writes states of the world."""
