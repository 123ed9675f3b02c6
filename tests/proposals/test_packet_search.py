from collections.abc import Iterator
from dataclasses import replace
from itertools import islice

import pytest

from planner import load_garment
from planner.cloth.garment import DrawnFold, Garment
from planner.folds.fold_sequence import FoldSequence
from planner.proposals.packet import Packet
from planner.proposals.packet_search import PacketSearch
from planner.proposals.target import Target, is_fitting
from tests.builders import rectangle_points

BLANKET = Garment.from_dict({"name": "blanket", "outline": rectangle_points(0.6, 0.4)})


def packets(garment: Garment, to: str, *, max_folds: int = 8, face: str = "any") -> Iterator[Packet]:
    return PacketSearch(garment, Target.of(to), max_folds, face).packets()


def first_ways(name: str, count: int = 3) -> list[Packet]:
    ways: dict[object, Packet] = {}
    for packet in packets(replace(load_garment(name), folds=()), "shelf"):
        ways.setdefault(packet.way, packet)
        if len(ways) == count:
            break
    return list(ways.values())


def test_a_rectangle_comes_to_its_target_by_thirds_and_a_half() -> None:
    # 0.6 x 0.4 m to 0.2 x 0.2 m: a third of one side, half of the other; 3 x 2 layers, the whole square covered.
    first = next(packets(BLANKET, "20x20cm"))
    assert first.size_m == pytest.approx((0.2, 0.2), abs=1e-5)
    assert sorted(first.moves) == [("half", 1), ("thirds", 0)]
    assert (len(first.folds), first.layers) == (3, 6)
    assert first.cloth.area == pytest.approx(0.24)


def test_every_packet_fits_and_its_folds_are_legal() -> None:
    found = list(islice(packets(replace(load_garment("t-shirt"), folds=()), "shelf"), 12))
    assert len(found) == 12
    for packet in found:
        assert is_fitting(packet.size_m, (0.25, 0.30))
        garment = replace(load_garment("t-shirt"), folds=packet.folds)
        x0, y0, x1, y1 = FoldSequence.of(garment).final.silhouette.bounds
        assert (x1 - x0, y1 - y0) == pytest.approx(packet.size_m, abs=1e-5)


@pytest.mark.parametrize(
    ("name", "way"),
    [
        ("t-shirt", [("half", 1), ("thirds", 0)]),  # sides in, bottom up
        ("shirt", [("flaps", 0), ("half", 1)]),  # sleeves in, bottom up
        ("vest", [("half", 0), ("half", 1)]),
        ("jeans", [("half", 0), ("thirds", 1)]),  # leg on leg, then thirds
        ("skirt", [("half", 0), ("thirds", 1)]),
        ("hand-towel", [("half", 1), ("thirds", 0)]),
        ("big-towel", [("half", 1), ("thirds", 0), ("thirds", 1)]),
        ("scarf", [("half", 1), ("thirds", 1)]),
        ("tie", [("half", 1), ("thirds", 1)]),
    ],
)
def test_the_way_that_people_fold_a_garment_is_among_the_first_three(name: str, way: list[tuple[str, int]]) -> None:
    first = first_ways(name, 2 if name == "big-towel" else 3)
    assert tuple(way) in [packet.way for packet in first]


def test_folds_that_stand_are_kept_as_the_beginning() -> None:
    half = DrawnFold("half", "blue", (0.3, 0.0), (0.3, 0.4))
    first = next(packets(replace(BLANKET, folds=(half,)), "15x20cm"))
    assert first.folds[0] == half
    assert first.size_m == pytest.approx((0.15, 0.2), abs=1e-5)
    assert first.layers == 8


def test_a_garment_that_fits_needs_no_fold() -> None:
    (only,) = packets(BLANKET, "40x60cm")
    assert only.folds == ()


def test_no_packet_has_more_folds_than_asked_for() -> None:
    assert not list(packets(BLANKET, "20x20cm", max_folds=2))
    three = list(packets(BLANKET, "20x20cm", max_folds=3))
    assert three
    assert all(len(packet.folds) <= 3 for packet in three)


