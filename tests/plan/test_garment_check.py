"""Whether all folds can be held by two grippers."""

import pytest

from planner.cloth.garment_files import load_garment, shipped_garment_names
from planner.plan.garment_check import check_garment
from tests.builders import fold, garment, rectangle_points


@pytest.mark.parametrize("name", shipped_garment_names())
def test_two_grippers_can_hold_every_fold_of_a_shipped_garment(name: str):
    checked = check_garment(load_garment(name))
    assert checked.is_holdable
    assert all(1 <= one.grips_needed <= 2 for one in checked.folds)


def test_a_fold_says_what_must_be_held_and_where():
    towel = garment(rectangle_points(0.4, 0.3), fold((0.0, 0.1), (0.4, 0.1)))
    (half,) = check_garment(towel).folds
    # Left of the line is the upper part: its two top corners.
    assert sorted(half.must_hold) == [(0.0, 0.3), (0.4, 0.3)]
    assert half.grips == ((0.0, 0.3), (0.4, 0.3)) and half.grips_needed == 2


def test_three_corners_far_apart_cannot_be_held_by_two_grippers():
    # A comb of three long teeth: each tip must be held, and they are 0.3 m apart.
    points = [(0, 0), (0.7, 0), (0.7, 0.5), (0.6, 0.5), (0.6, 0.2), (0.4, 0.2), (0.4, 0.6), (0.3, 0.6)]
    points += [(0.3, 0.2), (0.1, 0.2), (0.1, 0.5), (0, 0.5)]
    checked = check_garment(garment(points, fold((0.0, 0.1), (0.7, 0.1))))
    assert not checked.is_holdable
    assert checked.folds[0].grips_needed is None and checked.folds[0].grips == ()
