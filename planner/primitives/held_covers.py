"""Find grips already held that hold all that a fold needs."""

import numpy as np

from planner.cloth.grips import Cover, best_covers, firm_covers
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M
from planner.primitives.context import Context
from planner.primitives.state import Held


def held_covers(context: Context, fold: int, held: tuple[Held, ...]) -> tuple[tuple[Held, ...], ...]:
    """Return the sets of grips already held that hold all that a fold needs, the firm first; empty if none does.

    Where hands hold firmly, a red fold has those that hold it best: nothing else can be taken. Only hands on the
    moving part count: on the fold line, or on cloth that stays, a hand lifts nothing.
    """
    return context.kept(_HeldCovers).of(fold, held)


class _HeldCovers:
    """The sets of grips already held that suffice for a fold; many states share them, so they are kept.

    Grips that are equal on the grid share an answer though their points differ by a rounding error. So an answer holds
    the grips' numbers, not their points.
    """

    def __init__(self, context: Context) -> None:
        self._context = context
        self._known: dict[tuple[object, ...], tuple[tuple[int, ...], ...]] = {}

    def of(self, fold: int, held: tuple[Held, ...]) -> tuple[tuple[Held, ...], ...]:
        key = (fold, *(h.key for h in held))
        if key not in self._known:
            number = {h.point: i for i, h in enumerate(held)}
            covers = self._search(fold, held)
            self._known[key] = tuple(tuple(number[point] for point in cover) for cover in covers)
        return tuple(tuple(held[i] for i in numbers) for numbers in self._known[key])

    def _search(self, fold: int, held: tuple[Held, ...]) -> tuple[Cover, ...]:
        context = self._context
        arms = len(context.reach.arm_names)
        known = context.sequence.covers(fold, context.scene.support_angle_rad, arms)
        points = lifted_points(context, fold, held)
        drawn = context.sequence.folds[fold]
        candidates, must = np.array(points).reshape(-1, 2), np.array(known.vertices)
        if context.is_firm and not drawn.is_red:
            return best_covers(candidates, must, known.firm_m, len(held))
        firm = firm_covers(candidates, must, drawn.grip_radius_m, len(held))
        covers = best_covers(candidates, must, drawn.grip_radius_m, len(held))
        return firm if context.is_firm or firm == covers else (*firm, *covers)


def lifted_points(context: Context, fold: int, held: tuple[Held, ...]) -> list[Point2]:
    """Return the grips held that lie on the part that a fold moves, article frame (m)."""
    line, moving = context.sequence.folds[fold].line, context.sequence.moving(fold)
    return [h.point for h in held if _is_lifted(h.point, moving, line)]


def _is_lifted(point: Point2, moving: Region, line: Segment) -> bool:
    """Return whether a point of the cloth lies on the moving part, off the fold line."""
    is_on_part = moving.contains(point) or moving.boundary_distance(point) <= LENGTH_M
    return is_on_part and float(line.distances(np.array([point]))[0]) > LENGTH_M
