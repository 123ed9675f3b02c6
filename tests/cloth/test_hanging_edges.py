"""Cloth that hangs from any edge of the table, from several at once, and round its corners.

The table is 1.6 x 0.98 m unless a test says otherwise; the garment frame is the table frame. A place beside an edge is
given as (along, out): along it from its middle, and how far beyond it (negative: on the table).
"""

import math
from collections.abc import Sequence

import pytest

from planner.cloth.cloth_state import ClothState
from planner.cloth.g_state import StabilityViolation, TableInGarment, stability_violation
from planner.geometry.pose import Point2, Pose2
from planner.geometry.region import Region
from planner.geometry.table import Table
from tests.builders import rectangle, spread

TABLE = Table(1.6, 0.98, 0.79)
SQUARE = Table(0.6, 0.6, 0.79)
OUTWARDS = {"near": (-1, 0), "far": (1, 0), "left": (0, 1), "right": (0, -1)}

each_edge = pytest.mark.parametrize("edge", OUTWARDS)


def beside(edge: str, points: Sequence[Point2]) -> list[Point2]:
    """Return points given as (along, out) in the table frame."""
    (nx, ny), half = OUTWARDS[edge], 0.8 if edge in ("near", "far") else 0.49
    return [(nx * (half + out) - ny * along, ny * (half + out) + nx * along) for along, out in points]


def block(low: float, high: float, lying_m: float, hanging_m: float) -> list[Point2]:
    """Return a rectangle square over an edge, from one place along it to another."""
    return [(low, -lying_m), (high, -lying_m), (high, hanging_m), (low, hanging_m)]


def why(
    cloth: ClothState, friction: float = 1.0, support_deg: float = 0.0, table: Table = TABLE
) -> StabilityViolation | None:
    return stability_violation(
        cloth, TableInGarment.seen_from(Pose2(0.0, 0.0, 0.0), table), friction, math.radians(support_deg)
    )


def union(*parts: Sequence[Point2]) -> ClothState:
    return ClothState.spread_out(Region.union(Region.polygon(part) for part in parts))


def code(found: StabilityViolation | None) -> str | None:
    return None if found is None else found.code


@each_edge
def test_at_every_edge_as_much_may_hang_as_friction_times_what_lies(edge: str) -> None:
    # 0.2 m lie, so with mu = 0.8 just 0.16 m may hang.
    assert why(spread(beside(edge, block(-0.1, 0.1, 0.2, 0.1599))), friction=0.8) is None
    found = why(spread(beside(edge, block(-0.1, 0.1, 0.2, 0.162))), friction=0.8)
    # 0.162 / 0.2 = 0.81.
    assert found is not None and found.code == "slips"
    assert found.needed_friction == pytest.approx(0.81)


@each_edge
def test_at_every_edge_a_part_that_widens_downwards_comes_loose_at_its_first_corner(edge: str) -> None:
    # Over 0.2 m it widens by 0.02 m to each side: its sides lean by atan 0.1 = 5.7 degrees.
    points = [(-0.1, -0.3), (0.1, -0.3), (0.1, 0.0), (0.12, 0.2), (-0.12, 0.2), (-0.1, 0.0)]
    cloth = spread(beside(edge, points))
    found = why(cloth, support_deg=5.6)
    assert found is not None and found.code == "not_a_g_state"
    assert any(found.point == pytest.approx(corner) for corner in beside(edge, [(0.12, 0.2), (-0.12, 0.2)]))
    assert why(cloth, support_deg=5.8) is None


@each_edge
def test_at_every_edge_two_tongues_weigh_together(edge: str) -> None:
    # A band 0.6 m long and 0.15 m wide lies along the edge; two tongues 0.1 m wide hang from it, 0.3 and 0.5 m long.
    band, one, other = block(-0.3, 0.3, 0.15, 0.0), block(-0.3, -0.2, 0.01, 0.3), block(0.2, 0.3, 0.01, 0.5)
    cloth = union(*(beside(edge, part) for part in (band, one, other)))
    # 0.08 m^2 hang, 0.09 m^2 lie: 0.8889.
    assert why(cloth, friction=0.889) is None
    assert code(why(cloth, friction=0.888)) == "slips"


