"""Verdicts on cloth whose place is known."""

import numpy as np
import pytest

from app.rehearsal.judge import Gate, StepVerdict, judged
from app.rehearsal.planned_cloth import planned_positions
from app.rehearsal.world import Truth
from planner.folds.fold_sequence import replayed
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray
from planner.geometry.table import Table
from planner.geometry.woven_mesh import woven_mesh
from tests.app.rehearsal.towel import towel_plan

ROWS_M = 0.02


def verdict(shift: FloatArray, seed: int) -> StepVerdict:
    """Judge the folded towel as planned, but for a shift of each of its layers, shape (2, 3), m."""
    plan = towel_plan()
    sequence, state = replayed(plan.garment), plan.steps[-1].after
    pattern, triangles = woven_mesh(plan.garment.pattern, ROWS_M, seed)
    there = planned_positions(sequence, pattern, state.done, state.placement, Table(), 0.002)
    is_moved = pattern[:, 1] > 0.15
    truth = Truth(pattern, there + np.where(is_moved[:, None], shift[1], shift[0]), triangles)
    return judged(truth, 0, sequence, state, Isometry(), Table(), Gate(), ())


@pytest.mark.parametrize("seed", range(4))
def test_cloth_just_as_planned_overlaps_wholly_wherever_the_rows_of_its_mesh_lie(seed: int):
    found = verdict(np.zeros((2, 3)), seed)
    assert found.iou == pytest.approx(1.0, abs=1e-6)
    assert (found.outline_mm, found.mean_mm, found.slid_mm) == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)


def test_layers_four_centimetres_apart_are_seen_as_that_and_lost():
    # Apart along the towel's 40 cm, each layer is 2 cm off when what both have slid is taken off: 40 of 44 cm overlap.
    found = verdict(np.array([[0.0, 0.0, 0.0], [0.0, 0.04, 0.0]]), 0)
    assert found.mean_mm == pytest.approx(20.0, abs=1.0)
    assert found.iou == pytest.approx(40.0 / 44.0, abs=0.01)
    # One of them covers 4 x 15 cm alone, along 110 cm of outline: 5.5 mm.
    assert found.outline_mm == pytest.approx(60.0 / 11.0, abs=0.5)
    assert not found.held
