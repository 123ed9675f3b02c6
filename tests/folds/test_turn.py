"""Turning over: all layers are reflected about an edge, in reversed order."""

import pytest

from planner.cloth.cloth_state import ClothState
from planner.errors import FoldError
from planner.folds.fold_cloth import fold_cloth
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.segment import Segment
from tests.builders import fold, garment, is_same_region, is_same_stack, rectangle, rectangle_points, spread

TOWEL = rectangle_points(0.4, 0.3)
NEAR_EDGE = Segment((0.0, 0.0), (0.4, 0.0))


def folded_in_half() -> ClothState:
    """The far half lies on the near one, its back up."""
    return fold_cloth(spread(TOWEL), Segment((0.0, 0.15), (0.4, 0.15)), "blue").cloth


def test_all_layers_come_to_lie_beyond_the_edge_the_top_one_lowest() -> None:
    before = folded_in_half()
    done = fold_cloth(before, NEAR_EDGE, "turn")
    assert is_same_region(done.moving, rectangle(0.4, 0.15))
    low, high = done.cloth.layers
    # The far half lay on top with its back up. It lies below with its front up, twice reflected; the near half, once
    # reflected, on it.
    assert (low.face, high.face) == ("front", "back")
    assert is_same_region(low.pattern_piece, rectangle(0.4, 0.15, 0.0, 0.15))
    assert is_same_region(high.pattern_piece, rectangle(0.4, 0.15))
    assert is_same_region(done.cloth.silhouette, rectangle(0.4, 0.15, 0.0, -0.15))
    assert done.cloth.flap == done.cloth.layers


def test_turning_back_about_the_same_edge_restores_the_stack() -> None:
    before = folded_in_half()
    turned = fold_cloth(before, NEAR_EDGE, "turn").cloth
    assert is_same_stack(fold_cloth(turned, NEAR_EDGE.reversed, "turn").cloth, before)


def test_a_turn_waits_for_all_before_it_and_all_after_it_for_the_turn() -> None:
    sides = fold((0.1, 0.0), (0.1, 0.3)), fold((0.3, 0.3), (0.3, 0.0))
    turn, last = fold((0.1, 0.0), (0.3, 0.0), "turn"), fold((0.2, 0.0), (0.2, -0.3))
    sequence = FoldSequence.of(garment(TOWEL, *sides, turn, last))
    # The sides, .1 m each, meet nowhere: only the turn is after both.
    assert sequence.dag.edges == ((0, 2), (1, 2), (2, 3))


def test_later_folds_are_drawn_on_the_cloth_as_it_lies_then() -> None:
    turn = fold((0.0, 0.0), (0.4, 0.0), "turn")
    sequence = FoldSequence.of(garment(TOWEL, turn, fold((0.4, -0.15), (0.0, -0.15))))
    # The far half, beyond y = -.15, comes back: its back, which looked up, is inside, and its front is seen.
    assert [layer.face for layer in sequence.final.layers] == ["back", "front"]
    with pytest.raises(FoldError, match="boundary") as refused:
        FoldSequence.of(garment(TOWEL, turn, fold((0.4, 0.15), (0.0, 0.15))))
    assert refused.value.field == "folds[1].start"


def test_a_red_fold_after_a_turn_takes_all_that_was_turned() -> None:
    turn, red = fold((0.0, 0.0), (0.4, 0.0), "turn"), fold((0.4, -0.2), (0.0, -0.2), "red")
    sequence = FoldSequence.of(garment(TOWEL, turn, red))
    assert sequence.dag.chains == ((0, 1),)
    assert [layer.face for layer in sequence.final.layers] == ["back", "front"]