@pytest.mark.parametrize(("one", "other", "lying_m"), [("near", "far", 1.6), ("left", "right", 0.98)])
def test_of_opposite_edges_only_the_difference_pulls(one: str, other: str, lying_m: float) -> None:
    # 0.3 m hang from one, 0.1 m from the other.
    cloth = union(beside(one, block(-0.1, 0.1, lying_m / 2, 0.3)), beside(other, block(-0.1, 0.1, lying_m / 2, 0.1)))
    limit = 0.2 / lying_m
    assert why(cloth, friction=limit + 1e-4) is None
    assert code(why(cloth, friction=limit - 1e-4)) == "slips"


@pytest.mark.parametrize(("first", "second"), [("near", "left"), ("near", "right"), ("far", "left"), ("far", "right")])
def test_at_right_angles_the_pulls_add_up_as_vectors(first: str, second: str) -> None:
    # A bent strip, 0.2 m wide, its corner in the middle of the table. 0.3 m hang from one edge and 0.4 m from the
    # other: 0.06 and 0.08 m^2 pull with hypot = 0.1. On the table lie 0.8 + 0.1 m and, of the other arm, 0.49 - 0.1 m.
    cloth = union(beside(first, block(-0.1, 0.1, 0.9, 0.3)), beside(second, block(-0.1, 0.1, 0.49 + 0.1, 0.4)))
    limit = 0.1 / (0.2 * (0.8 + 0.1) + 0.2 * (0.49 - 0.1))
    assert limit == pytest.approx(0.1 / 0.258)
    assert why(cloth, friction=limit + 1e-4) is None
    assert code(why(cloth, friction=limit - 1e-4)) == "slips"


def cross(**hanging_m: float) -> ClothState:
    """Return two strips 0.2 m wide across the middle of a square table 0.6 m wide, hanging over each edge."""
    along = rectangle(0.6 + hanging_m["near"] + hanging_m["far"], 0.2, -0.3 - hanging_m["near"], -0.1)
    across = rectangle(0.2, 0.6 + hanging_m["left"] + hanging_m["right"], -0.1, -0.3 - hanging_m["right"])
    return ClothState.spread_out(Region.union([along, across]))


def test_from_four_edges_alike_cloth_hangs_on_the_smoothest_table() -> None:
    assert why(cross(near=0.5, far=0.5, left=0.5, right=0.5), friction=0.0, table=SQUARE) is None


def test_with_three_edges_alike_only_the_one_without_a_partner_pulls() -> None:
    # 0.1 m from the near edge; lying: 0.6 x 0.2 + 2 x 0.2 x 0.2 = 0.2 m^2. 0.02 / 0.2 = 0.1.
    cloth = cross(near=0.1, far=0.0, left=0.1, right=0.1)
    assert why(cloth, friction=0.1001, table=SQUARE) is None
    assert code(why(cloth, friction=0.0999, table=SQUARE)) == "slips"


def test_layers_that_hang_from_different_edges_all_count() -> None:
    # A strip over the near edge, and on it another piece over the far one: two layers, 0.02 m^2 more at the near one.
    one, other = rectangle(1.0, 0.2, -1.0, -0.1), rectangle(0.9, 0.2, 0.0, -0.1)
    near, far = ClothState.spread_out(one).layers, ClothState.spread_out(other).layers
    cloth = ClothState([*near, *far])
    # Hanging 0.04 and 0.02 m^2; lying 0.16 + 0.16 m^2.
    assert why(cloth, friction=0.02 / 0.32 + 1e-4) is None
    assert code(why(cloth, friction=0.02 / 0.32 - 1e-4)) == "slips"


@pytest.mark.parametrize("corner", TABLE.corners)
def test_a_corner_strictly_inside_the_cloth_is_no_g_state(corner: Point2) -> None:
    # A square of 0.4 m whose middle lies 0.1 m inside the corner, both ways.
    x, y = corner
    inside = (x - math.copysign(0.1, x) - 0.2, y - math.copysign(0.1, y) - 0.2)
    found = why(ClothState.spread_out(rectangle(0.4, 0.4, *inside)), friction=9.0)
    assert found is not None and found.code == "not_a_g_state"
    assert found.point == pytest.approx(corner)


