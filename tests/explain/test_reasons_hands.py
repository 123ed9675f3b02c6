"""Hands that do not suffice: each code provoked, its numbers worked out by hand, and fixed by its change."""

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest

from planner import Scene, make_plan
from planner.cloth.garment import DrawnFold, Garment
from planner.errors import FoldError
from planner.explain.reason_grips import needed_radius
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.task.reason import Code
from tests.builders import fold, garment, rectangle_points
from tests.planning.provoked import BACK, FRONT, HOUSE, fixed, is_gone, planned_with, refused
from tests.required import required

SLOPE_M = math.hypot(0.2, 0.1)


NEARBY = Scene(stations=FRONT, back_off_max_m=0.2)
"""A scene with few places to stand, so that the search is soon exhausted."""


def house(radius_m: float, *more: DrawnFold) -> Garment:
    """Return the house with its tip towards the robot, its roof to be folded up."""
    roof = fold((0.4, 0.0), (0.0, 0.0), name="roof", radius_m=radius_m)
    return garment(HOUSE, roof, *more, placement=Pose2(-0.42, 0.2, BACK))


def test_three_corners_need_a_hand_too_many_until_one_holds_two_of_them() -> None:
    # Both eaves and the tip must be held. A hand in the middle of a slope is half of it from its two ends.
    answer = refused(house(0.08), fixed())
    (reason,) = answer.reasons
    assert (reason.fold, reason.code) == (0, Code.TOO_MANY_GRIPS)
    assert reason.needed_grip_radius_m == pytest.approx(SLOPE_M / 2)
    assert reason.short_by_m == pytest.approx(SLOPE_M / 2 - 0.08)
    assert "3 points of its edge must be held" in reason.message
    assert "within 0.08 m of it; a grip radius of 0.112 m would do" in reason.message
    needed_m = required(reason.needed_grip_radius_m)
    assert is_gone(reason, make_plan(house(needed_m), fixed(), time_limit_s=60.0))
    too_small = refused(house(needed_m - 0.001), fixed())
    assert [r.code for r in too_small.reasons] == [Code.TOO_MANY_GRIPS]


def test_two_grips_too_close_need_a_radius_of_half_their_distance() -> None:
    def ribbon(radius_m: float) -> Garment:
        line = fold((0.08, 0.15), (0.0, 0.15), radius_m=radius_m)
        return garment(rectangle_points(0.08, 0.3), line, placement=Pose2(-0.7, 0.04, BACK))

    # Two hands need 0.10 m, and the corners of the end are 0.08 m apart.
    reason, reach = refused(ribbon(0.03), fixed()).reasons
    assert reason.code == Code.GRIPS_TOO_CLOSE
    # One hand in the middle of the ribbon is a little too far before the robot's body.
    assert (reach.code, reach.set) == (Code.OUT_OF_REACH, reason.set)
    assert planned_with(required(reason.change), ribbon(0.03), fixed()).is_solved
    assert reason.short_by_m == pytest.approx(0.02)
    assert reason.needed_grip_radius_m == pytest.approx(0.04)
    assert "0.080 m apart, and two hands need 0.10 m; with a grip radius of 0.040 m, now 0.03 m" in reason.message
    assert is_gone(reason, make_plan(ribbon(0.04), fixed(), time_limit_s=60.0))
    assert [r.code for r in refused(ribbon(0.039), fixed()).reasons][:1] == [Code.GRIPS_TOO_CLOSE]


def test_a_red_fold_whose_corner_no_hand_holds_any_more_needs_a_wider_grip() -> None:
    # The roof, folded up, is held at an eave and in the middle of the other slope. The red fold takes its tip, which is
    # half a slope from the hand there; the hand at the eave is not on the part that moves.
    def tipped(radius_m: float, tip: str = "red") -> Garment:
        return house(0.112, fold((0.04, 0.12), (0.36, 0.12), tip, name="tip", radius_m=radius_m))

    found = refused(tipped(0.08), NEARBY).reasons
    assert [(r.fold, r.code) for r in found] == [(1, Code.RED_NEEDS_HOLD)]
    (reason,) = found
    assert reason.needed_grip_radius_m == pytest.approx(SLOPE_M / 2)
    assert reason.short_by_m == pytest.approx(SLOPE_M / 2 - 0.08)
    assert "(0.20, 0.20) m of the garment must be held" in reason.message
    assert "0.11 m away and holds what is within 0.08 m; a grip radius of 0.112 m would do" in reason.message
    assert is_gone(reason, make_plan(tipped(required(reason.needed_grip_radius_m)), NEARBY, time_limit_s=60.0))


