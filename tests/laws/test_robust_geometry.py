"""Cloth that is hard to compute with: needles, hairlines, corners, many folds, many corners. Nothing gets lost."""

import math
from itertools import pairwise
from time import thread_time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner import check_garment, fold_dag, make_plan
from planner.cloth.cloth_state import ClothState
from planner.cloth.garment import Garment
from planner.cloth.must_hold import must_hold
from planner.errors import FoldError, FoldingError, GarmentError
from planner.folds.fold_cloth import fold_cloth
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from tests.builders import fold, garment, rectangle_points, spread
from tests.laws.drawings import drawings
from tests.laws.law import law
from tests.laws.outlines import Outline, outlines

HAIRS_M = (1e-7, 1e-6, 3e-6, 1e-5, 3e-5, 1e-4, 1e-3)
SHARE = 1e-5


def whole(cloth: ClothState) -> float:
    """Return the area of the layers and of the slivers dropped (m^2)."""
    return cloth.area + sum(cloth.slivers)


def round_cloth(corners: int, radius_m: float = 0.4) -> Outline:
    turns = (math.tau * i / corners for i in range(corners))
    return tuple((radius_m * math.cos(a), radius_m * math.sin(a)) for a in turns)


def halved(cloth: ClothState, line: Segment) -> ClothState:
    return fold_cloth(cloth, line, "blue").cloth


TOWEL = spread(rectangle_points(0.4, 0.3))
CREASE = Segment((0.2, 0.0), (0.2, 0.3))


@pytest.mark.parametrize("hair", HAIRS_M)
def test_a_strip_no_wider_than_a_hair_is_refused_or_folded_or_dropped_and_counted(hair: float) -> None:
    line = Segment((hair, 0.0), (hair, 0.3))
    # The strip has 0.3 x hair of area; under 1e-5 m^2, so up to 33 um, it is a sliver, and nothing would move.
    if hair * 0.3 < 1e-5:
        with pytest.raises(FoldError, match="nothing would move"):
            halved(TOWEL, line)
    else:
        done = halved(TOWEL, line)
        assert len(done.layers) == 2 and done.slivers == ()
        assert done.layers[1].area == pytest.approx(0.3 * hair)
        assert done.area == pytest.approx(0.12)


# A base with two teeth on it 0.1 m wide: one 0.1 m high, and 0.1 m further on one of 60 um.
TEETH = [(0, -0.1), (0.3, -0.1), (0.3, 0.10006), (0.2, 0.10006), (0.2, 0.1), (0.1, 0.1), (0.1, 0.2), (0, 0.2)]


def test_a_sliver_that_hangs_on_cloth_which_stays_is_not_dropped() -> None:
    # The fold's line goes on below the second tooth, whose 6e-6 m^2 belong to the base: 0.3 x 0.2 m^2.
    base, tooth = halved(spread(TEETH), Segment((0.0, 0.1), (0.1, 0.1))).layers
    assert base.area == pytest.approx(0.06 + 6e-6)
    assert tooth.area == pytest.approx(0.01)


def test_a_sliver_that_hangs_on_cloth_which_moves_goes_with_it() -> None:
    # All above y = 0 moves: a leg 0.1 x 0.1 m, a bar 0.3 x 0.1 m on it, and a tooth from the bar's other end that
    # reaches 60 um below the fold's line where that goes on, 0.1 m x 60 um.
    hook = [(0.3, -6e-5), (0.3, 0.2), (0, 0.2), (0, -0.1), (0.1, -0.1), (0.1, 0.1), (0.2, 0.1), (0.2, -6e-5)]
    done = halved(spread(hook), Segment((0.0, 0.0), (0.1, 0.0)))
    assert done.slivers == ()
    assert [layer.area for layer in done.layers] == pytest.approx([0.01, 0.05 + 6e-6])


def test_a_sliver_that_hangs_on_nothing_is_dropped_and_counted() -> None:
    # The lower part, folded up over y = 0.05, covers the teeth. Then all above y = 0.10003 moves: of the layer below
    # the first tooth but for a hair, and of the second 0.1 m x 30 um by themselves, which are no cloth.
    stack = halved(spread(TEETH), Segment((0.3, 0.05), (0.0, 0.05)))
    done = halved(stack, Segment((0.0, 0.10003), (0.3, 0.10003)))
    assert done.slivers == pytest.approx((3e-6,))
    assert done.area == pytest.approx(0.07 + 6e-6 - 3e-6)


