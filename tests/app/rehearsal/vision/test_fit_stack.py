import math

import numpy as np
import pytest

from app.rehearsal.vision.fit_stack import fit_stack
from app.rehearsal.vision.outline_edges import OutlineEdges
from planner import load_garment
from planner.cloth.cloth_state import ClothState
from planner.folds.fold_sequence import replayed
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.region import Region
from tests.app.rehearsal.vision.outlines_seen import behind_an_arm, most_off, seen

SQUARE = Region.polygon([(0.0, 0.0), (0.5, 0.0), (0.5, 0.5), (0.0, 0.5)])


def test_distances_from_a_square_are_known_by_hand() -> None:
    points = np.array([(0.25, 0.6), (0.25, 0.4), (-0.3, -0.4), (0.5, 0.2)])
    distances, outwards = OutlineEdges.of(SQUARE).distances(points)
    assert distances == pytest.approx([0.1, -0.1, 0.5, 0.0])
    assert outwards == pytest.approx(np.array([(0, 1), (0, 1), (-0.6, -0.8), (1, 0)]))


@pytest.mark.parametrize(("name", "folds"), [("t-shirt", 1), ("jeans", 0), ("tie", 0), ("tie", 1), ("vest", 1)])
def test_a_stack_is_found_where_it_lies_though_an_arm_hides_some_of_it(name: str, folds: int) -> None:
    stack = replayed(load_garment(name)).cloth((1 << folds) - 1)
    placement = Pose2(0.21, -0.13, 2.4 - folds)
    fit = fit_stack(behind_an_arm(seen(stack.silhouette, placement, folds)), stack)
    assert fit.is_known
    assert most_off(stack.silhouette, fit.placement, placement) < 0.01


@pytest.mark.long
def test_the_error_told_covers_what_is_off_in_most_cases() -> None:
    stack = ClothState.spread_out(load_garment("jeans").pattern)
    placement = Pose2(-0.3, 0.2, 0.5)
    fits = [fit_stack(seen(stack.silhouette, placement, seed, 0.004), stack, placement) for seed in range(12)]
    covered = [most_off(stack.silhouette, fit.placement, placement) <= fit.error_m for fit in fits]
    assert sum(covered) >= 11


def test_a_towel_turned_by_half_looks_the_same_unless_it_is_known_where_it_ought_to_lie() -> None:
    stack = ClothState.spread_out(load_garment("hand-towel").pattern)
    placement = Pose2(0.1, 0.1, 0.7)
    points = seen(stack.silhouette, placement)
    blind = fit_stack(points, stack)
    assert blind.unknown is not None and blind.unknown.code == "looks_alike"
    turned = [abs(math.remainder(other.yaw_rad - blind.placement.yaw_rad, math.tau)) for other in blind.others]
    assert turned == pytest.approx([math.pi], abs=0.02)
    told = fit_stack(points, stack, Pose2(0.12, 0.07, 0.8))
    assert told.is_known
    assert most_off(stack.silhouette, told.placement, placement) < 0.005


def test_a_square_may_lie_in_four_ways() -> None:
    stack = ClothState.spread_out(SQUARE)
    fit = fit_stack(seen(SQUARE, Pose2(0.0, 0.0, 0.3)), stack)
    assert len(fit.others) == 3


def test_a_garment_of_another_shape_is_not_taken_for_this_one() -> None:
    points = seen(load_garment("jeans").pattern, Pose2(0.0, 0.0, 1.0))
    fit = fit_stack(points, ClothState.spread_out(load_garment("t-shirt").pattern))
    assert fit.unknown is not None and fit.unknown.code == "seen_does_not_fit"


def test_a_third_of_an_outline_is_too_little() -> None:
    stack = ClothState.spread_out(load_garment("t-shirt").pattern)
    fit = fit_stack(seen(stack.silhouette, Pose2(0.0, 0.0, 1.0))[:200], stack, Pose2(0.0, 0.0, 1.0))
    assert fit.unknown is not None and fit.unknown.code == "too_little_seen"


@pytest.mark.parametrize("points", [np.zeros((7, 2)), np.full((20, 2), np.nan)])
def test_points_of_no_use_are_refused(points: FloatArray) -> None:
    with pytest.raises(ValueError, match="8 finite points"):
        fit_stack(points, ClothState.spread_out(SQUARE))
