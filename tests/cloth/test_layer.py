"""Layers record where in the pattern they come from; stacks are layers from bottom to top."""

import random

import pytest

from planner.cloth.cloth_state import LAYERS_MAX, ClothState
from planner.cloth.layer import Layer
from planner.errors import FoldError
from planner.geometry.isometry import Isometry
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from tests.builders import is_same_region, rectangle, star


def test_folding_a_layer_twice_over_one_line_restores_it_and_its_face() -> None:
    rng = random.Random(13)
    for _ in range(40):
        region = Region.polygon(star(rng, 7))
        if not region.shape.is_valid:
            continue
        layer = Layer(region, Isometry.rotation(rng.uniform(-3, 3), 0.1, 0.2))
        line = Segment((rng.uniform(-1, 1), 0.0), (rng.uniform(-1, 1), 1.0))
        once, twice = layer.reflected(line), layer.reflected(line).reflected(line)
        assert once.face != layer.face and twice.face == layer.face
        assert is_same_region(twice.region, layer.region, 1e-6)


def test_every_point_of_a_layer_is_traced_to_the_pattern() -> None:
    # Folded over x = 0.3, the point that came to lie at (0.4, 0.1) was at (0.2, 0.1).
    layer = Layer(rectangle(0.3, 0.3), Isometry()).reflected(Segment((0.3, 0.0), (0.3, 1.0)))
    assert layer.to_pattern((0.4, 0.1)) == pytest.approx((0.2, 0.1))


def test_a_layer_is_as_large_as_its_piece_of_the_pattern_and_has_its_points_unrounded_wherever_it_lies() -> None:
    third = 1.0 / 3.0
    layer = Layer(rectangle(third, 0.3), Isometry()).reflected(Segment((0.0, 0.0), (0.0, 1.0)))
    assert layer.area == pytest.approx(0.1, rel=1e-12)
    # Mirrored over the y axis, and still counter-clockwise: from (0, 0.3) to (-1/3, 0.3), down, right, up.
    assert layer.ring.tolist() == [[0.0, 0.3], [-third, 0.3], [-third, 0.0], [0.0, 0.0]]


def test_a_layer_cut_in_two_keeps_its_cloth_and_its_isometry() -> None:
    over = Isometry.reflection(Segment((0.4, 0.0), (0.4, 1.0)))
    layer = Layer(rectangle(0.4, 0.3), over)
    inside, outside, slivers = layer.cut(Segment((0.5, 0.0), (0.5, 0.3)), rectangle(0.1, 0.3, 0.4))
    assert [p.region.area for p in inside] == pytest.approx([0.03])
    assert [p.region.area for p in outside] == pytest.approx([0.09])
    assert slivers == ()
    assert inside[0].isometry == outside[0].isometry == over
    assert is_same_region(inside[0].pattern_piece, rectangle(0.1, 0.3, 0.3))


def test_a_layer_outside_the_moving_part_stays_whole() -> None:
    layer = Layer(rectangle(0.4, 0.3), Isometry())
    assert layer.cut(Segment((1.0, 0.0), (1.0, 1.0)), rectangle(0.1, 0.1, 5.0)) == ((), (layer,), ())


def test_a_layer_as_json_is_a_ring_and_a_face() -> None:
    data = Layer(rectangle(0.4, 0.3), Isometry()).to_dict()
    assert data["face"] == "front"
    assert sorted(map(tuple, data["polygon"])) == [(0.0, 0.0), (0.0, 0.3), (0.4, 0.0), (0.4, 0.3)]


def test_cloth_spread_out_is_one_layer_with_its_front_up_and_nothing_moved() -> None:
    cloth = ClothState.spread_out(rectangle(0.4, 0.3))
    assert [layer.face for layer in cloth.layers] == ["front"]
    assert cloth.area == pytest.approx(0.12)
    assert cloth.flap == ()


def test_the_flap_is_what_moved_last() -> None:
    layers = [Layer(rectangle(0.1, 0.1, 0.2 * i), Isometry()) for i in range(4)]
    assert ClothState(layers, moved=2).flap == tuple(layers[2:])


def test_more_layers_than_anyone_folds_are_refused() -> None:
    layer = Layer(rectangle(0.1, 0.1), Isometry())
    ClothState([layer] * LAYERS_MAX)
    with pytest.raises(FoldError, match="2001 layers, more than 2000"):
        ClothState([layer] * (LAYERS_MAX + 1))
