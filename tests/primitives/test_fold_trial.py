"""Grips and paths of a fold wherever drags have taken the cloth: those kept and moved equal those worked out there."""

import math
import random

import numpy as np

from planner.geometry.pose import Pose2
from planner.primitives.context import Context
from planner.primitives.fold_trial import fold_trials
from planner.primitives.state import State
from tests.builders import context, fold, garment, rectangle_points


def towel_at(x_m: float) -> Context:
    """Return a towel 0.3 m long whose near edge lies at x = `x_m`, to be folded away from the robot."""
    half = fold((0.4, 0.15), (0.0, 0.15))
    return context(garment(rectangle_points(0.4, 0.3), half, placement=Pose2(x_m, 0.2, -math.pi / 2)))


def test_paths_of_dragged_cloth_are_those_worked_out_where_it_lies() -> None:
    # The table's near edge is at x = -0.8: some of the places are beyond it, where tools go down at the edge.
    kept, rng = towel_at(-0.3), random.Random(1)
    beyond = 0
    for _ in range(60):
        moved_m = rng.uniform(-0.6, 0.4)
        there = State(0, (moved_m, 0.0), 0, 0)
        found, anew = fold_trials(kept, there, 0), fold_trials(towel_at(-0.3 + moved_m), State(0, (0.0, 0.0), 0, 0), 0)
        assert len(found) == len(anew) > 0
        for one, other in zip(found, anew, strict=True):
            assert (one.arms, one.cover) == (other.arms, other.cover)
            np.testing.assert_allclose(one.points, other.points, atol=1e-12)
            np.testing.assert_allclose(one.sweeps, other.sweeps, atol=1e-12)
            np.testing.assert_allclose(one.tools, other.tools, atol=1e-12)
            beyond += bool((one.tools[..., 2] < 0.0).any())
    assert 5 < beyond < 55, "both kinds are among them"


def test_a_path_that_leaves_the_table_on_its_way_alone_is_not_moved() -> None:
    # Both ends of the flap's way are over the table, as seen from the fold line, but it lands beyond the far edge.
    kept = towel_at(0.3)
    (trial, *_) = fold_trials(kept, State(0, (0.3, 0.0), 0, 0), 0)
    assert trial.tools[:, 0, 2].min() > 0.0 > trial.tools[:, -1, 2].min()
