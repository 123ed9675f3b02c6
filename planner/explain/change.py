"""Changes to a task: what is changed, by how much, and in which words.

A reason names the least changes that remove what stands in a fold's way; a suggestion is a change that was seen to give
a plan. Both make the same changes, and find the least amount by the same bisection.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from planner.geometry.tolerance import LENGTH_M
from planner.message import Message
from planner.task.task import Task


@dataclass(frozen=True, slots=True)
class Liberties:
    """Liberties that no request can ask for; they show what stands in the way.

    Attributes:
        has_long_arms: whether every place is in reach; such arms belong to no robot, so their collisions are ignored.
        more_hands: the number of hands beyond the robot's; with any, all hands reach every place.
        may_collide: whether the arms may pass through anything.
        behind_max_m: how far cloth that is carried may reach behind a line's extension (m); None for the usual.
        grips_apart_m: the least distance between two hands (m); None for the usual.
    """

    has_long_arms: bool = False
    more_hands: int = 0
    may_collide: bool = False
    behind_max_m: float | None = None
    grips_apart_m: float | None = None


NO_LIBERTIES = Liberties()


@dataclass(frozen=True, slots=True, eq=False)
class Change:
    """A kind of change, made by an amount.

    Attributes:
        kind: what is changed; two changes of one kind are not combined.
        applied: changes a task by an amount; raises `FoldingError` where that gives no valid task.
        frees: adds the liberties that the change takes, for what no request can ask for.
        says: words the change as a suggestion, from the task before and after it.
        step: the resolution of the least amount: with an amount smaller by this it is not enough.
        is_hypothetical: whether no robot can be changed like this; the change still shows what stands in the way.
    """

    kind: str
    applied: Callable[[Task, float], Task] = lambda task, _: task
    frees: Callable[[Liberties, float], Liberties] = lambda liberties, _: liberties
    says: Callable[[Task, Task], Message] = lambda _, __: Message.plain("")
    step: float = 0.001
    is_hypothetical: bool = False


def request_fields(before: Task, after: Task) -> dict[str, Any]:
    """Return the fields of a plan request that turn one task into another; another robot comes with its own table."""
    is_other = after.robot != before.robot
    fields: dict[str, Any] = {}
    if is_other:
        fields |= {"robot": after.robot, "start_station": after.start.base.station}
    if after.garment != before.garment:
        fields["garment"] = after.garment.to_dict()
    if is_other or after.scene != before.scene:
        fields["scene"] = after.scene.to_dict()
    if is_other or after.start.placement != before.start.placement:
        fields["placement"] = after.start.placement.to_dict()
    if after.limits.comfort_radius_m != before.limits.comfort_radius_m:
        fields["comfort_radius_m"] = after.limits.comfort_radius_m
    return fields


class SpentError(Exception):
    """The work or the time for trials is used up."""


@dataclass(slots=True)
class Bisection:
    """The search for the least amount that is enough.

    Attributes:
        fails: an amount that is not enough.
        works: the least amount known to be enough.
        step: the resolution of the result.
        is_whole: whether only whole amounts are tried.
        is_near: whether to try first just below what works: where that amount was measured, it is likely the least.
    """

    fails: float
    works: float
    step: float
    is_whole: bool = False
    is_near: bool = False

    @property
    def amount(self) -> float | None:
        """The amount to try next; None once the least is known."""
        if self.works - self.fails <= self.step + LENGTH_M:
            return None
        if self.is_near:
            return self.works - self.step
        middle = 0.5 * (self.fails + self.works)
        return math.floor(middle) if self.is_whole else middle

    def note(self, amount: float, needed: float | None) -> None:
        """Record how much of an amount was needed; None if it was insufficient."""
        self.is_near = False
        if needed is None:
            self.fails = amount
        else:
            self.works = needed
