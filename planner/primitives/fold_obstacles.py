"""Obstacles to a fold that do not depend on the arms: its line, the cloth behind it, and the cloth afterwards."""

from collections.abc import Iterator

import numpy as np

from planner.cloth.fold_kinds import FOLD_KINDS
from planner.geometry.pose import Point2
from planner.geometry.table import TableTop
from planner.geometry.tolerance import LENGTH_M
from planner.primitives.context import Context
from planner.primitives.obstacle import Obstacle
from planner.primitives.state import State
from planner.task.reason import Code
from planner.words.catalogue import worded


def depths(context: Context) -> tuple[tuple[float, float], ...]:
    """Return the smallest and the largest distance of what each fold moves from its line, to the left (m)."""
    found = []
    for fold in context.sequence.folds:
        distances = fold.line.left_distances(context.sequence.moving(fold.index).coordinates)
        found.append((float(distances.min()), float(distances.max())))
    return tuple(found)


def geometric_obstacle(context: Context, state: State, fold: int) -> Obstacle | None:
    """Return the first obstacle to a fold that does not depend on the arms; None if there is none."""
    return next(geometric_obstacles(context, state, fold), None)


def geometric_obstacles(context: Context, state: State, fold: int) -> Iterator[Obstacle]:
    """Yield all obstacles to a fold in a state that do not depend on the arms."""
    folds = context.sequence.folds
    if not is_line_on_table(context, fold, state.offset):
        off = context.table_in_garment(state.offset).region.distance_to(folds[fold].line)
        says = worded("line_off_table", {"off_m": float(off)}, folds, fold)
        yield Obstacle(fold, Code.LINE_OFF_TABLE, says, off, state)
    behind = -context.kept(depths)[fold][0]
    if behind > context.behind_max_m + LENGTH_M:
        says = worded("behind_line", {"behind_m": behind}, folds, fold)
        yield Obstacle(fold, Code.NOT_A_G_STATE, says, behind, state)
    out_m = edge_off_table(context, fold, state.offset)
    if out_m > LENGTH_M:
        yield Obstacle(fold, Code.LINE_OFF_TABLE, worded("turn_off_table", {"off_m": out_m}, folds, fold), out_m, state)
    violation = context.stability_violation(state.done | 1 << fold, state.offset)
    context.obstacles.note_violation(violation)
    if violation is not None:
        says = worded("afterwards", {"what": violation.says.to_dict()}, folds, fold)
        yield Obstacle(fold, Code(violation.code), says, violation.severity, state, violation.point)


def edge_off_table(context: Context, fold: int, offset: Point2) -> float:
    """Return how far the edge about which a fold turns all of the cloth reaches beyond the table (m); else 0.

    Nothing but that edge lies on the table while the cloth stands.
    """
    line = context.sequence.folds[fold].line
    if not FOLD_KINDS[context.sequence.folds[fold].kind].is_whole:
        return 0.0
    ends = context.placed(offset).to_outer(np.array([line.start, line.end]))
    return float(TableTop.of(context.scene.table).beyond(ends).max())


def is_line_on_table(context: Context, fold: int, offset: Point2) -> bool:
    """Return whether a part of a fold's line is over the table top after drags by `offset`."""
    line = context.sequence.folds[fold].line
    is_end_on_table = context.is_on_table(line.start, offset) or context.is_on_table(line.end, offset)
    return is_end_on_table or bool(context.table_in_garment(offset).region.overlaps_with(line))