def test_a_target_that_nothing_fits_has_no_packets_but_a_nearest_size() -> None:
    search = PacketSearch(BLANKET, Target.of("10x10cm"), 2)
    assert not list(search.packets())
    # 0.6 x 0.4 m by two folds: 0.2 x 0.4 lacks 0.40 m in all, 0.3 x 0.2 lacks 0.30 m.
    assert sorted(search.nearest_m) == pytest.approx([0.2, 0.3], abs=1e-5)


@pytest.mark.parametrize("face", ["front", "back"])
def test_the_face_asked_for_looks_up(face: str) -> None:
    found = list(islice(packets(BLANKET, "20x20cm", face=face), 6))
    assert len(found) == 6
    assert {packet.face for packet in found} == {face}


def test_the_front_looks_up_after_a_fold_if_the_cloth_is_turned_over_before() -> None:
    # Front up, half onto half shows the back of both halves; face down, the front.
    shown = next(packets(BLANKET, "30x40cm", face="front"))
    assert [fold.kind for fold in shown.folds] == ["turn", "blue"]
    assert FoldSequence.of(replace(BLANKET, folds=shown.folds)).final.layers[-1].face == "front"


def test_a_packet_that_shows_the_wrong_face_is_turned_over_at_the_end() -> None:
    # Two strips folded in leave most of the front to be seen between them; the side below is the back.
    kinds = [[fold.kind for fold in packet.folds] for packet in packets(BLANKET, "50x40cm", face="back")]
    assert ["blue", "blue", "turn"] in kinds


def test_halves_are_half_as_long_and_wide() -> None:
    first = next(packets(BLANKET, "halves"))
    assert first.size_m == pytest.approx((0.3, 0.2), abs=1e-5)
    assert first.way == (("half", 0), ("half", 1))


def test_packets_much_smaller_than_the_target_come_last() -> None:
    areas = [min(packet.size_m) >= 0.09 for packet in packets(BLANKET, "20x20cm")]
    assert areas[0]
    assert areas == sorted(areas, reverse=True)


def test_smallest_packets_come_smallest_first_one_for_each_number_of_folds() -> None:
    found = list(packets(BLANKET, "smallest", max_folds=4))
    assert [len(packet.folds) for packet in found] == [4, 3, 2, 1, 0]
    assert found[0].size_m == pytest.approx((0.15, 0.1), abs=1e-5)
    # Four halves leave a sixteenth, and no fold leaves less than half.
    assert [packet.box_m2 for packet in found] == pytest.approx([0.24 / 2**n for n in (4, 3, 2, 1, 0)], rel=1e-3)


def test_some_packets_are_shown_while_smaller_ones_are_sought() -> None:
    search = PacketSearch(BLANKET, Target.of("smallest"), 4)
    shown = [(packet, search.enumerated) for packet in search.shrinking()]
    assert {len(packet.folds) for packet, _ in shown} == {0, 1, 2, 3, 4}
    assert shown[1][1] < search.enumerated / 4
    assert [len(packet.folds) for packet in search.packets()] == [4, 3, 2, 1, 0]


def test_a_mirrored_garment_is_folded_the_same_ways() -> None:
    shirt = replace(load_garment("t-shirt"), folds=())
    mirrored = replace(shirt, outline=tuple((-x, y) for x, y in reversed(shirt.outline)))
    here, there = (list(islice(packets(one, "shelf"), 6)) for one in (shirt, mirrored))
    assert [packet.way for packet in here] == [packet.way for packet in there]
    for one, other in zip(here, there, strict=True):
        assert one.size_m == pytest.approx(other.size_m, abs=1e-4)


def test_no_packet_is_narrower_than_high() -> None:
    tie = replace(load_garment("tie"), folds=())
    found = list(packets(tie, "smallest"))
    assert found and all(min(packet.size_m) >= packet.layers * tie.thickness_m for packet in found)


@pytest.mark.parametrize("name", ["t-shirt", "jeans", "big-towel"])
def test_what_people_like_most_comes_first(name: str) -> None:
    tastes = [packet.taste for packet in islice(packets(replace(load_garment(name), folds=()), "shelf"), 8)]
    assert tastes == sorted(tastes)


def test_sequences_are_counted_and_limited() -> None:
    search = PacketSearch(replace(load_garment("hand-towel"), folds=()), Target.of("shelf"), 8)
    next(search.packets())
    few = search.enumerated
    list(search.packets())
    assert 0 < few < search.enumerated <= 600
