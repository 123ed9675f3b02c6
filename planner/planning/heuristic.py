"""Lower bounds on the time to a goal (paper, section 5.3)."""

from collections.abc import Callable
from functools import cache

from planner.primitives.context import Context
from planner.primitives.state import State

Heuristic = Callable[[State], float]


def arm_time(context: Context, wanted: int = -1) -> Heuristic:
    """The arms' time for those of the remaining folds that are wanted (a bit mask; -1: all), constraints ignored.

    Reach, apex, end for a blue fold; apex, end for a red one; the reach is saved while a drag's grips are held.
    It is consistent: a fold lowers it by at most the arms' share of what the fold costs, holding on after a drag by
    the one motion that the drag costs at least, and nothing else lowers it.
    """
    motion = context.scene.arm_motion_s
    motions = [2 if fold.is_red else 3 for fold in context.sequence.folds]

    @cache
    def left(done: int) -> int:
        return sum(m for i, m in enumerate(motions) if wanted & ~done & 1 << i)

    def remaining(state: State) -> float:
        return motion * max(left(state.done) - (1 if state.is_dragged else 0), 0)

    return remaining


def zero(_: Context) -> Heuristic:
    """No bound at all: A* becomes Dijkstra's search."""
    return lambda _state: 0.0


HEURISTICS: dict[str, Callable[[Context], Heuristic]] = {"arm_time": arm_time, "zero": zero}
"""The heuristics by the names that requests use."""
