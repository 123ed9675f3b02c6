"""Relaxations of reach: the hands' path shifted, a smaller comfort radius, a wider approach cone, longer arms."""

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

from planner.explain.reason_out_of_reach import reached_with_comfort, reached_with_cone
from planner.explain.relaxation import Relaxation, moved
from planner.explain.relaxed_problem import RelaxedProblem
from planner.geometry.pose import Point3
from planner.geometry.tolerance import ANGLE_RAD
from planner.primitives.context import Context
from planner.task.reason import Reason

_UPRIGHT = 0.5
"""The component along z above which a direction counts as up or down."""

# Drags go by 0.1 m, so between their places less than the shortfall may be enough.
_BEYOND_M = (0.0, 0.025, 0.05, 0.1, 0.3)
"""Distances beyond the shortfall by which cloth is moved where no sufficient shift was found (m)."""


def reach_relaxations(context: Context, reason: Reason) -> Iterator[Relaxation]:
    """Yield the hands' path shifted, a smaller comfort radius, a wider approach cone, arms of any length."""
    comfort = list(_comfort(context, reason))
    if reason.cause == "comfort_only":
        yield from comfort
    if reason.shift_m is not None and reason.shift_towards is not None:
        yield from _shifts(context, reason.station or "", reason.shift_m, reason.shift_towards)
    elif reason.short_by_m is not None and reason.towards is not None:
        x, y, _ = reason.towards
        flat = math.hypot(x, y)
        if flat > _UPRIGHT:
            yield moved("cloth", (x / flat, y / flat, 0.0), reason.short_by_m, _BEYOND_M)
    if reason.cause != "comfort_only":
        yield from comfort
    if context.scene.approach_cone_rad < math.pi - ANGLE_RAD:
        yield _cone(context)
    yield Relaxation("arms", (), lambda relaxed, _: relaxed.with_long_arms(), is_hypothetical=True)


def _cone(context: Context) -> Relaxation:
    """Return the relaxation to a wider approach cone."""
    now = context.scene.approach_cone_rad

    def applied(relaxed: RelaxedProblem, amount: float) -> RelaxedProblem:
        return relaxed.with_scene(replace(relaxed.context.scene, approach_cone_rad=min(now + amount, math.pi)))

    def told(reason: Reason, amount: float) -> Reason:
        return reached_with_cone(reason, context, now + amount)

    return Relaxation("cone", (math.pi - now,), applied, told, exact=math.radians(0.5))


def _comfort(context: Context, reason: Reason) -> Iterator[Relaxation]:
    """Yield a smaller comfort radius, combined with others where a point lacks more than all of it."""
    now = context.reach.comfort_m
    if now <= 0.0:
        return

    def told(reason: Reason, amount: float) -> Reason:
        return reached_with_comfort(reason, context, max(now - amount, 0.0))

    amounts = (now,) if reason.comfort_m is None else (now - reason.comfort_m, now)
    yield Relaxation("comfort", amounts, lambda relaxed, by: relaxed.with_comfort(max(now - by, 0.0)), told)


def _shifts(context: Context, station: str, by_m: float, towards: Point3) -> Iterator[Relaxation]:
    if abs(towards[2]) > _UPRIGHT:
        yield from _lifted(by_m, towards)
        return
    yield moved("cloth", towards, by_m)

    def robot_moved(relaxed: RelaxedProblem, amount: float) -> RelaxedProblem:
        x, y, _ = (-amount * part for part in towards)
        stations = tuple((n, p.moved(x, y) if n == station else p) for n, p in relaxed.context.scene.stations)
        return relaxed.with_scene(replace(relaxed.context.scene, stations=stations))

    yield Relaxation("station", (by_m,), robot_moved, _told_shift(towards))


def _lifted(by_m: float, towards: Point3) -> Iterator[Relaxation]:
    """Yield the table raised or lowered, or the torso the other way."""

    def table_lifted(relaxed: RelaxedProblem, amount: float) -> RelaxedProblem:
        scene = relaxed.context.scene
        height = scene.table.height_m + amount * towards[2]
        return relaxed.with_scene(replace(scene, table=replace(scene.table, height_m=height)))

    def torso_lifted(relaxed: RelaxedProblem, amount: float) -> RelaxedProblem:
        scene = relaxed.context.scene
        return relaxed.with_scene(replace(scene, torso_m=scene.torso_m - amount * towards[2]))

    yield Relaxation("table", (by_m,), table_lifted, _told_shift(towards))
    yield Relaxation("torso", (by_m,), torso_lifted, _told_shift(towards))


def _told_shift(towards: Point3) -> Callable[[Reason, float], Reason]:
    return lambda reason, amount: replace(reason, shift_m=amount, shift_towards=towards)
