"""The fewest grips that hold every vertex, and the nearest of them."""

import math
import random

import numpy as np
import pytest

from planner.cloth import grips
from planner.cloth.grips import best_covers, grip_covers
from planner.cloth.must_hold import must_hold
from planner.geometry.pose import FloatArray, Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from tests.builders import rectangle, star

UP = (0.0, 1.0)


def top(width_m: float) -> tuple[Region, FloatArray]:
    """Return a rectangle and its two top corners."""
    piece = rectangle(width_m, 0.3)
    return piece, must_hold(piece, UP, (), 0.0)


def rank(cover: tuple[Point2, ...], vertices: FloatArray) -> list[float]:
    return sorted((min(math.dist(v, g) for g in cover) for v in vertices), reverse=True)


def test_two_vertices_exactly_two_radii_apart_are_held_by_one_grip_half_way() -> None:
    piece, vertices = top(0.254)
    found = grip_covers(piece, vertices, 0.127, 2)
    assert found.count == 1
    ((grip,),) = found.covers
    assert grip == pytest.approx((0.127, 0.3))


def test_two_vertices_a_millimetre_further_apart_are_gripped_each() -> None:
    piece, vertices = top(0.255)
    found = grip_covers(piece, vertices, 0.127, 2)
    assert found.covers == (((0.0, 0.3), (0.255, 0.3)),)


def test_what_needs_no_holding_needs_no_grip() -> None:
    found = grip_covers(rectangle(0.4, 0.3), np.empty((0, 2)), 0.127, 2)
    assert found.is_holdable and found.count == 0 and found.covers == ((),)


def test_more_grips_than_arms_are_no_cover() -> None:
    piece, vertices = top(0.4)
    found = grip_covers(piece, vertices, 0.127, 1)
    assert not found.is_holdable and found.count is None
    assert found.vertices == ((0.4, 0.3), (0.0, 0.3))


def test_covers_that_mirror_each_other_tie_and_are_both_kept() -> None:
    # Three vertices L, M, R: |LM| = |MR| = hypot(.25, .02) = .2508, so one grip half-way holds two of them, not three.
    house = Region.polygon([(0, 0), (0.5, 0), (0.5, 0.5), (0.25, 0.52), (0, 0.5)])
    vertices = must_hold(house, UP, (), 0.0)
    assert len(vertices) == 3
    found = grip_covers(house, vertices, 0.13, 2)
    mirrored = {tuple(sorted((round(0.5 - x, 4), round(y, 4)) for x, y in c)) for c in found.covers}
    assert mirrored == {tuple(sorted((round(x, 4), round(y, 4)) for x, y in c)) for c in found.covers}
    assert len(found.covers) == 2
    assert rank(found.covers[0], vertices) == pytest.approx([0.1254, 0.1254, 0.0], abs=1e-4)


def test_a_round_cloth_has_too_many_vertices_for_two_grips() -> None:
    angles = np.linspace(0.0, math.tau, 360, endpoint=False)
    round_cloth = Region.polygon(np.column_stack([0.4 * np.cos(angles), 0.4 * np.sin(angles)]))
    vertices = must_hold(round_cloth, UP, (), 0.0)
    assert len(vertices) > 150
    assert not grip_covers(round_cloth, vertices, 0.127, 2).is_holdable


def test_a_small_round_cloth_is_held_by_one_grip() -> None:
    angles = np.linspace(0.0, math.tau, 40, endpoint=False)
    coaster = Region.polygon(np.column_stack([0.05 * np.cos(angles), 0.05 * np.sin(angles)]))
    found = grip_covers(coaster, must_hold(coaster, UP, (), 0.0), 0.127, 2)
    assert found.count == 1


def test_no_grip_lies_on_the_baseline_which_does_not_move() -> None:
    # A crown 0.24 m wide that hangs from y = 0.1, 5 mm deep at its sides and 0.1 m at its tip. The point
    # between its side corners is 5 mm from the baseline, and hypot(.12, .005) = .1201 from them, 0.1 m from the
    # tip: one grip there would do.
    crown = Region.polygon([(0, 0.1), (0, 0.095), (0.12, 0), (0.24, 0.095), (0.24, 0.1)])
    line = Segment((0.24, 0.1), (0, 0.1))
    vertices = must_hold(crown, (0.0, -1.0), (line,), 0.0)
    assert len(vertices) == 3
    ((grip,),) = grip_covers(crown, vertices, 0.127, 2).covers
    assert grip == pytest.approx((0.12, 0.1))
    found = grip_covers(crown, vertices, 0.127, 2, (line,))
    assert found.count == 2
    assert all(y < 0.1 - 1e-5 for cover in found.covers for _, y in cover)


