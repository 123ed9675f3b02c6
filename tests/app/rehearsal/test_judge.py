"""Verdicts on cloth whose place is known."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from app.rehearsal.judge import Gate, StepVerdict, judged
from app.rehearsal.planned_cloth import planned_positions
from app.rehearsal.world import Truth
from planner.folds.fold_sequence import replayed
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.table import Table
from planner.geometry.woven_mesh import woven_mesh
from tests.app.rehearsal.towel import towel_plan

ROWS_M = 0.02


def verdict(shift: FloatArray, seed: int) -> StepVerdict:
    """Judge the folded towel as planned, but for a shift of each of its layers, shape (2, 3), m."""
    return verdict_on(
        lambda pattern, there: there + np.where(pattern[:, 1:] > 0.15, shift[1], shift[0]),
        seed,
    )


def verdict_on(
    lies: Callable[[FloatArray, FloatArray], FloatArray], seed: int = 0, placement: Pose2 | None = None
) -> StepVerdict:
    """Judge the folded towel where it lies, told from its points in the pattern's frame and where they should be."""
    plan = towel_plan()
    sequence, state = replayed(plan.garment), plan.steps[-1].after
    state = replace(state, placement=placement or state.placement)
    pattern, triangles = woven_mesh(plan.garment.pattern, ROWS_M, seed)
    there = planned_positions(sequence, pattern, state.done, state.placement, Table(), 0.002)
    truth = Truth(pattern, lies(pattern, there), triangles)
    return judged(truth, 0, sequence, state, Isometry(), Table(), Gate(), ())


def doubled_back(width_m: float, height_m: float) -> StepVerdict:
    """Judge the folded towel with a flap at the free corner of its upper layer doubled back upon that layer."""
    plan = towel_plan()
    lies, begins = plan.steps[-1].after.placement, 0.4 - width_m

    def flap(pattern: FloatArray, there: FloatArray) -> FloatArray:
        is_back = (pattern[:, 0] > begins) & (pattern[:, 1] < height_m)
        back = np.column_stack([2.0 * begins - pattern[:, 0], 0.3 - pattern[:, 1]])
        moved = np.column_stack([lies.to_outer(back), there[:, 2] + 0.002])
        return np.where(is_back[:, None], moved, there)

    return verdict_on(flap)


@pytest.mark.parametrize("seed", range(4))
def test_cloth_just_as_planned_overlaps_wholly_wherever_the_rows_of_its_mesh_lie(seed: int) -> None:
    found = verdict(np.zeros((2, 3)), seed)
    assert found.iou == pytest.approx(1.0, abs=1e-6)
    assert (found.outline_mm, found.mean_mm, found.slid_mm) == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)


def test_layers_four_centimetres_apart_are_seen_as_that_and_lost() -> None:
    # Apart along the towel's 40 cm, each layer is 2 cm off when what both have slid is taken off: 40 of 44 cm overlap.
    found = verdict(np.array([[0.0, 0.0, 0.0], [0.0, 0.04, 0.0]]), 0)
    assert found.mean_mm == pytest.approx(20.0, abs=1.0)
    assert found.iou == pytest.approx(40.0 / 44.0, abs=0.01)
    # One of them covers 4 x 15 cm alone, along 110 cm of outline: 5.5 mm.
    assert found.outline_mm == pytest.approx(60.0 / 11.0, abs=0.5)
    assert not found.held


def test_a_flap_doubled_back_upon_the_stack_is_lost_though_all_but_five_in_a_hundred_points_are_in_place() -> None:
    # 5 x 8 cm of 1,200 cm2: the silhouette does not change, and 96.7 % of the points lie as planned.
    found, gate = doubled_back(0.05, 0.08), Gate()
    assert found.outline_mm < gate.outline_mm and found.mean_mm < gate.mean_mm and found.p95_mm < gate.p95_mm
    assert found.wrong_face_m2 == pytest.approx(0.004, rel=0.4)  # rows of the mesh are 2 cm apart
    assert not found.held


def test_a_corner_of_a_few_square_centimetres_that_is_doubled_back_still_holds() -> None:
    found = doubled_back(0.03, 0.03)
    assert 0.0 < found.wrong_face_m2 < Gate().wrong_face_m2
    assert found.held


def test_cloth_beside_a_crease_may_face_either_way() -> None:
    # What lies up to 2 cm from the fold line has not been turned over: the crease has rolled on by as much.
    lies = towel_plan().steps[-1].after.placement

    def unturned(pattern: FloatArray, there: FloatArray) -> FloatArray:
        flat = np.column_stack([lies.to_outer(pattern), np.full(len(pattern), 0.001)])
        return np.where((np.abs(pattern[:, 1:] - 0.14) < 0.01), flat, there)

    assert verdict_on(unturned).wrong_face_m2 == 0.0


def test_cloth_that_hangs_over_the_edge_as_planned_faces_as_it_should() -> None:
    hangs = replace(towel_plan().steps[-1].after.placement, x_m=-0.75)
    assert verdict_on(lambda _, there: there, placement=hangs).wrong_face_m2 == pytest.approx(0.0, abs=1e-9)
