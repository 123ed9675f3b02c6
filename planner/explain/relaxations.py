"""Find what may remove the causes that a search met: for each of them relaxations, first those a person can carry out.

Points out of reach: the hands' path shifted, a smaller comfort radius, a wider approach cone, longer arms. Hands that
do not suffice: wider grips, hands closer together, stiffer cloth, one more hand. Cloth that slips or lies where it
cannot be folded: more friction, another place.
"""

import math
from collections.abc import Iterator
from dataclasses import replace

from planner.explain.change import (
    COLLISIONS_IGNORED,
    COMFORT,
    CONE,
    FRICTION,
    LONG_ARMS,
    ONE_MORE_HAND,
    STIFFNESS,
    Change,
    blue,
    cloth_moved,
    grip_radius,
    grips_nearer,
    reach_behind,
    station_moved,
    table_lifted,
    torso_lifted,
)
from planner.explain.reason_grips import GRIP_CODES, radius_for
from planner.explain.reason_out_of_reach import reached_with_comfort, reached_with_cone
from planner.explain.relaxation_trials import Relaxation
from planner.explain.room import Room
from planner.geometry.pose import Point3
from planner.geometry.tolerance import ANGLE_RAD, LENGTH_M
from planner.primitives.context import Context
from planner.task.reason import Code, Reason
from planner.task.scene import FRICTION_MAX, SUPPORT_ANGLE_MAX_RAD
from planner.words.catalogue import worded

_FURTHER_M = (0.0, 0.001, 0.1, 0.3)
"""Further distances by which cloth is moved where the least move only just allows it to lie there (m)."""

# Drags go by 0.1 m, so between their places less than the shortfall may be enough.
_BEYOND_M = (0.0, 0.025, 0.05, 0.1, 0.3)
"""Distances beyond the shortfall by which cloth is moved where no sufficient shift was found (m)."""

_UPRIGHT = 0.5
"""The component along z above which a direction counts as up or down."""

_THIRD_HAND_CORNERS_MAX = 12
"""Corners of the cloth above which the ways for three hands to hold it are too many."""


def candidates(context: Context, measured: tuple[Reason, ...], fold: int | None) -> Iterator[tuple[Relaxation, ...]]:
    """Yield what may keep a fold from being done, or the cloth from staying where it lies at the start.

    Args:
        context: the planning context, with the obstacles met.
        measured: the reasons that the search met.
        fold: the fold; None for the cloth at the start.

    Yields:
        for each possible cause the relaxations that may remove it.
    """
    mine = [reason for reason in measured if reason.fold == fold]
    if context.obstacles.has_slipped and context.scene.friction < FRICTION_MAX:
        slip = next((reason for reason in mine if reason.code is Code.SLIPS), _slips_on_the_way(context, fold))
        yield (_more_friction(context, slip),)
    directions: set[Point3 | None] = set()
    for reason in sorted(mine, key=lambda reason: reason.short_by_m or 0.0):
        found = tuple(_relaxations(context, reason))
        is_of_reach = reason.code is Code.OUT_OF_REACH
        if found and (is_of_reach or found[0].kind != "cloth" or reason.towards not in directions):
            directions.add(reason.towards)
            yield found


def _relaxations(context: Context, reason: Reason) -> Iterator[Relaxation]:
    if reason.code in GRIP_CODES and reason.fold is not None:
        yield from _of_hands(context, reason, reason.fold)
    elif reason.code in (Code.LINE_OFF_TABLE, Code.NOT_A_G_STATE):
        yield from _of_place(context, reason)
    elif reason.code is Code.OUT_OF_REACH:
        yield from _of_reach(context, reason)
    elif reason.code is Code.COLLISION:
        yield Relaxation(reason, COLLISIONS_IGNORED)


def _more_friction(context: Context, slip: Reason) -> Relaxation:
    now = context.scene.friction

    def reported(reason: Reason, amount: float) -> Reason:
        needed = now + amount
        if reason.needed_friction is not None and abs(reason.needed_friction - needed) <= LENGTH_M:
            return reason
        return replace(_slips_on_the_way(context, reason.fold, needed), offset_m=reason.offset_m, point=reason.point)

    measured = () if slip.needed_friction is None else (slip.needed_friction - now,)
    amounts = (*(by for by in measured if now + by < FRICTION_MAX), FRICTION_MAX - now)
    return Relaxation(slip, FRICTION, amounts, reported, lambda trial: trial.needed_friction - now)


def _slips_on_the_way(context: Context, fold: int | None, needed: float | None = None) -> Reason:
    """Return the reason that the cloth slips in a drag that the fold would need, or after it."""
    values = {"friction": context.scene.friction, "needed_friction": needed}
    says = worded("slips_on_the_way", values, context.sequence.folds, fold)
    return Reason(fold, Code.SLIPS, says, needed_friction=needed)


def _of_place(context: Context, reason: Reason) -> Iterator[Relaxation]:
    """Yield moves of the cloth so that it lies as it must, or more cloth carried behind a line."""
    if reason.fold is None:
        yield from _onto_table(context, reason)
    elif reason.shift_m is not None and reason.shift_towards is not None:
        yield _moved(reason, reason.shift_towards, reason.shift_m, _FURTHER_M)
    elif reason.short_by_m is not None and reason.point is None:
        yield Relaxation(reason, reach_behind(context.behind_max_m), (reason.short_by_m,))


def _onto_table(context: Context, reason: Reason) -> Iterator[Relaxation]:
    """Yield the move that brings all of the cloth onto the table; less of it may be enough."""
    room = Room.of(context.sequence.garment, context.placement, context.scene.table)
    x, y = room.nearest
    length = math.hypot(x, y)
    if not room.is_none and length > LENGTH_M:
        yield _moved(reason, (x / length, y / length, 0.0), length)


