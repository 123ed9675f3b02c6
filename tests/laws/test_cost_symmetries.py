"""What a plan costs does not depend on how the problem is written down: order, frame, left and right."""

import math
from dataclasses import replace
from itertools import islice
from random import Random

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.cloth.garment import DrawnFold, Garment
from planner.cloth.garment_files import load_garment
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.pose import Point2, Pose2
from planner.primitives.scene import Scene
from tests.laws.fold_orders import orders
from tests.laws.law import law
from tests.laws.scenes import FOLDABLE, Problem, problems

SECOND = 1e-6
MOST_ORDERS = 24


def is_same_cost(one_s: float, other_s: float) -> bool:
    return one_s == other_s or abs(one_s - other_s) <= SECOND


def snapped(garment: Garment) -> Garment:
    """The same garment, its lines drawn where they are snapped to."""
    folds = FoldSequence.of(garment).folds
    drawn = zip(garment.folds, folds, strict=True)
    return replace(garment, folds=tuple(replace(d, start=f.line.start, end=f.line.end) for d, f in drawn))


def reordered(problem: Problem, rng: Random) -> Problem:
    """The same folds, given in another order that the Fold-DAG allows."""
    garment = snapped(problem.garment)
    order = rng.choice(list(islice(orders(FoldSequence.of(garment).dag), MOST_ORDERS)))
    return replace(problem, garment=replace(garment, folds=tuple(garment.folds[i] for i in order)))


def redrawn(problem: Problem, turn_rad: float, by: Point2) -> Problem:
    """The same cloth at the same place, drawn elsewhere in the article frame and turned."""
    frame = Pose2(*by, turn_rad)

    def moved(point: Point2) -> Point2:
        x, y = frame.to_outer(np.array(point))
        return (float(x), float(y))

    origin = frame.to_inner(np.zeros(2))
    x, y = problem.garment.placement.to_outer(origin)
    placement = Pose2(float(x), float(y), problem.garment.placement.yaw_rad - turn_rad)
    garment = snapped(problem.garment)
    folds = tuple(replace(f, start=moved(f.start), end=moved(f.end)) for f in garment.folds)
    outline = tuple(moved(p) for p in garment.outline)
    return replace(problem, garment=replace(garment, outline=outline, folds=folds, placement=placement))


def mirrored(problem: Problem) -> Problem:
    """All of it as a mirror along the table's middle shows it: y -> -y on the table, x -> -x in the drawing.

    With the placement p -> R(yaw) p + t the mirror image of the cloth at yaw lies at pi - yaw:
    diag(1, -1) R(yaw) diag(-1, 1) = R(pi - yaw). What was to the left of a fold's line is to its right: the line turns
    round.
    """

    def over(pose: Pose2) -> Pose2:
        return Pose2(pose.x_m, -pose.y_m, -pose.yaw_rad)

    def turned(fold: DrawnFold) -> DrawnFold:
        return replace(fold, start=(-fold.end[0], fold.end[1]), end=(-fold.start[0], fold.start[1]))

    garment, placed = problem.garment, problem.garment.placement
    image = replace(
        garment,
        outline=tuple((-x, y) for x, y in garment.outline),
        folds=tuple(turned(f) for f in garment.folds),
        placement=Pose2(placed.x_m, -placed.y_m, math.pi - placed.yaw_rad),
    )
    stations = tuple((name, over(pose)) for name, pose in problem.scene.stations)
    return replace(problem, garment=image, scene=replace(problem.scene, stations=stations))


@given(problems(), st.randoms(use_true_random=False))
@law("planning", short=10, long=50)
def test_the_order_in_which_independent_folds_are_given_does_not_matter(problem: Problem, rng: Random):
    assert is_same_cost(problem.cost_s(), reordered(problem, rng).cost_s())


@given(problems(), st.floats(-math.pi, math.pi), st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0)))
@law("planning", short=10, long=50)
def test_where_and_how_the_cloth_is_drawn_does_not_matter(problem: Problem, turn_rad: float, by: Point2):
    assert is_same_cost(problem.cost_s(), redrawn(problem, turn_rad, by).cost_s())


@given(problems())
@law("planning", short=10, long=50)
def test_a_mirror_image_costs_the_same(problem: Problem):
    assert is_same_cost(problem.cost_s(), mirrored(problem).cost_s())


@pytest.mark.parametrize("name", FOLDABLE)
@pytest.mark.slow
def test_a_shipped_garment_costs_the_same_redrawn_mirrored_and_with_its_folds_in_another_order(name: str):
    problem = Problem(load_garment(name), Scene(), "front", 0.03)
    cost_s = problem.cost_s()
    for other in (reordered(problem, Random(name)), redrawn(problem, 1.0, (0.3, -0.2)), mirrored(problem)):
        assert is_same_cost(cost_s, other.cost_s())
