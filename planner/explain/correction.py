"""Ways to remove a cause: what changes, by how much, and the reason to tell once the change has been tried."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from planner.explain.reason_grips import needed_radius
from planner.explain.reason_out_of_reach import reached_with_comfort, reached_with_cone
from planner.explain.relaxed import Relaxed
from planner.explain.suggestion_grid import Room
from planner.geometry.pose import Point3
from planner.geometry.tolerance import ANGLE_RAD, LENGTH_M
from planner.planning.trial import Trial
from planner.primitives.context import Context
from planner.task.reason import Code, Reason
from planner.task.scene import SUPPORT_ANGLE_MAX_RAD
from planner.words.catalogue import worded

FRICTION_MAX = 10.0
"""The largest friction coefficient that a scene allows."""

_UPRIGHT = 0.5
"""The component along z above which a direction counts as up or down."""

_FURTHER_M = (0.001, 0.1, 0.3)
"""Further distances by which cloth is moved where the least move only just allows it to lie there (m)."""

# Drags go by 0.1 m, so between their places less than the shortfall may be enough.
_BEYOND_M = (0.0, 0.025, 0.05, 0.1, 0.3)
"""Distances beyond the shortfall by which cloth is moved where no sufficient shift was found (m)."""

_THIRD_HAND_CORNERS_MAX = 12
"""Corners of the cloth above which the ways for three hands to hold it are too many."""

_GRIPS = (Code.TOO_MANY_GRIPS, Code.GRIPS_TOO_CLOSE, Code.RED_NEEDS_HOLD)
"""Codes of reasons that the hands cannot hold what a fold needs."""


@dataclass(frozen=True, slots=True, eq=False)
class Way:
    """A way to remove a cause.

    Attributes:
        kind: what is changed; two ways of one kind are not combined.
        amounts: by how much, tried in turn, the last the most permissive; empty where the change has no degree.
        applied: applies the change by an amount to a problem.
        told: makes the reason to tell once the amount was tried.
        needed: the amount that the path found really needs, where that can be told.
        exact: the resolution of the least amount: with an amount smaller by this the fold cannot be done.
        is_dream: whether no robot can be changed like this; the way still shows what stands in the way.
    """

    kind: str
    amounts: tuple[float, ...]
    applied: Callable[[Relaxed, float], Relaxed]
    told: Callable[[Reason, float], Reason] = lambda reason, _: reason
    needed: Callable[[Trial], float] | None = None
    exact: float = 0.001
    is_dream: bool = False

    @property
    def most(self) -> float:
        """The largest amount; 0 where there are none."""
        return max(self.amounts, default=0.0)


COLLISIONS_IGNORED = Way("collision", (), lambda relaxed, _: relaxed.with_collisions_ignored())
"""Shows that nothing but collisions of the arms stands in the way."""


@dataclass(frozen=True, slots=True, eq=False)
class Candidate:
    """A possible cause, and ways to remove it, those first that a person can carry out."""

    reason: Reason
    ways: tuple[Way, ...]


def candidates(context: Context, measured: tuple[Reason, ...], fold: int | None) -> Iterator[Candidate]:
    """Yield what may keep a fold from being done, or the cloth from staying where it lies at the start.

    Args:
        context: the planning context, with the obstacles met.
        measured: the reasons that the search met.
        fold: the fold; None for the cloth at the start.
    """
    mine = [reason for reason in measured if reason.fold == fold]
    if context.has_slipped and context.scene.friction < FRICTION_MAX:
        slip = next((reason for reason in mine if reason.code is Code.SLIPS), _slips_on_the_way(context, fold))
        yield Candidate(slip, (_friction(context, slip),))
    moved: set[Point3 | None] = set()
    for reason in sorted(mine, key=lambda reason: reason.short_by_m or 0.0):
        ways = tuple(_ways(context, reason))
        is_told = ways and ways[0].kind == "cloth" and reason.code is not Code.OUT_OF_REACH and reason.towards in moved
        if ways and not is_told:
            moved.add(reason.towards)
            yield Candidate(reason, ways)


def _ways(context: Context, reason: Reason) -> Iterator[Way]:
    if reason.code in _GRIPS and reason.fold is not None:
        yield from _hands(context, reason, reason.fold)
    elif reason.code in (Code.LINE_OFF_TABLE, Code.NOT_A_G_STATE):
        yield from _cloth_moved(context, reason)
    elif reason.code is Code.OUT_OF_REACH:
        yield from _reach(context, reason)
    elif reason.code is Code.COLLISION:
        yield COLLISIONS_IGNORED


def _friction(context: Context, slip: Reason) -> Way:
    now = context.scene.friction

    def applied(relaxed: Relaxed, amount: float) -> Relaxed:
        return relaxed.with_scene(replace(relaxed.context.scene, friction=min(now + amount, FRICTION_MAX)))

    def told(reason: Reason, amount: float) -> Reason:
        needed = now + amount
        if reason.needed_friction is not None and abs(reason.needed_friction - needed) <= LENGTH_M:
            return reason
        other = _slips_on_the_way(context, reason.fold, needed)
        return replace(other, offset_m=reason.offset_m, point=reason.point)

    measured = () if slip.needed_friction is None else (slip.needed_friction - now,)
    amounts = (*(by for by in measured if now + by < FRICTION_MAX), FRICTION_MAX - now)
    return Way("friction", amounts, applied, told, lambda trial: trial.needed_friction - now)


def _slips_on_the_way(context: Context, fold: int | None, needed: float | None = None) -> Reason:
    """Return the reason that the cloth slips in a drag that the fold would need, or after it."""
    values = {"friction": context.scene.friction, "needed_friction": needed}
    says = worded("slips_on_the_way", values, context.sequence.folds, fold)
    return Reason(fold, Code.SLIPS, says, needed_friction=needed)


def _hands(context: Context, reason: Reason, fold: int) -> Iterator[Way]:
    """Yield ways: wider grips in the fold alone or in drags too, hands closer together, stiffer cloth, a third hand."""
    if reason.needed_grip_radius_m is None:
        yield _blue(fold)
        return
    drawn, needed = context.sequence.folds[fold], reason.needed_grip_radius_m
    by_m, one_hands_m = needed - drawn.grip_radius_m, _one_hands_radius(context, fold) - drawn.grip_radius_m
    yield _grip_radius(context, fold, (by_m,), needed, in_drags=False)
    yield _grip_radius(context, fold, tuple(sorted({by_m, max(one_hands_m, by_m)})), needed, in_drags=True)
    if reason.code is Code.GRIPS_TOO_CLOSE and reason.short_by_m is not None:
        apart_m = context.grips_apart_m
        yield Way("apart", (reason.short_by_m,), lambda relaxed, by: relaxed.with_grips_nearer(apart_m - by))
    if reason.code is Code.TOO_MANY_GRIPS:
        yield _stiffer(context, fold)
        if len(context.sequence.garment.outline) <= _THIRD_HAND_CORNERS_MAX:
            yield _third_hand(context, fold)


def _grip_radius(context: Context, fold: int, amounts: tuple[float, ...], needed: float, *, in_drags: bool) -> Way:
    now = context.sequence.folds[fold].grip_radius_m

    def applied(relaxed: Relaxed, amount: float) -> Relaxed:
        garment = relaxed.context.sequence.garment
        wider = replace(garment.folds[fold], grip_radius_m=now + amount)
        folds = (*garment.folds[:fold], wider, *garment.folds[fold + 1 :])
        of_drags = max(garment.grip_radius_m, now + amount) if in_drags else garment.grip_radius_m
        return relaxed.with_garment(replace(garment, folds=folds, grip_radius_m=of_drags))

    def told(reason: Reason, amount: float) -> Reason:
        if abs(now + amount - needed) <= LENGTH_M and not in_drags:
            return reason
        values = {"grip_radius_m": now, "needed_grip_radius_m": now + amount, "in_drags": in_drags}
        says = worded("wider_grip", values, context.sequence.folds, fold)
        return replace(reason, says=says, short_by_m=amount, needed_grip_radius_m=now + amount)

    return Way("grip_radius", amounts, applied, told)


def _stiffer(context: Context, fold: int) -> Way:
    """Return the way of stiffer cloth, of which more holds itself."""
    now = context.scene.support_angle_rad

    def applied(relaxed: Relaxed, amount: float) -> Relaxed:
        angle = min(now + amount, SUPPORT_ANGLE_MAX_RAD)
        return relaxed.with_scene(replace(relaxed.context.scene, support_angle_rad=angle))

    def told(reason: Reason, amount: float) -> Reason:
        values = {"support_angle_rad": now, "needed_support_angle_rad": now + amount}
        says = worded("stiffer_cloth", values, context.sequence.folds, fold)
        return replace(reason, says=says, short_by_m=None, needed_grip_radius_m=None)

    return Way("support_angle", (SUPPORT_ANGLE_MAX_RAD - now,), applied, told, exact=math.radians(0.5))


def _third_hand(context: Context, fold: int) -> Way:
    hands = len(context.reach.arm_names)

    def told(reason: Reason, _: float) -> Reason:
        says = worded("one_more_hand", {"hands": hands}, context.sequence.folds, fold)
        return replace(reason, says=says, needed_grip_radius_m=None)

    return Way("hands", (), lambda relaxed, _: relaxed.with_more_hands(1), told, is_dream=True)


def _one_hands_radius(context: Context, fold: int) -> float:
    """Return the grip radius with which one hand would hold all that a fold needs (m)."""
    drawn, arms = context.sequence.folds[fold], len(context.reach.arm_names)
    vertices = np.array(context.sequence.covers(fold, context.scene.support_angle_rad, arms).vertices)
    return needed_radius(context.sequence.moving(fold), drawn.line, vertices, 1) if len(vertices) else 0.0


def _blue(fold: int) -> Way:
    def applied(relaxed: Relaxed, _: float) -> Relaxed:
        garment = relaxed.context.sequence.garment
        blue = replace(garment.folds[fold], kind="blue")
        return relaxed.with_garment(replace(garment, folds=(*garment.folds[:fold], blue, *garment.folds[fold + 1 :])))

    return Way("blue", (), applied)


def _cloth_moved(context: Context, reason: Reason) -> Iterator[Way]:
    """Yield ways that move the cloth so that it lies as it must, or that let more cloth behind a line be carried."""
    if reason.fold is None:
        yield from _onto_table(context)
    elif reason.shift_m is not None and reason.shift_towards is not None:
        yield _moved("cloth", reason.shift_towards, reason.shift_m, _FURTHER_M)
    elif reason.short_by_m is not None and reason.point is None:
        yield Way(
            "behind", (reason.short_by_m,), lambda relaxed, by: relaxed.with_reach_behind(context.behind_max_m + by)
        )


def _onto_table(context: Context) -> Iterator[Way]:
    """Yield the way that moves the cloth until all of it lies on the table, or as far towards that as is enough."""
    room = Room.of(context.sequence.garment, context.placement, context.scene.table)
    x, y = room.nearest
    length = math.hypot(x, y)
    if not room.is_none and length > LENGTH_M:
        yield _moved("cloth", (x / length, y / length, 0.0), length)


def _moved(kind: str, towards: Point3, by_m: float, further_m: tuple[float, ...] = ()) -> Way:
    """Return the way of moving the cloth in a direction of the table frame, by `by_m` or by some lengths more (m)."""

    def applied(relaxed: Relaxed, amount: float) -> Relaxed:
        x, y, _ = (amount * part for part in towards)
        return relaxed.with_placement(relaxed.context.placement.moved(x, y))

    amounts = tuple(by_m + 2 * LENGTH_M + more for more in (0.0, *further_m))
    return Way(kind, amounts, applied, lambda reason, by: replace(reason, shift_m=by, shift_towards=towards))


def _reach(context: Context, reason: Reason) -> Iterator[Way]:
    """Yield ways: the hands' path shifted, a smaller comfort radius, a wider approach cone, arms of any length."""
    comfort = list(_comfort(context, reason))
    if reason.cause == "comfort_only":
        yield from comfort
    if reason.shift_m is not None and reason.shift_towards is not None:
        yield from _shifts(context, reason.station or "", reason.shift_m, reason.shift_towards)
    elif reason.short_by_m is not None and reason.towards is not None:
        x, y, _ = reason.towards
        flat = math.hypot(x, y)
        if flat > _UPRIGHT:
            yield _moved("cloth", (x / flat, y / flat, 0.0), reason.short_by_m, _BEYOND_M)
    if reason.cause != "comfort_only":
        yield from comfort
    if context.scene.approach_cone_rad < math.pi - ANGLE_RAD:
        yield _cone(context)
    yield Way("arms", (), lambda relaxed, _: relaxed.with_long_arms(), is_dream=True)