def _of_reach(context: Context, reason: Reason) -> Iterator[Relaxation]:
    smaller = list(_less_comfort(context, reason))
    if reason.cause == "comfort_only":
        yield from smaller
    if reason.shift_m is not None and reason.shift_towards is not None:
        yield from _path_shifted(reason, reason.station, reason.shift_m, reason.shift_towards)
    elif reason.short_by_m is not None and reason.towards is not None:
        x, y, _ = reason.towards
        flat = math.hypot(x, y)
        if flat > _UPRIGHT:
            yield _moved(reason, (x / flat, y / flat, 0.0), reason.short_by_m, _BEYOND_M)
    if reason.cause != "comfort_only":
        yield from smaller
    now_rad = context.scene.approach_cone_rad
    if now_rad < math.pi - ANGLE_RAD:

        def reported(reason: Reason, amount: float) -> Reason:
            return reached_with_cone(reason, context, now_rad + amount)

        yield Relaxation(reason, CONE, (math.pi - now_rad,), reported)
    yield Relaxation(reason, LONG_ARMS)


def _less_comfort(context: Context, reason: Reason) -> Iterator[Relaxation]:
    """Yield a smaller comfort radius; where a point lacks more than the whole radius, other changes must be added."""
    now_m = context.reach.comfort_m
    if now_m > 0.0:
        amounts = (now_m,) if reason.comfort_m is None else (now_m - reason.comfort_m, now_m)

        def reported(reason: Reason, amount: float) -> Reason:
            return reached_with_comfort(reason, context, max(now_m - amount, 0.0))

        yield Relaxation(reason, COMFORT, amounts, reported)


def _path_shifted(reason: Reason, station: str | None, by_m: float, towards: Point3) -> Iterator[Relaxation]:
    """Yield what shifts the hands' path as the robot sees it."""
    up = towards[2]
    if abs(up) > _UPRIGHT:
        changes = [table_lifted(up), torso_lifted(up)]
    else:
        yield _moved(reason, towards, by_m)
        changes = [] if station is None else [station_moved(station, towards)]
    for change in changes:
        yield _shift(reason, change, (by_m,), towards)


def _moved(reason: Reason, towards: Point3, by_m: float, further_m: tuple[float, ...] = (0.0,)) -> Relaxation:
    """Return a move of the cloth in a direction of the table frame, by `by_m` or by some lengths more (m)."""
    amounts = tuple(by_m + 2 * LENGTH_M + more for more in further_m)
    return _shift(reason, cloth_moved(towards), amounts, towards)


def _shift(reason: Reason, change: Change, amounts: tuple[float, ...], towards: Point3) -> Relaxation:
    return Relaxation(reason, change, amounts, lambda cause, by: replace(cause, shift_m=by, shift_towards=towards))


def _of_hands(context: Context, reason: Reason, fold: int) -> Iterator[Relaxation]:
    """Yield wider grips in the fold alone or in drags too, hands closer together, stiffer cloth, one more hand."""
    if reason.needed_grip_radius_m is None:
        yield Relaxation(reason, blue(fold))
        return
    now_m, needed_m = context.sequence.folds[fold].grip_radius_m, reason.needed_grip_radius_m
    one_hands_m = max(radius_for(context, fold, 1), needed_m)
    yield _wider_grip(context, reason, fold, (needed_m - now_m,), in_drags=False)
    amounts = tuple(sorted({needed_m - now_m, one_hands_m - now_m}))
    yield _wider_grip(context, reason, fold, amounts, in_drags=True)
    if reason.code is Code.GRIPS_TOO_CLOSE and reason.short_by_m is not None:
        yield Relaxation(reason, grips_nearer(context.grips_apart_m), (reason.short_by_m,))
    if reason.code is Code.TOO_MANY_GRIPS:
        yield _stiffer(context, reason)
        if len(context.sequence.garment.outline) <= _THIRD_HAND_CORNERS_MAX:
            says = worded("one_more_hand", {"hands": len(context.reach.arm_names)}, context.sequence.folds, fold)
            reported = replace(reason, says=says, needed_grip_radius_m=None)
            yield Relaxation(reason, ONE_MORE_HAND, (), lambda _, __: reported)


def _wider_grip(
    context: Context, reason: Reason, fold: int, amounts: tuple[float, ...], *, in_drags: bool
) -> Relaxation:
    now_m = context.sequence.folds[fold].grip_radius_m

    def reported(reason: Reason, amount: float) -> Reason:
        enough_m = now_m + amount
        if abs(enough_m - (reason.needed_grip_radius_m or 0.0)) <= LENGTH_M and not in_drags:
            return reason
        values = {"grip_radius_m": now_m, "needed_grip_radius_m": enough_m, "in_drags": in_drags}
        says = worded("wider_grip", values, context.sequence.folds, fold)
        return replace(reason, says=says, short_by_m=amount, needed_grip_radius_m=enough_m)

    return Relaxation(reason, grip_radius((fold,), in_drags=in_drags), amounts, reported)


def _stiffer(context: Context, reason: Reason) -> Relaxation:
    now_rad = context.scene.support_angle_rad

    def reported(reason: Reason, amount: float) -> Reason:
        values = {"support_angle_rad": now_rad, "needed_support_angle_rad": now_rad + amount}
        says = worded("stiffer_cloth", values, context.sequence.folds, reason.fold)
        return replace(reason, says=says, short_by_m=None, needed_grip_radius_m=None)

    return Relaxation(reason, STIFFNESS, (SUPPORT_ANGLE_MAX_RAD - now_rad,), reported)
