"""Hands that lay cloth down over the table's edge as far beyond it as it should hang."""

from dataclasses import replace

import numpy as np
import pytest

from app.rehearsal.corrections import laid_over, over_edge
from app.rehearsal.step_seen import StepSeen
from app.rehearsal.world import GripMotion, StepMotion
from planner.folds.fold_path import REST_HEIGHT_M, FoldPath
from planner.geometry.segment import Segment
from planner.geometry.table import Table, TableTop
from planner.task.scene import Scene
from tests.app.rehearsal.towel import towel_plan

TOP, CLEAR_M = TableTop.of(Table()), 0.03
EDGE_M = TOP.low[0]


@pytest.mark.parametrize(
    ("beyond_m", "out_m", "below_m"),
    [(-0.1, -0.1, 0.0), (0.0, 0.0, 0.0), (0.02, 0.02, 0.0), (0.03, 0.03, 0.0), (0.05, 0.03, 0.04)],
)
def test_a_hand_ends_as_far_from_the_edge_as_its_cloth_is_to_hang(
    beyond_m: float, out_m: float, below_m: float
) -> None:
    ends = laid_over(np.array([EDGE_M - beyond_m, 0.1]), TOP, CLEAR_M)
    assert ends == pytest.approx([EDGE_M - out_m, 0.1, REST_HEIGHT_M - below_m])


def fold_over_edge(beyond_m: float, *, opens: bool = True) -> GripMotion:
    """Return the path of a plan's hand that lays the edge of cloth down over the table's, 20 cm from the line."""
    line_x = EDGE_M + 0.2 - beyond_m
    path = FoldPath(Segment((line_x, 1.0), (line_x, -1.0)), 0.2, TOP, TOP, CLEAR_M)
    (points,) = path.tool_paths(np.array([[line_x + 0.2, 0.0]]), np.linspace(0.0, 2.0, 41))
    times_s = tuple(np.linspace(0.0, 3.0, 41).tolist())
    return GripMotion("left", times_s, tuple((x, y, z) for x, y, z in points.tolist()), opens=opens)


def seen(planned: StepMotion) -> StepSeen:
    found = StepSeen(
        replace(towel_plan(), task=replace(towel_plan().task, scene=Scene())), towel_plan().steps[0], planned
    )
    found.__dict__["planned"] = planned
    return found


def fold(grip: GripMotion, kind: str = "fold") -> StepMotion:
    return StepMotion(0, kind, 3.0, (grip,))


def test_a_hand_that_follows_cloth_inwards_over_the_edge_ends_less_low() -> None:
    planned = fold(fold_over_edge(0.05))
    there = np.array(planned.grips[0].points)
    assert there[-1] == pytest.approx([EDGE_M - CLEAR_M, 0.0, REST_HEIGHT_M - 0.05])
    carried = fold(planned.grips[0].along(there + np.array([0.04, 0.01, 0.0])))
    made = np.array(over_edge(carried, seen(planned)).grips[0].points)
    assert made[-1] == pytest.approx([EDGE_M - 0.01, 0.01, REST_HEIGHT_M])
    assert made[:20] == pytest.approx(np.array(carried.grips[0].points)[:20])


def test_hands_that_hold_on_or_drag_or_lay_down_on_the_table_keep_their_paths() -> None:
    for motion in (
        fold(fold_over_edge(0.05, opens=False)),
        fold(fold_over_edge(0.05), "drag"),
        fold(fold_over_edge(-0.05)),
    ):
        assert over_edge(motion, seen(motion)) == motion