def _cone(context: Context) -> Way:
    """Return the way of a wider approach cone."""
    now = context.scene.approach_cone_rad

    def applied(relaxed: Relaxed, amount: float) -> Relaxed:
        return relaxed.with_scene(replace(relaxed.context.scene, approach_cone_rad=min(now + amount, math.pi)))

    def told(reason: Reason, amount: float) -> Reason:
        return reached_with_cone(reason, context, now + amount)

    return Way("cone", (math.pi - now,), applied, told, exact=math.radians(0.5))


def _comfort(context: Context, reason: Reason) -> Iterator[Way]:
    """Yield the way of a smaller comfort radius, combined with others where a point lacks more than all of it."""
    now = context.reach.comfort_m
    if now <= 0.0:
        return

    def told(reason: Reason, amount: float) -> Reason:
        return reached_with_comfort(reason, context, max(now - amount, 0.0))

    amounts = (now,) if reason.comfort_m is None else (now - reason.comfort_m, now)
    yield Way("comfort", amounts, lambda relaxed, by: relaxed.with_comfort(max(now - by, 0.0)), told)


def _shifts(context: Context, station: str, by_m: float, towards: Point3) -> Iterator[Way]:
    if abs(towards[2]) > _UPRIGHT:
        yield from _lifted(by_m, towards)
        return
    yield _moved("cloth", towards, by_m)

    def robot_moved(relaxed: Relaxed, amount: float) -> Relaxed:
        x, y, _ = (-amount * part for part in towards)
        stations = tuple((n, p.moved(x, y) if n == station else p) for n, p in relaxed.context.scene.stations)
        return relaxed.with_scene(replace(relaxed.context.scene, stations=stations))

    yield Way("station", (by_m,), robot_moved, _told_shift(towards))


def _lifted(by_m: float, towards: Point3) -> Iterator[Way]:
    """Yield ways that raise or lower the table, or that move the torso the other way."""

    def table_lifted(relaxed: Relaxed, amount: float) -> Relaxed:
        scene = relaxed.context.scene
        height = scene.table.height_m + amount * towards[2]
        return relaxed.with_scene(replace(scene, table=replace(scene.table, height_m=height)))

    def torso_lifted(relaxed: Relaxed, amount: float) -> Relaxed:
        scene = relaxed.context.scene
        return relaxed.with_scene(replace(scene, torso_m=scene.torso_m - amount * towards[2]))

    yield Way("table", (by_m,), table_lifted, _told_shift(towards))
    yield Way("torso", (by_m,), torso_lifted, _told_shift(towards))


def _told_shift(towards: Point3) -> Callable[[Reason, float], Reason]:
    return lambda reason, amount: replace(reason, shift_m=amount, shift_towards=towards)
