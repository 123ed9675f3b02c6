from dataclasses import replace

import pytest

from planner.cloth.garment import DrawnFold, Garment
from planner.geometry.region import Region
from planner.proposals.packet import Packet
from tests.builders import rectangle_points

BLANKET = Garment.from_dict({"name": "blanket", "outline": rectangle_points(0.6, 0.4)})


def folded_at(*places: tuple[float, float]) -> Packet:
    """Return the blanket with its right part folded over at each x, between the ends of a line that goes up or down."""
    folds = (DrawnFold("side", "blue", (x, 0.4 if down else 0.0), (x, 0.0 if down else 0.4)) for x, down in places)
    return Packet.of(replace(BLANKET, folds=tuple(folds)))


def test_layers_are_counted_where_most_lie_on_one_another() -> None:
    assert folded_at().layers == 1
    assert folded_at((0.5, True)).layers == 2  # a strip of 0.1 m lies on the rest
    assert folded_at((0.5, True), (0.1, False)).layers == 2  # the strips lie side by side
    assert folded_at((0.4, True), (0.2, False)).layers == 3  # a third onto another
    assert folded_at((0.3, True), (0.15, True)).layers == 4  # half, and half again


def test_the_face_up_is_the_one_of_which_most_is_seen() -> None:
    assert folded_at().face == "front"
    assert folded_at((0.5, True)).face == "front"  # 0.1 m of the back, 0.4 m of the front
    assert folded_at((0.35, True)).face == "back"  # 0.25 m of the back, 0.1 m of the front


def test_the_size_is_along_the_axes() -> None:
    assert folded_at((0.5, True)).size_m == pytest.approx((0.5, 0.4))
    assert folded_at((0.5, True)).box_m2 == pytest.approx(0.2)


def test_folds_are_mirrored_on_each_axis_of_a_symmetric_outline_and_make_a_packet_of_the_same_shape() -> None:
    packet = folded_at((0.4, True), (0.2, False))
    across, along = packet.images(Region.polygon(BLANKET.outline))
    assert [(fold.start, fold.end) for fold in across] == [((0.2, 0.0), (0.2, 0.4)), ((0.4, 0.4), (0.4, 0.0))]
    assert [(fold.start, fold.end) for fold in along] == [((0.4, 0.4), (0.4, 0.0)), ((0.2, 0.0), (0.2, 0.4))]
    for folds in (across, along):
        assert Packet.of(replace(BLANKET, folds=folds)).shape == packet.shape
    wedge = Region.polygon([(0.0, 0.0), (0.6, 0.0), (0.5, 0.4), (0.0, 0.4)])
    assert not list(packet.images(wedge))


def test_a_mirrored_fold_is_named_by_the_side_that_it_moves() -> None:
    left = Packet.of(replace(BLANKET, folds=(DrawnFold("left half", "blue", (0.3, 0.0), (0.3, 0.4)),)))
    ((across,), (along,)) = left.images(Region.polygon(BLANKET.outline))
    assert (across.name, along.name) == ("right half", "left half")
