"""Turn obstacles into reasons: compute their numbers, and what would help.

Where the arms fail to drag the cloth, no fold has been tried, yet it is a fold that cannot be done. So a drag is
reported with each fold that would be within reach right after it, and with no fold where it only leads to another drag.
"""

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from planner.explain.reason_grips import farthest_from, held_radius, radius_for
from planner.explain.reason_out_of_reach import dragged
from planner.explain.reason_reach import from_every_station
from planner.geometry.pose import Point2, Point3, point2
from planner.geometry.tolerance import LENGTH_M
from planner.message import plain_points
from planner.primitives.context import Context
from planner.primitives.fold_obstacles import geometric_obstacle, geometric_obstacles
from planner.primitives.fold_trial import fold_trials
from planner.primitives.fold_way import can_follow
from planner.primitives.grasping import lifted_points, nearest_pair_m
from planner.primitives.obstacle import BlockingContact, Obstacle
from planner.primitives.primitive import Step
from planner.primitives.state import UNDRAGGED, State
from planner.task.reason import Code, Reason
from planner.words.catalogue import worded

_MOVE_STEP_M, _MOVES = 0.02, 50
"""Step of the moves tried where it is unknown how far cloth must be moved (m), and their number."""

_UNKNOWN_M, _SLACK_M = 1.0, 1e-3
"""Severity of an obstacle of unknown size, and how much further cloth is moved when a direction is checked (m)."""


def of_obstacle(context: Context, obstacle: Obstacle) -> Reason:
    """Return an obstacle as a reason, with its numbers computed."""
    if obstacle.code is Code.COLLISION and obstacle.state is not None:
        return collision_reason(context, obstacle, obstacle.state)
    if obstacle.fold is not None and obstacle.state is not None:
        if obstacle.code is Code.TOO_MANY_GRIPS:
            return _too_many_grips(context, obstacle.fold)
        if obstacle.code is Code.GRIPS_TOO_CLOSE:
            return _grips_too_close(context, obstacle.fold)
        if obstacle.code is Code.RED_NEEDS_HOLD:
            held = lifted_points(context, obstacle.fold, obstacle.state.held)
            return _red_needs_hold(context, obstacle.fold, tuple(held))
    return _at_rest(context, obstacle)


def lacking(reason: Reason, context: Context) -> float:
    """Return how much is lacking, for ordering repairs by size (m, or of the friction coefficient)."""
    if reason.needed_friction is not None:
        return reason.needed_friction - context.scene.friction
    return math.inf if reason.short_by_m is None else reason.short_by_m


def _at_rest(context: Context, obstacle: Obstacle) -> Reason:
    """Return an obstacle of cloth at rest as a reason: how it would lie or slip."""
    is_slip = obstacle.code is Code.SLIPS
    state = obstacle.state
    move: tuple[float, Point3] | None = None
    if obstacle.fold is not None and state is not None and not is_slip:
        move = _least_move(context, obstacle, obstacle.fold, state)
    point: Point3 | None = None
    assert obstacle.says is not None
    says = obstacle.says
    if state is not None:
        says = worded(says.code, {**says.values, **dragged(state)}, context.sequence.folds, obstacle.fold)
        if obstacle.point is not None:
            x, y = context.placed(state.offset).to_outer(np.array(obstacle.point))
            point = (float(x), float(y), 0.0)
    return Reason(
        obstacle.fold,
        obstacle.code,
        says,
        point=point,
        short_by_m=None if is_slip or obstacle.severity >= _UNKNOWN_M else obstacle.severity,
        towards=None if move is None else move[1],
        shift_m=None if move is None else move[0],
        shift_towards=None if move is None else move[1],
        offset_m=None if state is None else state.offset,
        needed_friction=context.scene.friction + obstacle.severity if is_slip else None,
    )


def _least_move(context: Context, obstacle: Obstacle, fold: int, state: State) -> tuple[float, Point3] | None:
    """Return how far the cloth must be moved for obstacles of this kind to disappear (m), and in which direction.

    The directions tried are those along the table's edges; None where none helps.
    """
    if math.isinf(obstacle.severity):
        return None
    steps = _MOVE_STEP_M * np.arange(1, _MOVES + 1)
    known = [obstacle.severity] if obstacle.severity < _UNKNOWN_M else []
    for step in (*known, *steps[steps > max(known, default=0.0)]):
        if context.deadline.is_over:
            break
        for x, y in ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)):
            if _is_gone(context, obstacle, fold, state, (x * step, y * step)):
                return float(step), (x, y, 0.0)
    return None


def _is_gone(context: Context, obstacle: Obstacle, fold: int, state: State, move: Point2) -> bool:
    """Return whether no obstacle of the kind is left with the cloth moved (m)."""
    slack = 1.0 + _SLACK_M / max(math.hypot(*move), LENGTH_M)
    at = replace(state, offset=(state.offset[0] + slack * move[0], state.offset[1] + slack * move[1]))
    return all(other.code is not obstacle.code for other in geometric_obstacles(context, at, fold))


def _too_many_grips(context: Context, fold: int) -> Reason:
    drawn, arms = context.sequence.folds[fold], len(context.reach.arm_names)
    vertices = np.array(context.sequence.covers(fold, context.scene.support_angle_rad, arms).vertices)
    needed = radius_for(context, fold, arms)
    ordered = vertices[np.argsort(drawn.line.positions(vertices), kind="stable")]
    short = needed - drawn.grip_radius_m
    values = {"points": plain_points(ordered), "hands": arms, **_radii(drawn.grip_radius_m, needed)}
    says = worded("too_many_grips", values, context.sequence.folds, fold)
    return Reason(fold, Code.TOO_MANY_GRIPS, says, short_by_m=short, needed_grip_radius_m=needed)