@pytest.mark.parametrize("hair", (0.0, *HAIRS_M))
@pytest.mark.parametrize("kind", ("blue", "red"))
def test_folding_again_along_a_crease_or_a_hair_beside_it_loses_nothing(hair: float, kind: str) -> None:
    stack = halved(TOWEL, CREASE)
    for x in (0.2 + hair, 0.4 - hair):
        for line in (Segment((x, 0.0), (x, 0.3)), Segment((x, 0.3), (x, 0.0))):
            try:
                done = fold_cloth(stack, line, kind, CREASE).cloth
            except FoldError:
                continue
            assert whole(done) == pytest.approx(0.12, rel=SHARE)


@pytest.mark.parametrize("tilt", HAIRS_M)
def test_two_folds_along_nearly_parallel_lines_lose_nothing(tilt: float) -> None:
    stack = halved(TOWEL, CREASE)
    # Lines that leave the crease's lower end, and lines that cross it half-way up, by a hair.
    for low, high in ((0.2, 0.2 + 0.3 * tilt), (0.2 - 0.15 * tilt, 0.2 + 0.15 * tilt)):
        for line in (Segment((low, 0.0), (high, 0.3)), Segment((high, 0.3), (low, 0.0))):
            try:
                done = halved(stack, line)
            except FoldError:
                continue
            assert whole(done) == pytest.approx(0.12, rel=SHARE)


@given(outlines(), st.integers(0, 39), st.integers(0, 39))
@law("geometry", short=30, long=500)
def test_a_fold_from_corner_to_corner_parts_the_cloth_there_or_is_refused(outline: Outline, i: int, j: int) -> None:
    start, end = outline[i % len(outline)], outline[j % len(outline)]
    if start == end:
        return
    before = spread(outline)
    try:
        drawn = garment(outline, fold(start, end))
        after = FoldSequence.of(drawn).final
    except FoldError:
        return
    assert whole(after) == pytest.approx(before.area, rel=SHARE)
    assert len(after.layers) >= 2


def rolled(folds: int, pitch_m: float, width_m: float) -> Garment:
    """Return a ribbon rolled up from its left end; each fold takes one layer more."""
    lines = (fold((pitch_m * i, 0.0), (pitch_m * i, width_m)) for i in range(1, folds + 1))
    return garment(rectangle_points(pitch_m * (folds + 1), width_m), *lines)


def test_a_ribbon_rolled_up_in_64_folds_has_65_layers_each_waiting_for_the_one_before() -> None:
    sequence = FoldSequence.of(rolled(64, 0.1, 0.05))
    assert [len(sequence.cloth((1 << n) - 1).layers) for n in range(65)] == list(range(1, 66))
    assert sequence.final.area == pytest.approx(6.5 * 0.05, rel=1e-9)
    assert sequence.dag.edges == tuple(pairwise(range(64)))
    assert sequence.final.silhouette.area == pytest.approx(0.1 * 0.05, rel=1e-3)


def test_a_ribbon_folded_to_and_fro_64_times_is_a_stack_of_65() -> None:
    # What is left over of the ribbon lies to the left of x = 0.1, then to the right of x = 0, and so on.
    to, fro = fold((0.1, 0.05), (0.1, 0.0)), fold((0.0, 0.0), (0.0, 0.05))
    sequence = FoldSequence.of(garment(rectangle_points(6.5, 0.05), *((to, fro) * 32)))
    assert len(sequence.final.layers) == 65
    assert all(layer.area == pytest.approx(0.005) for layer in sequence.final.layers)
    assert [layer.face for layer in sequence.final.layers] == ["front", "back"] * 32 + ["front"]
    middles = [layer.to_pattern((0.05, 0.025))[0] for layer in sequence.final.layers]
    assert middles == pytest.approx([0.05 + 0.1 * i for i in range(65)])


def test_twenty_folds_with_512_layers_lose_nothing_and_take_less_than_two_seconds() -> None:
    # Rolled up 15 times: 16 layers of 0.1 x 0.8 m. Halved five times the other way: 16 x 32.
    roll = rolled(15, 0.1, 0.8)
    halvings = (fold((1.5, 0.8 / 2**i), (1.6, 0.8 / 2**i)) for i in range(1, 6))
    cloth = garment(roll.outline, *roll.folds, *halvings)
    began_s = thread_time()
    sequence = fold_dag(cloth)
    assert len(sequence.to_dict()["layers"]) == 512
    assert thread_time() - began_s < 2.0
    assert len(sequence.folds) == 20 and len(sequence.final.layers) == 512
    assert sequence.final.area == pytest.approx(1.6 * 0.8, rel=1e-9)
    assert sequence.final.silhouette.area == pytest.approx(0.1 * 0.025, rel=1e-3)