def test_only_the_candidates_given_are_used() -> None:
    vertices = np.array([[0.0, 0.3], [0.1, 0.3]])
    held = np.array([[0.05, 0.3], [0.9, 0.9]])
    assert best_covers(held, vertices, 0.127, 2) == (((0.05, 0.3),),)
    assert best_covers(held[1:], vertices, 0.127, 2) == ()


def test_every_vertex_is_within_the_radius_of_a_grip() -> None:
    rng = random.Random(9)
    for _ in range(60):
        piece = Region.polygon(star(rng, 8))
        if not piece.shape.is_valid:
            continue
        vertices = must_hold(piece, UP, (), 0.1)
        for cover in grip_covers(piece, vertices, 0.2, 2).covers:
            assert rank(cover, vertices)[0] <= 0.2 + 1e-5
            assert all(piece.boundary_distance(grip) < 1e-9 for grip in cover)


@pytest.mark.parametrize("seed", range(20))
def test_of_many_candidates_the_best_pairs_are_those_that_ranking_all_of_them_finds(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    rng = np.random.default_rng(seed)
    candidates = np.round(rng.uniform(0.0, 0.5, (100, 2)), rng.integers(1, 4))
    vertices = np.round(rng.uniform(0.0, 0.3, (rng.integers(1, 90), 2)), 2)
    pruned = best_covers(candidates, vertices, 0.2, 2)
    monkeypatch.setattr(grips, "_RANKED_AT_ONCE", len(candidates))
    assert pruned == best_covers(candidates, vertices, 0.2, 2)


def test_three_grips_that_hold_a_round_edge_are_found_among_hundreds_of_candidates() -> None:
    # A half disc of radius 22 cm has an edge of 69 cm; a grip holds 25 cm of it.
    turns = np.linspace(0.0, math.pi, 160)
    piece = Region.polygon([(0.22 * math.cos(turn), 0.22 * math.sin(turn)) for turn in turns])
    line = Segment((-0.22, 0.0), (0.22, 0.0))
    vertices = must_hold(piece, (0.0, 1.0), (line,), 0.0)
    assert grip_covers(piece, vertices, 0.127, 2, (line,)).count is None
    found = grip_covers(piece, vertices, 0.127, 3, (line,))
    assert found.count == 3
    for cover in found.covers:
        gaps = np.hypot(*(np.array(cover)[:, None] - vertices[None]).transpose(2, 0, 1)).min(axis=0)
        assert gaps.max() <= 0.127 + 1e-5


def test_corners_further_than_eight_centimetres_from_one_hand_get_another() -> None:
    piece, vertices = top(0.254)
    found = grip_covers(piece, vertices, 0.127, 2)
    assert found.firm == (((0.0, 0.3), (0.254, 0.3)),)
    assert found.every == (*found.firm, *found.covers) and found.count == 1


@pytest.mark.parametrize(("width_m", "hands"), [(0.16, 1), (0.161, 2)])
def test_corners_held_firmly_need_no_hand_more(width_m: float, hands: int) -> None:
    piece, vertices = top(width_m)
    found = grip_covers(piece, vertices, 0.127, 2)
    assert found.count == 1 and len(found.firm[0]) == hands
    assert (found.every == found.covers) == (hands == 1)


def test_where_the_hands_cannot_hold_firmly_they_hold_as_near_as_they_can() -> None:
    piece, vertices = top(0.254)
    alone = grip_covers(piece, vertices, 0.127, 1)
    assert alone.firm == alone.covers and alone.firm_m == pytest.approx(0.127)
    row = np.array([(0.0, 0.3), (0.12, 0.3), (0.32, 0.3), (0.52, 0.3)])
    found = grip_covers(rectangle(0.52, 0.3), row, 0.127, 2)
    assert found.firm == found.covers and found.firm_m == pytest.approx(0.1)


def test_a_radius_under_eight_centimetres_is_firm() -> None:
    piece, vertices = top(0.13)
    found = grip_covers(piece, vertices, 0.06, 2)
    assert found.firm == found.covers and found.count == 2


def test_firm_covers_are_the_best_of_their_number_within_eight_centimetres() -> None:
    rng = random.Random(11)
    for _ in range(60):
        piece = Region.polygon(star(rng, 8))
        vertices = must_hold(piece, UP, (), 0.1) if piece.shape.is_valid else np.empty((0, 2))
        narrow, wide = (grip_covers(piece, vertices, radius_m, 2) for radius_m in (grips.FIRM_M, 0.2))
        assert not narrow.covers or wide.firm == narrow.covers
        assert bool(wide.firm) == bool(wide.covers)
