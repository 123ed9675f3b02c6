"""Garments folded like others: the folds of one, fitted to the outline of another."""

from dataclasses import replace

import pytest

from planner import Garment, load_garment, propose_folds
from planner.errors import FoldError, RequestError
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Point2
from planner.proposals.likeness import LikenessSearch
from planner.proposals.packet import Packet
from planner.proposals.proposals import all_proposals

T_SHIRT, SHIRT = load_garment("t-shirt"), load_garment("shirt")
OTHER_T_SHIRT: tuple[Point2, ...] = (
    *((0.0, 0.0), (0.4, 0.0), (0.4, 0.36), (0.45, 0.3), (0.56, 0.38), (0.42, 0.58), (0.26, 0.6)),
    *((0.2, 0.57), (0.14, 0.6), (-0.02, 0.58), (-0.16, 0.38), (-0.05, 0.3), (0.0, 0.36)),
)


def garment(outline: tuple[Point2, ...]) -> Garment:
    return Garment.from_dict({"name": "other", "outline": [list(point) for point in outline]})


def fitted(outline: tuple[Point2, ...], model: Garment) -> Packet:
    return next(LikenessSearch(garment(outline), model).packets())


def names(packet: Packet) -> list[str]:
    return [fold.name for fold in packet.folds]


def test_a_garment_is_folded_like_itself_by_its_own_folds() -> None:
    assert fitted(T_SHIRT.outline, T_SHIRT).folds == T_SHIRT.folds


def test_a_shirt_of_another_size_gets_the_folds_in_its_size() -> None:
    larger = fitted(tuple((x * 1.4, y * 1.4) for x, y in SHIRT.outline), SHIRT)
    assert names(larger) == [fold.name for fold in SHIRT.folds]
    x0, y0, x1, y1 = FoldSequence.of(SHIRT).final.silhouette.bounds
    assert larger.size_m == pytest.approx(((x1 - x0) * 1.4, (y1 - y0) * 1.4), abs=0.002)


@pytest.mark.parametrize("way", [Isometry(), Isometry(-1, 0, 0, -1), Isometry(0, -1, 1, 0)], ids=str)
def test_another_t_shirt_is_folded_along_its_own_sleeves_however_it_lies(way: Isometry) -> None:
    turn = way.apply_point
    packet = fitted(tuple(turn(point) for point in OTHER_T_SHIRT), T_SHIRT)
    assert names(packet) == [fold.name for fold in T_SHIRT.folds]
    sleeves = {frozenset((fold.start, fold.end)) for fold in packet.folds[:2]}
    seams = (((0.0, 0.36), (-0.02, 0.58)), ((0.42, 0.58), (0.4, 0.36)))
    assert sleeves == {frozenset(turn(end) for end in seam) for seam in seams}
    across, along = sorted(packet.size_m)
    assert along == pytest.approx(0.3, abs=1e-6)  # bottom up at half its length
    assert across < 0.26


def test_a_fold_of_a_flap_is_left_out_where_there_is_none() -> None:
    skirt = ((0.0, 0.0), (0.6, 0.0), (0.5, 0.55), (0.1, 0.55))
    assert names(fitted(skirt, T_SHIRT)) == ["left side", "right side", "bottom up"]


def test_legs_of_another_length_come_to_lie_on_each_other() -> None:
    shorts = ((0.0, 0.0), (0.26, 0.0), (0.28, 0.14), (0.3, 0.0), (0.56, 0.0), (0.5, 0.42), (0.06, 0.42))
    packet = fitted(shorts, load_garment("jeans"))
    assert packet.size_m == pytest.approx((0.28, 0.21), abs=0.03)


def test_folds_that_the_garment_has_are_kept() -> None:
    half = replace(T_SHIRT, folds=T_SHIRT.folds[:2])
    packet = next(LikenessSearch(half, load_garment("hand-towel")).packets())
    assert packet.folds[:2] == half.folds and len(packet.folds) > 2


def test_what_is_proposed_is_one_way_that_has_a_plan() -> None:
    found = all_proposals(propose_folds(garment(OTHER_T_SHIRT), T_SHIRT))
    assert [one.status for one in found.proposals] == ["solved"]
    assert len(found.proposals[0].garment.folds) == len(T_SHIRT.folds)


def test_a_garment_without_folds_or_with_wrong_ones_is_refused_at_once() -> None:
    with pytest.raises(RequestError, match="no folds") as raised:
        propose_folds(T_SHIRT, replace(SHIRT, folds=()))
    assert raised.value.field == "to.like"
    beside = replace(SHIRT.folds[0], start=(2.0, 0.0), end=(2.0, 1.0))
    with pytest.raises(FoldError, match=r"to\.like\.folds\[0\]"):
        propose_folds(T_SHIRT, replace(SHIRT, folds=(beside,)))