@pytest.mark.parametrize("corners", (64, 400))
def test_a_round_cloth_folded_to_an_eighth_keeps_its_area_and_has_eight_layers(corners: int) -> None:
    # Through opposite corners every time. The area of a regular polygon: n/2 r^2 sin(2 pi / n).
    up, right, slanting = (0.0, 0.4), (0.4, 0.0), (0.4 * math.sqrt(0.5), 0.4 * math.sqrt(0.5))
    half = fold((0.0, -0.4), up)
    quarter = fold((0.0, 0.0), right)
    eighth = fold(slanting, (0.0, 0.0))
    lines = [half, fold(quarter.end, quarter.start), eighth]
    sequence = FoldSequence.of(garment(round_cloth(corners), *lines))
    area = corners / 2 * 0.16 * math.sin(math.tau / corners)
    assert len(sequence.final.layers) == 8
    assert sequence.final.area == pytest.approx(area, rel=1e-9)
    assert sequence.final.silhouette.area == pytest.approx(area / 8, rel=1e-4)


def test_a_cog_of_400_corners_keeps_its_area_wherever_it_is_folded() -> None:
    # 200 teeth between the radii 0.36 and 0.4 m: 400 triangles of r R sin(2 pi / 400) / 2.
    radii, turns = (0.4, 0.36), [math.tau * i / 400 for i in range(400)]
    cog = tuple((radii[i % 2] * math.cos(a), radii[i % 2] * math.sin(a)) for i, a in enumerate(turns))
    area = 200 * 0.4 * 0.36 * math.sin(math.tau / 400)
    # From tip to tip through the middle, and between bottoms of notches: such a chord stays within 0.36 m.
    for i, j in ((0, 200), (200, 0), (1, 131), (131, 1), (11, 71), (399, 301)):
        sequence = FoldSequence.of(garment(cog, fold(cog[i], cog[j])))
        assert len(sequence.final.layers) == 2 and sequence.final.slivers == ()
        assert sequence.final.area == pytest.approx(area, rel=1e-9)
        # What lies to the left of the chord is the polygon of the corners from j round to i.
        moved = [cog[k % 400] for k in range(j, j + (i - j) % 400 + 1)]
        assert sequence.final.layers[1].area == pytest.approx(Region.polygon(moved).area, rel=1e-6)
        assert not check_garment(sequence.garment).is_holdable


def test_a_round_cloth_of_400_corners_needs_more_hands_than_there_are_and_that_is_an_answer() -> None:
    disc = Region.polygon(round_cloth(400))
    # The corners of the upper half, every 0.9 degrees from 0 to 180: at the outermost the edge up leans in by 0.45.
    assert len(must_hold(disc, (0.0, 1.0), (), 0.0)) == 201
    cloth = garment(round_cloth(400), fold((0.0, -0.4), (0.0, 0.4)))
    assert not check_garment(cloth).is_holdable
    answer = make_plan(cloth)
    assert answer.status == "infeasible"
    first, *others = answer.reasons
    assert first.code == "too_many_grips"
    # What else is named would have to be fixed together with it.
    assert {reason.set for reason in others} <= {first.set}


def test_one_corner_more_than_400_is_refused() -> None:
    with pytest.raises(GarmentError, match="401 points"):
        garment(round_cloth(401))


PLACE = st.tuples(st.floats(-10.0, 10.0), st.floats(-10.0, 10.0))


@given(drawings(most_folds=4), st.lists(st.tuples(PLACE, PLACE, st.booleans()), max_size=2))
@law("geometry", short=15, long=500)
def test_whatever_is_drawn_it_is_planned_or_refused_with_an_error_of_ours(
    drawn: Garment, more: list[tuple[Point2, Point2, bool]]
) -> None:
    folds = [{"name": "rough", "kind": "red" if red else "blue", "start": [*a], "end": [*b]} for a, b, red in more]
    data = drawn.to_dict()
    try:
        cloth = Garment.from_dict({**data, "folds": [*data["folds"], *folds]})
        FoldSequence.of(cloth).to_dict()
        check_garment(cloth)
        make_plan(cloth, time_limit_s=0.05).to_dict()
    except FoldingError:
        assert folds, "the folds that were drawn are legal"
