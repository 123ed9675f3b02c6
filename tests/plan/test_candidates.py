"""What is looked at before arms are led: whether they can be where a run begins, ends, and goes."""

import math
from dataclasses import replace

import numpy as np
import pytest

from app.drawing.garment_drawing import drawing_of
from app.drawing.solve import solve
from planner import Garment, Scene, load_garment, make_plan
from planner.plan.moments import moments_of
from tests.replay.checker import check
from tests.replay.planned import planned


@pytest.mark.parametrize("name", ["t-shirt", "tie", "letter-towel", "big-towel"])
def test_a_run_begins_and_ends_where_its_extremes_are(name: str):
    plan = planned(name).answer
    for act in (act for act in plan.acts if act.run is not None):
        whole = plan.problem.maker.candidate(act.steps).moments
        phases = [phase for step in act.steps for phase in step.extremes()]
        ends = moments_of(phases, plan.scene.table.height_m)
        for moment in (0, -1):
            np.testing.assert_allclose(ends.bases[moment], whole.bases[moment], atol=1e-9)
            np.testing.assert_allclose(ends.positions[:, moment], whole.positions[:, moment], atol=1e-9)
            np.testing.assert_allclose(ends.rotations[:, moment], whole.rotations[:, moment], atol=1e-9)


def test_what_was_made_real_is_a_candidate():
    plan = planned("t-shirt").answer
    runs = [act.steps for act in plan.acts if act.run is not None]
    assert [candidate.steps for candidate in plan.problem.maker.candidates(runs)] == runs


def test_hands_that_must_be_close_together_find_the_orientation_in_which_they_can():
    # Of the orientations in which the tie's second fold is in reach few keep the arms off the table and each other.
    cloth = pulled_tie(corner=0, by_m=0.03, towards_rad=3.4614)
    plan = make_plan(cloth, time_limit_s=60.0)
    assert plan.is_solved
    check(cloth.to_dict(), Scene().to_dict(), plan.to_dict())


def pulled_tie(corner: int, by_m: float, towards_rad: float) -> Garment:
    """A tie one of whose corners has been pulled, the folds along with it."""
    drawing = solve(drawing_of(load_garment("tie"))).drawing
    outline = list(drawing.outline)
    x, y = outline[corner].point
    there = (x + by_m * math.cos(towards_rad), y + by_m * math.sin(towards_rad))
    outline[corner] = replace(outline[corner], point=there)
    garment = solve(replace(drawing, outline=tuple(outline))).garment
    assert garment is not None
    return garment
