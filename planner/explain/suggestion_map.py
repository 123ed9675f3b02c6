"""Map the cost of the plan over all places on the table where the garment can lie."""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from planner.deadline import ShouldStop
from planner.errors import RequestError
from planner.explain.room import Room
from planner.explain.suggestion import TrialBudget
from planner.geometry.pose import Pose2
from planner.planning.budget import Budget
from planner.planning.warm_up import compile_kernels
from planner.task.task import Task

STEP_M = (0.02, 1.0)
"""The finest and the coarsest map (m)."""

_FIRST_TRY_S, _MORE = 1.0, 4.0
"""The work of a first try at a place (s, see `Budget`), and the factor to the work of the next try."""


@dataclass(frozen=True, slots=True)
class Cell:
    """A placement and its cost.

    Attributes:
        placement: the garment frame in the table frame.
        cost_s: the cost of the plan (s); None if there is none.
    """

    placement: Pose2
    cost_s: float | None

    def to_dict(self) -> dict[str, float | None]:
        """Return the cell as JSON."""
        return {"x_m": self.placement.x_m, "y_m": self.placement.y_m, "cost_s": self.cost_s}


@dataclass(frozen=True, slots=True)
class PlacementMap:
    """A grid of placements with one heading, the garment wholly on the table.

    Attributes:
        step_m: the distance of neighbours (m).
        cells: the placements whose answer is known, by x, then y.
        is_complete: whether all placements of the grid are known.
    """

    step_m: float
    cells: tuple[Cell, ...]
    is_complete: bool

    @property
    def best(self) -> Cell | None:
        """The cheapest cell."""
        solved = [(cell.cost_s, number) for number, cell in enumerate(self.cells) if cell.cost_s is not None]
        return self.cells[min(solved)[1]] if solved else None

    def to_dict(self) -> dict[str, Any]:
        """Return the map as JSON."""
        best = self.best
        return {
            "step_m": self.step_m,
            "cells": [cell.to_dict() for cell in self.cells],
            "best": None if best is None else {**best.to_dict(), "yaw_rad": best.placement.yaw_rad},
            "complete": self.is_complete,
        }


def placement_map(
    task: Task,
    *,
    step_m: float = 0.1,
    should_stop: ShouldStop | None = None,
    on_place: Callable[[int, int], None] | None = None,
) -> PlacementMap:
    """Plan a garment at every place of a grid; work left over is given to places that need more.

    Args:
        task: the task; the grid goes through its placement, and all placements have its heading. Its limits of time and
            work are the budget of the whole map, its limit in states that of each plan.
        step_m: the distance of neighbours (m, 0.02..1).
        should_stop: polled while planning; the map ends with what is known when it returns true.
        on_place: called after each try with the number of places known, and the number of all.

    Raises:
        FoldError: a fold is not legal on the cloth as the folds before it leave it.
        RequestError: an option is out of range.
    """
    if not STEP_M[0] <= step_m <= STEP_M[1]:
        raise RequestError("step_m", f"{step_m} is not between {STEP_M[0]:g} and {STEP_M[1]:g}")
    compile_kernels(task.robot)
    budget = TrialBudget(Budget.of(task.limits.work_limit_s, task.limits.time_limit_s, should_stop))
    here = task.start.placement
    moves = Room.of(task.garment, here, task.scene.table).moves(step_m)
    poses = [here.moved(i * step_m, j * step_m) for i, j in sorted(moves, key=_coarse_first)]
    cells = _planned(task, poses, budget, on_place or (lambda _, __: None))
    cells.sort(key=lambda cell: (cell.placement.x_m, cell.placement.y_m))
    return PlacementMap(step_m, tuple(cells), len(cells) == len(poses))


def _coarse_first(move: tuple[int, int]) -> tuple[int, int, int]:
    """Return a sort key for coarse places first, so that a map cut short still shows the whole table."""
    i, j = move
    return (i % 2 + j % 2, i, j)


def _planned(task: Task, poses: list[Pose2], budget: TrialBudget, on_place: Callable[[int, int], None]) -> list[Cell]:
    """Return the cells known when the work is done; places that need more than a first try wait for the others."""
    waiting = deque((pose, _FIRST_TRY_S) for pose in poses)
    cells = []
    while waiting and not budget.has_spent(1.0):
        pose, try_s = waiting.popleft()
        plan = budget.plan(task.at(pose), try_s)
        if plan.status != "budget_exceeded":
            cells.append(Cell(pose, plan.cost_s))
        else:
            waiting.append((pose, _MORE * try_s))
        on_place(len(cells), len(poses))
    return cells
