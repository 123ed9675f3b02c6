"""Find candidate causes among the reasons that a search met, each with the relaxations that may remove it."""

import math
from collections.abc import Iterator
from dataclasses import replace

from planner.explain.relaxation import COLLISIONS_IGNORED, Candidate, Relaxation, moved
from planner.explain.relaxation_hands import hand_relaxations
from planner.explain.relaxation_reach import reach_relaxations
from planner.explain.relaxed_problem import RelaxedProblem
from planner.explain.suggestion_grid import Room
from planner.geometry.pose import Point3
from planner.geometry.tolerance import LENGTH_M
from planner.primitives.context import Context
from planner.task.reason import Code, Reason
from planner.task.scene import FRICTION_MAX
from planner.words.catalogue import worded

_FURTHER_M = (0.001, 0.1, 0.3)
"""Further distances by which cloth is moved where the least move only just allows it to lie there (m)."""

_GRIPS = (Code.TOO_MANY_GRIPS, Code.GRIPS_TOO_CLOSE, Code.RED_NEEDS_HOLD)
"""Codes of reasons that the hands cannot hold what a fold needs."""


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
    told: set[Point3 | None] = set()
    for reason in sorted(mine, key=lambda reason: reason.short_by_m or 0.0):
        relaxations = tuple(_relaxations(context, reason))
        is_told = (
            relaxations
            and relaxations[0].kind == "cloth"
            and reason.code is not Code.OUT_OF_REACH
            and reason.towards in told
        )
        if relaxations and not is_told:
            told.add(reason.towards)
            yield Candidate(reason, relaxations)


def _relaxations(context: Context, reason: Reason) -> Iterator[Relaxation]:
    if reason.code in _GRIPS and reason.fold is not None:
        yield from hand_relaxations(context, reason, reason.fold)
    elif reason.code in (Code.LINE_OFF_TABLE, Code.NOT_A_G_STATE):
        yield from _cloth_moved(context, reason)
    elif reason.code is Code.OUT_OF_REACH:
        yield from reach_relaxations(context, reason)
    elif reason.code is Code.COLLISION:
        yield COLLISIONS_IGNORED


def _friction(context: Context, slip: Reason) -> Relaxation:
    now = context.scene.friction

    def applied(relaxed: RelaxedProblem, amount: float) -> RelaxedProblem:
        return relaxed.with_scene(replace(relaxed.context.scene, friction=min(now + amount, FRICTION_MAX)))

    def told(reason: Reason, amount: float) -> Reason:
        needed = now + amount
        if reason.needed_friction is not None and abs(reason.needed_friction - needed) <= LENGTH_M:
            return reason
        other = _slips_on_the_way(context, reason.fold, needed)
        return replace(other, offset_m=reason.offset_m, point=reason.point)

    measured = () if slip.needed_friction is None else (slip.needed_friction - now,)
    amounts = (*(by for by in measured if now + by < FRICTION_MAX), FRICTION_MAX - now)
    return Relaxation("friction", amounts, applied, told, lambda trial: trial.needed_friction - now)


def _slips_on_the_way(context: Context, fold: int | None, needed: float | None = None) -> Reason:
    """Return the reason that the cloth slips in a drag that the fold would need, or after it."""
    values = {"friction": context.scene.friction, "needed_friction": needed}
    says = worded("slips_on_the_way", values, context.sequence.folds, fold)
    return Reason(fold, Code.SLIPS, says, needed_friction=needed)


def _cloth_moved(context: Context, reason: Reason) -> Iterator[Relaxation]:
    """Yield moves of the cloth so that it lies as it must, or more cloth carried behind a line."""
    if reason.fold is None:
        yield from _onto_table(context)
    elif reason.shift_m is not None and reason.shift_towards is not None:
        yield moved("cloth", reason.shift_towards, reason.shift_m, _FURTHER_M)
    elif reason.short_by_m is not None and reason.point is None:
        yield Relaxation(
            "behind", (reason.short_by_m,), lambda relaxed, by: relaxed.with_reach_behind(context.behind_max_m + by)
        )


def _onto_table(context: Context) -> Iterator[Relaxation]:
    """Yield a move of the cloth until all of it lies on the table, or as far towards that as is enough."""
    room = Room.of(context.sequence.garment, context.placement, context.scene.table)
    x, y = room.nearest
    length = math.hypot(x, y)
    if not room.is_none and length > LENGTH_M:
        yield moved("cloth", (x / length, y / length, 0.0), length)