@pytest.mark.parametrize(("gap_m", "is_free"), [(0.0, True), (-0.001, False), (0.001, True)])
def test_a_corner_is_free_up_to_the_rim_of_the_cloth(gap_m: float, is_free: bool) -> None:
    # The cloth's right side runs beside the table's right edge, y = -0.49, over the near edge: at it, 1 mm beyond, 1 mm
    # inside. Beyond it also hangs from the right edge, by 1 mm.
    found = why(ClothState.spread_out(rectangle(0.6, 0.4, -1.0, -0.49 + gap_m)))
    assert (found is None) == is_free
    assert found is None or (found.code == "not_a_g_state" and found.point == pytest.approx((-0.8, -0.49)))


def test_a_cloth_with_its_corners_cut_out_hangs_from_all_four_edges_and_a_whole_one_does_not() -> None:
    whole = rectangle(0.8, 0.8, -0.4, -0.4)
    cut_out = whole
    for x in (-0.4, 0.3):
        for y in (-0.4, 0.3):
            cut_out = cut_out.difference(rectangle(0.1, 0.1, x, y))
    assert why(ClothState.spread_out(cut_out), friction=0.0, table=SQUARE) is None
    found = why(ClothState.spread_out(whole), table=SQUARE)
    assert found is not None and found.point is not None and tuple(map(abs, found.point)) == pytest.approx((0.3, 0.3))


def test_a_part_that_goes_round_a_free_corner_from_edge_to_edge_is_no_g_state() -> None:
    # A frame 0.05 m wide, 0.05 m off the table: it leaves it over the near edge and comes back over the right one.
    arms = [rectangle(0.5, 0.05, -0.9, -0.59), rectangle(0.05, 0.5, -0.9, -0.59)]
    roots = [rectangle(0.3, 0.05, -0.9, -0.14), rectangle(0.05, 0.3, -0.45, -0.59)]
    found = why(ClothState.spread_out(Region.union([*arms, *roots])), friction=9.0)
    assert found is not None and found.code == "not_a_g_state"
    assert "right and near" in found.message


def test_a_hanging_part_may_reach_past_a_corner_only_as_far_as_the_support_angle_allows() -> None:
    # Its right side starts 1 mm inside the corner and leans by 4 degrees: 0.2 m below it is 0.2 tan 4 = 0.014 m further
    # right, 0.013 m beyond the right edge. Nothing is straight above that corner, but within 5 degrees there is.
    lean = 0.2 * math.tan(math.radians(4.0))
    points = [(-0.5, -0.489), (-0.5, -0.2), (-1.0, -0.2), (-1.0, -0.489 - lean), (-0.8, -0.489)]
    found = why(spread(points))
    assert found is not None and found.point == pytest.approx((-1.0, -0.489 - lean))
    assert why(spread(points), support_deg=3.9) is not None
    assert why(spread(points), support_deg=5.0) is None


def test_a_foot_that_reaches_past_a_corner_falls_down() -> None:
    # A stocking: down 0.2 m from the near edge, then 0.1 m high to the right, past the corner at y = -0.49.
    points = [(-0.4, -0.4), (-0.4, -0.1), (-1.0, -0.1), (-1.0, -0.6), (-0.9, -0.6), (-0.9, -0.4)]
    found = why(spread(points), support_deg=5.0)
    assert found is not None and found.point == pytest.approx((-0.9, -0.6))


def test_where_all_of_one_layer_hangs_it_is_held_by_what_it_touches_of_the_edge() -> None:
    # A layer whose rim runs along the near edge from outside hangs from that edge; 1 mm lower it hangs from nothing.
    lying = ClothState.spread_out(rectangle(0.4, 0.4, -0.8, -0.2)).layers
    for top_m, wanted in ((-0.8, None), (-0.801, "not_a_g_state")):
        hung = ClothState.spread_out(rectangle(0.1, 0.4, top_m - 0.1, -0.2)).layers
        assert code(why(ClothState([*lying, *hung]))) == wanted
