"""Folding a stack: the layers that move, those that stay, and their order."""

import random

import pytest

from planner.cloth.cloth_state import ClothState
from planner.cloth.fold_kinds import FOLD_KINDS
from planner.errors import FoldError
from planner.folds.fold_cloth import fold_cloth
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from tests.builders import fold, garment, is_same_region, rectangle, rectangle_points, star

TOWEL = ClothState.spread_out(rectangle(0.4, 0.3))


def refusal(cloth: ClothState, line: Segment, kind: str = "blue", crease: Segment | None = None) -> str:
    with pytest.raises(FoldError) as caught:
        fold_cloth(cloth, line, kind, crease)
    return caught.value.message


def test_the_left_part_is_laid_over_the_line_with_its_back_up() -> None:
    done = fold_cloth(TOWEL, Segment((0.1, 0.0), (0.1, 0.3)), "blue")
    assert is_same_region(done.moving, rectangle(0.1, 0.3))
    low, high = done.cloth.layers
    assert is_same_region(low.region, rectangle(0.3, 0.3, 0.1)) and low.face == "front"
    assert is_same_region(high.region, rectangle(0.1, 0.3, 0.1)) and high.face == "back"
    assert done.cloth.flap == (high,)


def test_the_layers_of_the_moving_part_lie_in_reversed_order_afterwards() -> None:
    # Halves, then quarters. Pattern quarters from left to right: a b c d. First d c over to the left (line x = 0.2,
    # right part moves): from the bottom a b | d c lie as a, d on the left and b, c on the right. Then the right
    # half over x = 0.1: b below c turn over, so that c comes below b: a, d, c, b.
    half = fold_cloth(TOWEL, Segment((0.2, 0.3), (0.2, 0.0)), "blue").cloth
    quarter = fold_cloth(half, Segment((0.1, 0.3), (0.1, 0.0)), "blue").cloth
    middles = [layer.to_pattern((0.05, 0.15))[0] for layer in quarter.layers]
    assert middles == pytest.approx([0.05, 0.35, 0.25, 0.15])
    assert [layer.face for layer in quarter.layers] == ["front", "back", "front", "back"]


def test_folding_a_flap_out_and_back_in_restores_the_places() -> None:
    line = Segment((0.1, 0.0), (0.1, 0.3))
    once = fold_cloth(TOWEL, line, "blue")
    back = [layer.reflected(line) for layer in once.cloth.flap]
    outline = Region.union([*(layer.region for layer in once.cloth.layers[:1]), *(layer.region for layer in back)])
    assert is_same_region(outline, rectangle(0.4, 0.3))
    assert len(outline.ring) == 4


def test_a_red_fold_moves_only_the_flap() -> None:
    crease, red = Segment((0.2, 0.0), (0.2, 0.3)), Segment((0.3, 0.3), (0.3, 0.0))
    half = fold_cloth(TOWEL, crease, "blue").cloth
    assert is_same_region(FOLD_KINDS["red"].silhouette(half), rectangle(0.2, 0.3, 0.2))
    done = fold_cloth(half, red, "red", crease=crease)
    low, stays, moved = done.cloth.layers
    assert is_same_region(low.region, rectangle(0.2, 0.3, 0.2)), "what lies below stays"
    assert is_same_region(stays.region, rectangle(0.1, 0.3, 0.2)) and stays.face == "back"
    # The flap's free edge was the towel's left edge, so its outer half was x < 0.1 of the pattern.
    assert is_same_region(moved.region, rectangle(0.1, 0.3, 0.2)) and moved.face == "front"
    assert moved.to_pattern((0.25, 0.1))[0] == pytest.approx(0.05)


def test_a_blue_fold_there_moves_every_layer() -> None:
    half = fold_cloth(TOWEL, Segment((0.2, 0.0), (0.2, 0.3)), "blue").cloth
    done = fold_cloth(half, Segment((0.3, 0.3), (0.3, 0.0)), "blue")
    assert done.cloth.moved == 2 and len(done.cloth.layers) == 4


