"""The cost of a plan does not depend on how the problem is written down: order, frame, left and right."""

import math
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.cloth.garment_files import load_garment
from planner.geometry.pose import Point2
from planner.task.scene import Scene
from tests.laws.images import mirrored, redrawn, reordered
from tests.laws.law import law
from tests.laws.scenes import FOLDABLE, Problem, problems
from tests.sweep import sweep

SECOND = 1e-6


def is_same_cost(one_s: float, other_s: float) -> bool:
    return one_s == other_s or abs(one_s - other_s) <= SECOND


@given(problems(), st.randoms(use_true_random=False))
@law("planning", short=5, long=50)
def test_the_order_in_which_independent_folds_are_given_does_not_matter(problem: Problem, rng: Random) -> None:
    assert is_same_cost(problem.cost_s(), reordered(problem, rng).cost_s())


@given(problems(), st.floats(-math.pi, math.pi), st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0)))
@law("planning", short=5, long=50)
def test_where_and_how_the_cloth_is_drawn_does_not_matter(problem: Problem, turn_rad: float, by: Point2) -> None:
    assert is_same_cost(problem.cost_s(), redrawn(problem, turn_rad, by).cost_s())


@given(problems())
@law("planning", short=5, long=50)
def test_a_mirror_image_costs_the_same(problem: Problem) -> None:
    assert is_same_cost(problem.cost_s(), mirrored(problem).cost_s())


@sweep("name", FOLDABLE, ("vest", "hand-towel", "letter-towel"))
@pytest.mark.slow
def test_a_shipped_garment_costs_the_same_redrawn_mirrored_and_with_its_folds_in_another_order(name: str) -> None:
    problem = Problem(load_garment(name), Scene(), "front", 0.03)
    cost_s = problem.cost_s()
    for other in (reordered(problem, Random(name)), redrawn(problem, 1.0, (0.3, -0.2)), mirrored(problem)):
        assert is_same_cost(cost_s, other.cost_s())
