import pytest

from planner import load_garment
from planner.cloth.cloth_state import ClothState
from planner.proposals.moves import Move, carried_out, flap_moves, inward_moves, turned_over
from tests.builders import rectangle

BLANKET = ClothState.spread_out(rectangle(0.6, 0.4))


def test_what_a_move_leaves_is_known_before_it_is_made() -> None:
    bounds = BLANKET.silhouette.bounds
    moves = list(inward_moves(bounds, (0.25,)))
    assert {move.kind for move in moves} == {"half", "thirds", "roll", "sides", "side"}
    for move in moves:
        done = carried_out(BLANKET, move, 0.127)
        assert done is not None
        x0, y0, x1, y1 = done[0].silhouette.bounds
        assert (x1 - x0, y1 - y0) == pytest.approx(move.size_after(bounds), abs=1e-5)


def test_a_side_within_the_target_is_not_folded() -> None:
    assert {move.axis for move in inward_moves(BLANKET.silhouette.bounds, (0.45,))} == {0}
    assert not list(inward_moves(BLANKET.silhouette.bounds, (0.6,)))


def test_thirds_lie_on_one_another() -> None:
    move = next(move for move in inward_moves(BLANKET.silhouette.bounds, (0.2,)) if move.kind == "thirds")
    done = carried_out(BLANKET, move, 0.127)
    assert done is not None
    cloth, folds = done
    assert cloth.silhouette.bounds == pytest.approx((0.2, 0.0, 0.4, 0.4), abs=1e-5)
    assert [fold.name for fold in folds] == ["left third", "right third"]
    assert len(cloth.layers) == 3


def test_sleeves_are_folded_in_as_a_pair_at_the_body() -> None:
    cloth = ClothState.spread_out(load_garment("t-shirt").pattern)
    pair = next(move for move in flap_moves(cloth.silhouette) if move.kind == "flaps")
    assert pair.axis == 0
    assert [place for place, _ in pair.lines] == pytest.approx([0.0, 0.457])
    assert [is_low for _, is_low in pair.lines] == [True, False]
    done = carried_out(cloth, pair, 0.127)
    assert done is not None
    assert done[0].silhouette.bounds == pytest.approx((0.0, 0.0, 0.457, 0.61), abs=1e-5)


def test_a_rectangle_has_no_flaps() -> None:
    assert not list(flap_moves(BLANKET.silhouette))


def test_wide_swings_take_more_effort() -> None:
    def half(width_m: float) -> float:
        bounds = (0.0, 0.0, width_m, 0.1)
        return Move("half", 1.0, "half", 0, ((width_m / 2, True),)).effort_on(bounds)

    assert half(0.8) == pytest.approx(1.0)
    assert half(1.2) > half(0.9) > 1.0


def test_turned_over_a_long_edge_the_back_looks_up() -> None:
    done = turned_over(BLANKET, 0.127)
    assert done is not None
    cloth, (fold,) = done
    assert fold.kind == "turn"
    assert [layer.face for layer in cloth.layers] == ["back"]
    assert abs(fold.end[0] - fold.start[0]) == pytest.approx(0.6)


def test_cloth_without_a_long_edge_is_not_turned_over() -> None:
    assert turned_over(ClothState.spread_out(rectangle(0.04, 0.04)), 0.127) is None
