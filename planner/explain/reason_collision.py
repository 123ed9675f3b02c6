"""Report collisions that the arms cannot avoid in a fold, or in a drag that some fold would need.

Where the arms fail to drag the cloth, no fold has been tried, yet it is a fold that cannot be done. So a drag is
reported with each fold that would be within reach right after it, and with no fold where it only leads to another drag.
"""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from planner.explain.reason_out_of_reach import dragged
from planner.explain.reason_reach import from_every_station
from planner.geometry.pose import Point2
from planner.primitives.context import Context
from planner.primitives.fold_obstacles import geometric_obstacle
from planner.primitives.fold_trial import fold_trials
from planner.primitives.fold_way import can_follow
from planner.primitives.obstacle import BlockingContact, Obstacle
from planner.primitives.primitive import Step
from planner.primitives.state import State
from planner.task.reason import Code, Reason
from planner.words.catalogue import worded

_START = (0.0, 0.0)
"""The offset of cloth that has not been dragged (m)."""


def collisions(context: Context, step: Step, contact: BlockingContact | None) -> Iterator[Obstacle]:
    """Yield a step that the arms cannot perform, although its places are in reach, as obstacles to folds.

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
    """Return the drag in which the arms collide (m); None where they collide in the fold."""
    if obstacle.dragged_to is None:
        return None
    return [to - before + 0.0 for to, before in zip(obstacle.dragged_to, state.offset, strict=True)]


def _offset_then(context: Context, obstacle: Obstacle, state: State) -> Point2:
    """Return how far the cloth has been dragged when the arms collide.

    Where the contact and the held point are known, it is how far the hand has taken what it holds.
    """
    if obstacle.contact is None or obstacle.dragged_to is None or obstacle.point is None:
        return state.offset
    x, y = np.array(obstacle.contact.point[:2]) - context.placed(_START).to_outer(np.array(obstacle.point))
    return (float(x), float(y))


def _held_by(context: Context, step: Step, contact: BlockingContact | None) -> Point2 | None:
    """Return the point that the colliding hand holds, article frame (m)."""
    for grip in step.grips:
        if contact is not None and grip.arm == contact.arm:
            x, y = context.placed(step.before.offset).to_inner(np.array(grip.pick[:2]))
            return (float(x), float(y))
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