def _grips_too_close(context: Context, fold: int) -> Reason:
    drawn, arms = context.sequence.folds[fold], len(context.reach.arm_names)
    found = context.sequence.covers(fold, context.scene.support_angle_rad, arms)
    cover = np.array(max(found.covers, key=lambda c: nearest_pair_m(np.array(c))))
    apart = nearest_pair_m(cover)
    needed = radius_for(context, fold, 1)
    values = {
        "points": plain_points(cover),
        "apart_m": apart,
        "needed_apart_m": context.grips_apart_m,
        **_radii(drawn.grip_radius_m, needed),
    }
    says = worded("grips_too_close", values, context.sequence.folds, fold)
    return Reason(
        fold, Code.GRIPS_TOO_CLOSE, says, short_by_m=context.grips_apart_m - apart, needed_grip_radius_m=needed
    )


def _red_needs_hold(context: Context, fold: int, held: tuple[Point2, ...]) -> Reason:
    drawn, arms = context.sequence.folds[fold], len(context.reach.arm_names)
    vertices = np.array(context.sequence.covers(fold, context.scene.support_angle_rad, arms).vertices)
    x, y = farthest_from(held, vertices)
    needed = held_radius(held, vertices)
    where = {"at": [x, y], "before": fold - 1}
    if math.isinf(needed):
        return Reason(fold, Code.RED_NEEDS_HOLD, worded("red_unheld", where, context.sequence.folds, fold))
    short = needed - drawn.grip_radius_m
    values = {**where, **_radii(drawn.grip_radius_m, needed)}
    says = worded("red_held_too_far", values, context.sequence.folds, fold)
    return Reason(fold, Code.RED_NEEDS_HOLD, says, short_by_m=short, needed_grip_radius_m=needed)


def _radii(radius_m: float, needed_m: float) -> dict[str, float]:
    """Return the assumed grip radius and the one that would be enough, as values of a message (m)."""
    return {"grip_radius_m": radius_m, "needed_grip_radius_m": needed_m}


def collisions(context: Context, step: Step, contact: BlockingContact | None) -> Iterator[Obstacle]:
    """Yield the obstacles to folds of a step that the arms cannot perform although its places are in reach.

    Args:
        context: the planning context.
        step: a fold or a drag.
        contact: the blocking contact, where it is known.
    """
    depth_m, own = math.inf if contact is None else contact.depth_m, step.details.get("fold")
    if own is not None:
        yield Obstacle(own, Code.COLLISION, None, depth_m, step.before, contact=contact)
        return
    held = _held_by(context, step, contact)
    for fold in _next_folds(context, step.after) or (None,):
        yield Obstacle(fold, Code.COLLISION, None, depth_m, step.before, held, contact, dragged_to=step.after.offset)


def collision_reason(context: Context, obstacle: Obstacle, state: State) -> Reason:
    """Return a collision as a reason; `state` is the state in which the fold or the drag begins."""
    contact, station = obstacle.contact, context.scene.stations[state.station][0]
    folds = context.sequence.folds
    values = {"station": station or None, "drag": _way(obstacle, state), **dragged(state)}
    if contact is None:
        says = worded("arms_cannot_get_there", values, folds, obstacle.fold)
        return Reason(obstacle.fold, Code.COLLISION, says, station=station or None, offset_m=state.offset)
    return Reason(
        obstacle.fold,
        Code.COLLISION,
        worded("collision", {**values, **_touching(contact)}, folds, obstacle.fold),
        cause=contact.cause,
        point=contact.point,
        short_by_m=contact.depth_m,
        is_at_least=True,
        arm=contact.arm,
        station=station or None,
        offset_m=_offset_then(context, obstacle, state),
    )


def _touching(contact: BlockingContact) -> dict[str, Any]:
    """Return a blocking contact as values of a message."""
    return {"arm": contact.arm, "at": list(contact.point), "parts": list(contact.parts), "depth_m": contact.depth_m}


def _way(obstacle: Obstacle, state: State) -> list[float] | None:
    """Return the drag (m) during which the arms collide; None if they collide during the fold."""
    if obstacle.dragged_to is None:
        return None
    return [to - before + 0.0 for to, before in zip(obstacle.dragged_to, state.offset, strict=True)]


def _offset_then(context: Context, obstacle: Obstacle, state: State) -> Point2:
    """Return how far the cloth has been dragged when the arms collide.

    Where the contact and the held point are known, it is how far the hand has taken what it holds.
    """
    if obstacle.contact is None or obstacle.dragged_to is None or obstacle.point is None:
        return state.offset
    return point2(np.array(obstacle.contact.point[:2]) - context.placed(UNDRAGGED).to_outer(np.array(obstacle.point)))


def _held_by(context: Context, step: Step, contact: BlockingContact | None) -> Point2 | None:
    """Return the point that the colliding hand holds, garment frame (m)."""
    for grip in step.grips:
        if contact is not None and grip.arm == contact.arm:
            return point2(context.placed(step.before.offset).to_inner(np.array(grip.pick[:2])))
    return None


def _next_folds(context: Context, state: State) -> tuple[int, ...]:
    """Return the folds that the arms could do next without an obstacle."""
    folds = context.sequence.folds
    return tuple(
        f for f in context.sequence.dag.available(state.done) if not folds[f].is_red and _is_next(context, state, f)
    )


def _is_next(context: Context, state: State, fold: int) -> bool:
    if geometric_obstacle(context, state, fold) is not None:
        return False
    stands = 1 << state.standoff if state.held else None
    return any(
        can_follow(context, at.station, trial, stands)
        for at in from_every_station(context, state)
        for trial in fold_trials(context, at, fold)
    )
