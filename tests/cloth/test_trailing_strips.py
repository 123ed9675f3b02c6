"""Strips of cloth behind a slit, which a drag leaves behind."""

import numpy as np
import pytest

from planner import load_garment
from planner.cloth.trailing_strips import are_lost, strip_tips
from planner.folds.fold_sequence import replayed
from planner.geometry.pose import Point2
from planner.geometry.region import Region

DEPTH, WIDE = 0.4, 0.1


def fork(depth_m: float) -> Region:
    """Return two prongs along y, 10 cm wide and 2 cm apart, joined at their upper ends."""
    top = depth_m + 0.1
    return Region.polygon(
        [(0, 0), (0.1, 0), (0.1, depth_m), (0.12, depth_m), (0.12, 0), (0.22, 0), (0.22, top), (0, top)]
    )


@pytest.mark.parametrize(
    ("up", "tip"), [((1.0, 0.0), (0.1, 0.0)), ((-1.0, 0.0), (0.12, 0.0)), ((0.0, 1.0), None), ((0.0, -1.0), None)]
)
def test_the_prong_behind_the_slit_stays_behind_and_none_does_along_the_slit(up: Point2, tip: Point2 | None) -> None:
    assert strip_tips(fork(DEPTH), up).tolist() == ([] if tip is None else [pytest.approx(tip)])


@pytest.mark.parametrize(("depth_m", "stays"), [(0.09, False), (0.11, True)])
def test_a_prong_no_longer_than_wide_follows(depth_m: float, *, stays: bool) -> None:
    assert bool(len(strip_tips(fork(depth_m), (1.0, 0.0)))) == stays


def test_each_of_several_prongs_behind_one_another_must_be_held() -> None:
    comb = fork(DEPTH).coordinates[:-1]
    three = Region.union([Region.polygon(comb), Region.polygon(comb + np.array([0.12, 0.0]))])
    assert sorted(strip_tips(three, (1.0, 0.0)).tolist()) == [pytest.approx((0.1, 0.0)), pytest.approx((0.22, 0.0))]


def test_a_drag_across_a_romper_holds_the_leg_behind() -> None:
    legs = [(0.0, 0.0), (0.12, 0.0), (0.16, 0.2), (0.2, 0.0), (0.32, 0.0), (0.34, 0.35), (0.3, 0.5), (0.02, 0.5)]
    assert strip_tips(Region.polygon([*legs, (-0.02, 0.35)]), (-1.0, 0.0)).tolist() == [pytest.approx((0.2, 0.0))]


def test_a_grip_across_the_slit_does_not_hold_a_strip() -> None:
    tips, vertices = np.array([(0.2, 0.0)]), np.array([(0.0, 0.0), (0.2, 0.0)])
    grips = np.array([(0.2, 0.0), (0.26, 0.0), (0.12, 0.0), (0.1, 0.0)])  # the others are across the slit
    assert are_lost(grips, vertices, tips, (-1.0, 0.0)).tolist() == [
        [False, lost] for lost in (False, False, True, True)
    ]


@pytest.mark.parametrize("turn", [(0.6, 0.8), (-0.6, -0.8)])
def test_cloth_without_slits_leaves_nothing_behind(turn: Point2) -> None:
    assert not len(strip_tips(Region.polygon([(0, 0), (0.5, 0), (0.5, 0.3), (0, 0.3)]), turn))


@pytest.mark.parametrize("up", [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)])
@pytest.mark.parametrize("name", ["t-shirt", "vest", "shirt", "skirt", "jeans"])
def test_of_the_shipped_garments_trouser_legs_and_the_straps_of_the_vest_stay_behind(name: str, up: Point2) -> None:
    stays = bool(len(strip_tips(replayed(load_garment(name)).cloth(0).silhouette, up)))
    assert stays == (name in ("jeans", "vest") and up[1] == 0.0)
