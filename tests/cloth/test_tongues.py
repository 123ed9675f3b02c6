"""Tongues of cloth behind a slit, which a drag leaves behind."""

import pytest

from planner import load_garment
from planner.cloth.trailing_strips import strip_left_behind
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
def test_the_prong_behind_the_slit_stays_behind_and_none_does_along_the_slit(up: Point2, tip: Point2 | None):
    assert strip_left_behind(fork(DEPTH), up) == (None if tip is None else pytest.approx(tip))


@pytest.mark.parametrize(("depth_m", "stays"), [(0.19, False), (0.21, True)])
def test_a_prong_up_to_twice_as_long_as_wide_follows(depth_m: float, *, stays: bool):
    assert (strip_left_behind(fork(depth_m), (1.0, 0.0)) is not None) == stays


@pytest.mark.parametrize("turn", [(0.6, 0.8), (-0.6, -0.8)])
def test_cloth_without_slits_leaves_nothing_behind(turn: Point2):
    assert strip_left_behind(Region.polygon([(0, 0), (0.5, 0), (0.5, 0.3), (0, 0.3)]), turn) is None


@pytest.mark.parametrize("up", [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)])
@pytest.mark.parametrize("name", ["t-shirt", "vest", "shirt", "skirt", "jeans"])
def test_of_the_shipped_articles_only_the_jeans_have_a_leg_that_stays_behind(name: str, up: Point2):
    stays = strip_left_behind(replayed(load_garment(name)).cloth(0).silhouette, up) is not None
    assert stays == (name == "jeans" and up[1] == 0.0)