def test_a_red_fold_that_would_pull_at_the_crease_is_refused_with_how_much_of_it() -> None:
    # The lower third of a flap: it moves 0.1 m of the crease x = 0.2, which is 0.1 m off its line at most.
    crease = Segment((0.2, 0.0), (0.2, 0.3))
    half = fold_cloth(TOWEL, crease, "blue").cloth
    message = refusal(half, Segment((0.4, 0.1), (0.2, 0.1)), "red", crease=crease)
    assert "reaches 100.0 mm along the crease" in message and "tear" in message


def test_a_red_fold_may_touch_the_crease_where_its_line_meets_it() -> None:
    crease = Segment((0.2, 0.0), (0.2, 0.3))
    half = fold_cloth(TOWEL, crease, "blue").cloth
    # From the crease's upper end to the flap's lower outer corner: a triangle of 0.2 x 0.3 / 2 turns up and in.
    done = fold_cloth(half, Segment((0.2, 0.3), (0.4, 0.0)), "red", crease=crease)
    assert done.moving.area == pytest.approx(0.03)
    assert done.cloth.area == pytest.approx(0.12)


def test_a_line_with_nothing_to_its_left_is_refused() -> None:
    assert "nothing would move" in refusal(TOWEL, Segment((0.4, 0.0), (0.0, 0.0)))


def test_a_line_with_everything_to_its_left_is_refused() -> None:
    assert "nothing would stay" in refusal(TOWEL, Segment((0.0, 0.0), (0.4, 0.0)))


def test_a_line_round_whose_end_the_cloth_hangs_together_is_refused() -> None:
    assert "cut the cloth completely" in refusal(TOWEL, Segment((0.1, 0.0), (0.1, 0.1)))


def chord(rng: random.Random, region: Region) -> Segment | None:
    """Return a segment from somewhere on the boundary to somewhere else on it, inside the region."""
    ring = region.shape.exterior if region.shape.geom_type == "Polygon" else None
    if ring is None:
        return None
    ends: list[Point2] = [ring.interpolate(rng.random(), normalized=True).coords[0] for _ in range(2)]
    line = Segment(*ends)
    return line if line.length > 0.05 and region.contains_segment(line) else None


def test_whatever_is_folded_no_cloth_is_lost_and_none_made() -> None:
    rng = random.Random(14)
    done = 0
    while done < 40:
        cloth = ClothState.spread_out(Region.polygon(star(rng, 7)))
        if not cloth.silhouette.shape.is_valid:
            continue
        for _ in range(3):
            line = chord(rng, cloth.silhouette)
            try:
                folded = fold_cloth(cloth, line, "blue") if line else None
            except FoldError:
                folded = None
            if line is not None and folded is not None:
                done += 1
                landed = folded.moving.moved(Isometry.reflection(line))
                staying = cloth.silhouette.difference(folded.moving)
                assert folded.cloth.area == pytest.approx(cloth.area, abs=6e-5)
                assert is_same_region(folded.cloth.silhouette, Region.union([staying, landed]), 1e-4)
                pieces = [layer.pattern_piece for layer in folded.cloth.layers]
                assert Region.union(pieces).area == pytest.approx(sum(p.area for p in pieces), abs=6e-5)
                cloth = folded.cloth


def test_folds_that_double_the_layers_too_often_are_refused() -> None:
    # A strip of 2^11 times 4 mm folded in half eleven times has 2048 layers.
    width = 8.192
    lines = [fold((width / 2**i, 0.0), (width / 2**i, 0.1)) for i in range(1, 12)]
    halvings = [fold(line.end, line.start) for line in lines]
    with pytest.raises(FoldError, match="2048 layers, more than 2000") as caught:
        FoldSequence.of(garment(rectangle_points(width, 0.1), *halvings))
    assert caught.value.field == "folds[10]"
