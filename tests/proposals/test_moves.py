import pytest

from planner import load_garment
from planner.cloth.cloth_state import ClothState
from planner.geometry.region import Region
from planner.proposals.moves import Move, carried_out, flap_moves, inward_moves, slanted_moves, turned_over
from planner.proposals.target import Sides
from tests.builders import rectangle

BLANKET = ClothState.spread_out(rectangle(0.6, 0.4))


def cloth_after(cloth: ClothState, move: Move) -> ClothState:
    done = carried_out(cloth, move, 0.127)
    assert done is not None
    return done[0]


def size_after(cloth: ClothState, move: Move) -> Sides:
    x0, y0, x1, y1 = cloth_after(cloth, move).silhouette.bounds
    return (x1 - x0, y1 - y0)


def side_names(move: Move) -> list[str]:
    return [crease.name for crease in move.creases]


def test_what_a_move_leaves_is_known_before_it_is_made() -> None:
    moves = list(inward_moves(BLANKET.silhouette.bounds, (0.25,)))
    assert {move.kind for move in moves} == {"half", "thirds", "roll", "sides", "side"}
    for move in moves:
        assert size_after(BLANKET, move) == pytest.approx(move.size_m, abs=1e-5)


def test_long_cloth_may_be_halved_by_a_quarter_and_on_with_it() -> None:
    scarf = ClothState.spread_out(rectangle(0.25, 1.5))
    near, far = (move for move in inward_moves(scarf.silhouette.bounds, (0.75,)) if move.kind == "quarters")
    for move, low, high in ((near, 0.75, 1.5), (far, 0.0, 0.75)):
        done = carried_out(scarf, move, 0.127)
        assert done is not None
        assert done[0].silhouette.bounds == pytest.approx((0.0, low, 0.25, high), abs=1e-5)
        assert (len(done[0].layers), len(done[1])) == (3, 2)
    (half,) = (
        one
        for one in inward_moves(scarf.silhouette.bounds, (0.75,))
        if one.kind == "half" and one.creases[0].name == "bottom half"
    )
    assert near.effort < half.effort  # no arm swings so wide


def test_sides_that_stick_out_are_tucked_back() -> None:
    move = next(move for move in inward_moves((0.0, 0.0, 0.7, 0.4), (0.2,)) if move.kind == "sides")
    assert [(crease.kind, crease.name) for crease in move.creases] == [
        ("blue", "left side"),
        ("red", "left side back"),
        ("blue", "right side"),
        ("red", "right side back"),
    ]
    cloth = ClothState.spread_out(rectangle(0.7, 0.4))
    assert move.size_m == pytest.approx((0.2, 0.4))
    assert size_after(cloth, move) == pytest.approx((0.2, 0.4), abs=1e-5)


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
    assert [crease.line.start[0] for crease in pair.creases] == pytest.approx([0.0, 0.457])
    assert side_names(pair) == ["left flap", "right flap"]
    done = carried_out(cloth, pair, 0.127)
    assert done is not None
    assert done[0].silhouette.bounds == pytest.approx((0.0, 0.0, 0.457, 0.61), abs=1e-5)


def test_a_rectangle_has_no_flaps() -> None:
    assert not list(flap_moves(BLANKET.silhouette))


def test_sleeves_at_a_slanted_seam_are_folded_in_as_a_pair() -> None:
    # The body narrows from 0.3 m at the bottom to 0.2 m at the top; the sleeves are 0.1 m wide parallelograms.
    half = [(0.15, 0.0), (0.12, 0.3), (0.3, 0.3), (0.3, 0.4), (0.1, 0.5)]
    cloth = ClothState.spread_out(Region.polygon([*half, *((-x, y) for x, y in reversed(half))]))
    pairs = [move for move in slanted_moves(cloth.silhouette) if move.kind == "flaps"]
    assert pairs
    for pair in pairs:
        one, other = pair.creases
        assert one.line.start == pytest.approx((-other.line.end[0], other.line.end[1]))
        x_m, y_m = size_after(cloth, pair)
        assert (x_m, y_m) == pytest.approx(pair.size_m, abs=1e-5)
        assert x_m < 0.6 - 0.1


def test_an_edge_of_a_right_triangle_lands_on_the_other() -> None:
    cloth = ClothState.spread_out(Region.polygon([(0.0, 0.0), (0.4, 0.0), (0.0, 0.4)]))
    edges = [move for move in slanted_moves(cloth.silhouette) if move.kind == "edges"]
    halves = [move for move in edges if cloth_after(cloth, move).silhouette.area == pytest.approx(0.04)]
    (half,) = halves  # over the line from the right angle to the middle of the long edge
    assert half.size_m == pytest.approx((0.2, 0.4)) or half.size_m == pytest.approx((0.4, 0.2))
    for move in edges:
        assert size_after(cloth, move) == pytest.approx(move.size_m, abs=1e-5)


def test_a_rectangle_has_no_slanted_moves() -> None:
    assert not list(slanted_moves(BLANKET.silhouette))


def test_wide_swings_take_more_effort() -> None:
    def half(width_m: float) -> float:
        move = next(iter(inward_moves((0.0, 0.0, width_m, 0.1), (width_m / 2,))))
        assert move.kind == "half"
        return move.effort

    assert half(0.8) == pytest.approx(1.0)
    assert half(1.2) > half(0.9) > 1.0


def test_cloth_is_turned_over_each_side_the_longest_first() -> None:
    turned = list(turned_over(BLANKET, 0.127))
    assert [abs(fold.end[0] - fold.start[0]) for _, fold in turned] == pytest.approx([0.6, 0.6, 0.0, 0.0])
    for cloth, fold in turned:
        assert fold.kind == "turn"
        assert [layer.face for layer in cloth.layers] == ["back"]


def test_cloth_without_a_long_edge_is_not_turned_over() -> None:
    assert not list(turned_over(ClothState.spread_out(rectangle(0.04, 0.04)), 0.127))
