"""Garments whose outlines were traced are planned as if they were drawn."""

import random

import numpy as np
import pytest

from planner import make_plan
from planner.geometry.pose import FloatArray
from tests.builders import fold, garment, noisy

CORNERS = np.array([(0.0, 0.0), (0.5, 0.0), (0.5, 0.4), (0.0, 0.4)])
FOLDS = (fold((0.5, 0.2), (0.0, 0.2)), fold((0.25, 0.2), (0.25, 0.4)))


def cost_s(outline: FloatArray) -> float:
    plan = make_plan(garment([(float(x), float(y)) for x, y in outline], *FOLDS))
    assert plan.is_solved, plan.reasons
    return plan.cost_s or 0.0


def zigzag(count: int) -> FloatArray:
    """Return the cloth with edges that zigzag by .4 mm between `count` points."""
    ring = noisy(CORNERS, count, 0.0, random.Random(0))
    sides = [np.isclose(ring[:, axis], value) for axis, value in ((0, 0.0), (0, 0.5), (1, 0.0), (1, 0.4))]
    is_corner = np.sum(sides, axis=0) == 2
    outward = np.sign(ring - CORNERS.mean(axis=0)) * np.column_stack([sides[0] | sides[1], sides[2] | sides[3]])
    beside = np.where(is_corner, 0.0, 0.0004 * (-1.0) ** np.arange(len(ring)))
    return np.asarray(ring + beside[:, None] * outward)


@pytest.mark.parametrize("count", [100, 200, 400])
def test_edges_that_zigzag_cost_nothing(count: int) -> None:
    assert cost_s(zigzag(count)) == pytest.approx(cost_s(CORNERS), abs=0.05)


@pytest.mark.parametrize(("count", "seed"), [(60, 0), (200, 1), (400, 2)])
def test_an_outline_traced_to_a_millimetre_is_folded_as_quickly_as_the_drawn_one(count: int, seed: int) -> None:
    traced = noisy(CORNERS, count, 0.001, random.Random(seed))
    assert cost_s(traced) == pytest.approx(cost_s(CORNERS), abs=0.1)


@pytest.mark.parametrize("askew_m", [-0.0004, 0.0004, 0.002])
def test_corners_a_little_askew_are_taken_as_square_ones(askew_m: float) -> None:
    askew = CORNERS + np.array([(0.0, 0.0), (0.0, askew_m), (0.0, 0.0), (0.0, -askew_m)])
    assert cost_s(askew) == pytest.approx(cost_s(CORNERS), abs=0.05)