def test_a_red_fold_on_whose_part_no_hand_is_says_so() -> None:
    # Only the uppermost 2 cm of the tip: the hands at an eave and in the middle of a slope are all below.
    tip = fold((0.16, 0.18), (0.24, 0.18), "red", name="tip")
    (reason,) = refused(house(0.112, tip), NEARBY).reasons
    assert (reason.fold, reason.code, reason.needed_grip_radius_m) == (1, Code.RED_NEEDS_HOLD, None)
    assert (
        "no hand that still holds from fold 0 'roof' is on the part that moves; make it a blue fold" in reason.message
    )


def test_a_red_fold_that_would_tear_is_bad_input_that_says_how_much() -> None:
    # The right half comes over the left one. To fold its upper half down would pull 0.2 m of the crease along.
    side, up = fold((0.3, 0.0), (0.3, 0.4), name="side"), fold((0.3, 0.2), (0.0, 0.2), "red", name="down")
    cloth = garment(rectangle_points(0.6, 0.4), replace(side, start=side.end, end=side.start), up)
    with pytest.raises(FoldError, match=r"200\.0 mm along the crease of the fold before: it would tear") as caught:
        make_plan(cloth)
    assert caught.value.field == "folds[1].start"


def test_the_needed_radius_is_that_of_an_exhaustive_search() -> None:
    rng = np.random.default_rng(4)
    for _ in range(30):
        turns = np.sort(rng.uniform(0.1, math.pi - 0.1, rng.integers(3, 8)))
        corners = 0.3 * np.column_stack([np.cos(turns), np.sin(turns)])
        piece = Region.polygon([(0.4, 0.0), *((float(x), float(y)) for x, y in corners), (-0.4, 0.0)])
        vertices = np.array([p for p in piece.ring if p[1] > 1e-6])
        baseline = Segment((-0.4, 0.0), (0.4, 0.0))
        middles = [(a + b) / 2 for a, b in combinations(vertices, 2)]
        middles += [_centre(*three) for three in combinations(vertices, 3)]
        places = np.vstack([vertices, piece.nearest_boundary_points(np.array(middles))])
        places = places[places[:, 1] > 1e-5]
        gaps = np.hypot(*(places[:, None] - vertices[None]).transpose(2, 0, 1))
        pairs = np.minimum(gaps[:, None], gaps[None]).max(axis=2).min()
        assert needed_radius(piece, baseline, vertices, 2) == pytest.approx(pairs)
        assert needed_radius(piece, baseline, vertices, 1) == pytest.approx(gaps.max(axis=1).min())
        threes = min(np.minimum(pair, gaps).max(axis=1).min() for pair in _least_of_pairs(gaps))
        assert needed_radius(piece, baseline, vertices, 3) == pytest.approx(threes)


def _least_of_pairs(gaps: FloatArray) -> Iterator[FloatArray]:
    """For each two places the distance from every vertex to the nearer one."""
    return (np.minimum(a, b) for a, b in combinations(gaps, 2))


def _centre(a: FloatArray, b: FloatArray, c: FloatArray) -> FloatArray:
    """Return the centre of the smallest circle round three points."""
    for p, q, r in ((a, b, c), (b, c, a), (c, a, b)):
        if np.dot(p - r, q - r) <= 0.0:
            return (p + q) / 2
    (ax, ay), (bx, by) = a - c, b - c
    d = 2 * (ax * by - ay * bx)
    return np.asarray(
        c + np.array([by * (ax**2 + ay**2) - ay * (bx**2 + by**2), ax * (bx**2 + by**2) - bx * (ax**2 + ay**2)]) / d
    )
