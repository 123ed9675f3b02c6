"""What the plan costs wherever the garment could be laid: a map of the table."""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from planner.cloth.garment import Garment
from planner.geometry.pose import Pose2
from planner.plan.budget import Budget
from planner.plan.make_plan import TIME_LIMIT_S, compile_kernels
from planner.plan.problem import require_between
from planner.plan.suggestion_budget import TrialBudget
from planner.plan.suggestion_grid import Room
from planner.plan.suggestion_trial import Asked
from planner.task.scene import Scene

STEP_M = (0.02, 1.0)
"""The finest and the coarsest map (m)."""

_FIRST_TRY_S, _MORE = 1.0, 4.0
"""The work of a first try at a place (s, see `Budget`), and how many times as much the next may take."""


@dataclass(frozen=True, slots=True)
class Cell:
    """A placement and its cost.

    Attributes:
        placement: the article frame in the table frame.
        cost_s: what the plan costs (s); None: there is none.
    """

    placement: Pose2
    cost_s: float | None

    def to_dict(self) -> dict[str, float | None]:
        """The cell as JSON."""
        return {"x_m": self.placement.x_m, "y_m": self.placement.y_m, "cost_s": self.cost_s}


@dataclass(frozen=True, slots=True)
class PlacementMap:
    """A grid of placements, all with one heading, the garment wholly on the table.

    Attributes:
        step_m: the distance of neighbours (m).
        cells: the placements whose answer is known, by x, then y.
        is_complete: whether these are all.
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
        """The map as JSON."""
        best = self.best
        return {
            "step_m": self.step_m,
            "cells": [cell.to_dict() for cell in self.cells],
            "best": None if best is None else {**best.to_dict(), "yaw_rad": best.placement.yaw_rad},
            "complete": self.is_complete,
        }


def placement_map(
    garment: Garment,
    scene: Scene | None = None,
    *,
    placement: Pose2 | None = None,
    start_station: str = "front",
    robot: str = "pr2",
    comfort_radius_m: float = 0.03,
    heuristic: str = "arm_time",
    time_limit_s: float = 10.0,
    work_limit_s: float | None = None,
    max_expanded: int = 100_000,
    should_stop: Callable[[], bool] | None = None,
    step_m: float = 0.1,
) -> PlacementMap:
    """Plan a garment at every place of a grid; work left over is given to places that need more.

    Args:
        garment: as for `make_plan`.
        scene: likewise.
        placement: likewise; the grid goes through it, and all placements have its heading.
        start_station: as for `make_plan`.
        robot: likewise.
        comfort_radius_m: likewise.
        heuristic: likewise.
        time_limit_s: the budget of the whole map (s, 0.01..60).
        work_limit_s: its budget in work; None for as much as the time limit. Where it ends the map, and not the time,
            the same request has the same map on every machine.
        max_expanded: the budget of each plan in states.
        should_stop: asked while planning; true ends the map where it is.
        step_m: the distance of neighbours (m, 0.02..1).

    Raises:
        FoldError: a fold is not legal on the cloth as it is then.
        RequestError: an option is out of range.
    """
    require_between("step_m", step_m, *STEP_M)
    require_between("time_limit_s", time_limit_s, *TIME_LIMIT_S)
    compile_kernels()
    budget = TrialBudget(Budget.of(work_limit_s, time_limit_s, should_stop))
    here = placement or garment.placement
    scene = scene or Scene()
    asked = Asked(garment, scene, here, start_station, robot, comfort_radius_m, heuristic, max_expanded)
    moves = Room.of(garment, here, scene.table).moves(step_m)
    poses = [here.moved(i * step_m, j * step_m) for i, j in sorted(moves, key=_coarse_first)]
    cells = _planned(asked, poses, budget)
    cells.sort(key=lambda cell: (cell.placement.x_m, cell.placement.y_m))
    return PlacementMap(step_m, tuple(cells), len(cells) == len(poses))


def _coarse_first(move: tuple[int, int]) -> tuple[int, int, int]:
    """Every other place along both axes first, so that a map cut short still shows the whole table."""
    i, j = move
    return (i % 2 + j % 2, i, j)


def _planned(asked: Asked, poses: list[Pose2], budget: TrialBudget) -> list[Cell]:
    """The cells known when the work is done; what needs more than a first try waits for the others."""
    waiting = deque((pose, _FIRST_TRY_S) for pose in poses)
    cells = []
    while waiting and not budget.has_spent(1.0):
        pose, try_s = waiting.popleft()
        plan = budget.plan(replace(asked, placement=pose), try_s)
        if plan.status != "budget_exceeded":
            cells.append(Cell(pose, plan.cost_s))
        else:
            waiting.append((pose, _MORE * try_s))
    return cells
