"""Changes to a task: what is changed, by how much, and in which words.

A reason names the least changes that remove what stands in a fold's way; a suggestion is a change that was seen to give
a plan. Both make the same changes, and find the least amount by the same bisection.
"""

import math
from collections.abc import Callable, Collection
from dataclasses import dataclass, replace
from typing import Any

from planner.cloth.garment import DrawnFold
from planner.geometry.pose import Point3
from planner.geometry.tolerance import LENGTH_M
from planner.message import Message
from planner.task.scene import FRICTION_MAX, SUPPORT_ANGLE_MAX_RAD
from planner.task.task import Task
from planner.words.catalogue import worded


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


_DECIMALS = 12
"""Decimals that an amount is rounded to once it has been added to what is (m, rad or a coefficient)."""

_HALF_A_DEGREE_RAD = math.radians(0.5)
"""The resolution of angles (rad)."""


def _in_scene(task: Task, **fields: Any) -> Task:  # noqa: ANN401
    return task.in_scene(replace(task.scene, **fields))


def _more(now: float, by: float, most: float = math.inf) -> float:
    return min(round(now + by, _DECIMALS), most)


def _with_more(field: str, most: float) -> Callable[[Task, float], Task]:
    """Return what increases a number of a task's scene, to some most."""
    return lambda task, by: _in_scene(task, **{field: _more(getattr(task.scene, field), by, most)})


def _with_less_comfort(task: Task, by_m: float) -> Task:
    return task.within(max(round(task.limits.comfort_radius_m - by_m, _DECIMALS), 0.0))


def _assume_comfort(before: Task, after: Task) -> Message:
    radii = {"comfort_m": after.limits.comfort_radius_m, "now_m": before.limits.comfort_radius_m}
    return worded("assume_comfort", radii)


def _assume_friction(before: Task, after: Task) -> Message:
    return worded("assume_friction", {"friction": after.scene.friction, "now": before.scene.friction})


COMFORT = Change("comfort_radius", _with_less_comfort, says=_assume_comfort)
"""Makes the comfort radius smaller."""

FRICTION = Change("friction", _with_more("friction", FRICTION_MAX), says=_assume_friction)
"""Makes the cloth slip less."""

STIFFNESS = Change("support_angle", _with_more("support_angle_rad", SUPPORT_ANGLE_MAX_RAD), step=_HALF_A_DEGREE_RAD)
"""Makes the cloth stiffer, so that more of it holds itself."""

CONE = Change("cone", _with_more("approach_cone_rad", math.pi), step=_HALF_A_DEGREE_RAD)
"""Makes the approach cone wider."""

COLLISIONS_IGNORED = Change("collision", frees=lambda free, _: replace(free, may_collide=True))
"""Lets the arms pass through anything."""

LONG_ARMS = Change(
    "arms", frees=lambda free, _: replace(free, has_long_arms=True, may_collide=True), is_hypothetical=True
)
"""Puts every place in reach."""

ONE_MORE_HAND = Change(
    "hands",
    frees=lambda free, _: replace(free, has_long_arms=True, may_collide=True, more_hands=1),
    is_hypothetical=True,
)
"""Adds a hand, which reaches every place as all others do then."""


def reach_behind(now_m: float) -> Change:
    """Return the change that cloth which is carried may reach further behind a line's extension than now (m)."""
    return Change("behind", frees=lambda free, by: replace(free, behind_max_m=now_m + by))


def grips_nearer(now_m: float) -> Change:
    """Return the change that hands may be nearer to each other than now (m)."""
    return Change("apart", frees=lambda free, by: replace(free, grips_apart_m=now_m - by))


def grip_radius(folds: Collection[int], *, in_drags: bool) -> Change:
    """Return the change to grips that hold more cloth in some folds, beyond the least of their radii, and in drags."""

    def least_m(task: Task) -> float:
        return min(task.garment.folds[fold].grip_radius_m for fold in folds)

    def applied(task: Task, by: float) -> Task:
        radius_m, garment = _more(least_m(task), by), task.garment

        def widened(index: int, fold: DrawnFold) -> DrawnFold:
            return replace(fold, grip_radius_m=max(radius_m, fold.grip_radius_m)) if index in folds else fold

        of_drags_m = max(radius_m, garment.grip_radius_m) if in_drags else garment.grip_radius_m
        drawn = tuple(widened(index, fold) for index, fold in enumerate(garment.folds))
        return replace(task, garment=replace(garment, folds=drawn, grip_radius_m=of_drags_m))

    def says(before: Task, after: Task) -> Message:
        values = {"grip_radius_m": least_m(after), "folds": list(folds)}
        return worded("assume_grip_radius", values, before.garment.folds)

    return Change("grip_radius", applied, says=says)


def blue(fold: int) -> Change:
    """Return the change of a red fold into a blue one."""

    def applied(task: Task, _: float) -> Task:
        drawn = task.garment.folds
        folds = (*drawn[:fold], replace(drawn[fold], kind="blue"), *drawn[fold + 1 :])
        return replace(task, garment=replace(task.garment, folds=folds))

    return Change("blue", applied)


def cloth_moved(towards: Point3) -> Change:
    """Return a move of the cloth in a direction of the table frame."""
    x, y, _ = towards
    return Change("cloth", lambda task, by: task.at(task.start.placement.moved(by * x, by * y)))


def station_moved(station: str, towards: Point3) -> Change:
    """Return a move of a station against a direction of the table frame."""
    x, y, _ = towards

    def applied(task: Task, by: float) -> Task:
        poses = task.scene.stations
        moved = tuple((name, pose.moved(-by * x, -by * y) if name == station else pose) for name, pose in poses)
        return _in_scene(task, stations=moved)

    return Change("station", applied)


def table_lifted(up: float) -> Change:
    """Return the change to a higher table; lower where `up`, the vertical component of a direction, is negative."""

    def applied(task: Task, by: float) -> Task:
        table = task.scene.table
        return _in_scene(task, table=replace(table, height_m=table.height_m + by * up))

    return Change("table", applied)


def torso_lifted(up: float) -> Change:
    """Return the change to a lower torso; a higher one where `up` is negative."""
    return Change("torso", lambda task, by: _in_scene(task, torso_m=task.scene.torso_m - by * up))
