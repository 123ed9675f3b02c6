"""Lower bounds on the time to the goal (paper, section 5.3)."""

from collections.abc import Callable
from functools import cache

from planner.primitives.context import Context
from planner.primitives.state import State
from planner.task.task import HeuristicName

Heuristic = Callable[[State], float]
"""A lower bound on the time from a state to the goal (s)."""


def arm_time(context: Context, wanted: int = -1) -> Heuristic:
    """Return the arms' time for the remaining folds among those wanted (bit mask; -1: all), constraints ignored.

    A blue fold takes three motions (to the grips, the apex, the end), a red fold two (the apex, the end); the first is
    saved while the grips of a drag are held. The bound is consistent: a fold lowers it by at most the arms' share of
    the fold's cost, holding on after a drag by the one motion that the drag costs at least, and nothing else lowers it.
    """
    motion = context.scene.arm_motion_s
    motions = [2 if fold.is_red else 3 for fold in context.sequence.folds]

    @cache
    def left_s(done: int, saved: int) -> float:
        return motion * max(sum(m for i, m in enumerate(motions) if wanted & ~done & 1 << i) - saved, 0)

    def remaining(state: State) -> float:
        return left_s(state.done, 1 if state.dragged > 0 else 0)

    return remaining


def zero(_: Context) -> Heuristic:
    """Return no bound at all: A* becomes Dijkstra's search."""
    return lambda _state: 0.0


HEURISTICS: dict[HeuristicName, Callable[[Context], Heuristic]] = {"arm_time": arm_time, "zero": zero}
"""The heuristics by the names that requests use."""
