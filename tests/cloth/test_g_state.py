"""Whether cloth left alone stays as it is. The table is 1.6 x 0.98 m; its near edge is x = -0.8, its left one y = 0.49.

Unless a test says otherwise the garment frame is the table frame.
"""

import math
import random

import pytest

from planner.cloth.cloth_state import ClothState
from planner.cloth.g_state import StabilityViolation, TableInGarment, stability_violation
from planner.folds.fold_cloth import fold_cloth
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Point2, Pose2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.table import Table
from tests.builders import rectangle, rectangle_points, spread, star
from tests.required import required

TABLE = Table(1.6, 0.98, 0.79)
HERE = Pose2(0.0, 0.0, 0.0)


def why(cloth: ClothState, friction: float = 1.0, support_deg: float = 0.0) -> StabilityViolation | None:
    return stability_violation(cloth, TableInGarment.seen_from(HERE, TABLE), friction, math.radians(support_deg))


def over_near_edge(hanging_m: float, lying_m: float, width_m: float = 0.4) -> ClothState:
    """Return a rectangle that lies square over the near edge."""
    x, y = -0.8 - hanging_m, -width_m / 2
    return ClothState.spread_out(rectangle(hanging_m + lying_m, width_m, x, y))


def test_cloth_in_the_middle_of_the_table_is_at_rest() -> None:
    assert why(ClothState.spread_out(rectangle(0.4, 0.4, -0.2, -0.2)), friction=0.0) is None


def test_cloth_exactly_up_to_the_edges_does_not_hang() -> None:
    assert why(ClothState.spread_out(rectangle(1.6, 0.98, -0.8, -0.49)), friction=0.0) is None


@pytest.mark.parametrize("friction", [0.5, 1.0, 4.0])
def test_a_rectangle_slips_when_it_hangs_longer_than_friction_times_what_lies(friction: float) -> None:
    # Equal widths: weights are as lengths. It stays as long as hanging <= mu x lying.
    assert why(over_near_edge(0.2 * friction, 0.2), friction) is None
    slipping = why(over_near_edge(0.2 * friction + 0.002, 0.2), friction)
    assert slipping is not None and slipping.code == "slips"


def test_two_opposite_edges_balance() -> None:
    # 0.3 m hang on each side: no net pull, however smooth the table.
    assert why(ClothState.spread_out(rectangle(0.3, 1.58, 0.0, -0.79)), friction=0.0) is None


@pytest.mark.parametrize("turn", [0.0, 0.3, 1.0, -math.pi / 2, 2.5])
@pytest.mark.parametrize("length_m", [1.1, 1.2, 1.58, 2.0])
def test_what_balances_holds_without_friction_however_the_drawing_is_turned(length_m: float, turn: float) -> None:
    # Drawn from a corner and put over the table's middle: the areas on both sides differ in their last digits.
    there = Isometry.rotation(turn, 0.037, 0.0)
    points = [there.inverse.apply_point(p) for p in rectangle_points(0.2, length_m, -0.1, -length_m / 2)]
    assert (
        stability_violation(spread(points), TableInGarment.seen_from(Pose2(0.037, 0.0, turn), TABLE), 0.0, 0.0) is None
    )


def test_of_two_opposite_edges_only_the_difference_pulls() -> None:
    # 0.3 m on one side, 0.1 on the other, 0.98 lying: it slips below mu = 0.2 / 0.98 = 0.2041.
    cloth = ClothState.spread_out(rectangle(0.3, 1.38, 0.0, -0.79))
    assert why(cloth, friction=0.205) is None
    assert required(why(cloth, friction=0.203)).code == "slips"


def test_folded_layers_weigh_as_much_as_there_are() -> None:
    # Of 0.6 m 0.25 m hang. The far 0.2 m are folded towards the edge, so that their end hangs too.
    cloth = over_near_edge(0.25, 0.35)
    folded = fold_cloth(cloth, Segment((-0.65, 0.2), (-0.65, -0.2)), "blue").cloth
    assert folded.area == pytest.approx(0.24)
    # The flap lies from -0.65 to -0.85: 0.05 m of it hang, in all 0.3 m against 0.3 m.
    assert why(folded) is None
    assert required(why(folded, friction=0.99)).code == "slips"


def test_a_covered_corner_is_no_g_state() -> None:
    found = required(why(ClothState.spread_out(rectangle(0.4, 0.4, -1.0, -0.69))))
    assert found.code == "not_a_g_state" and found.point == pytest.approx((-0.8, -0.49))


def test_a_corner_on_the_rim_of_the_cloth_is_not_covered() -> None:
    assert why(ClothState.spread_out(rectangle(0.6, 0.4, -1.0, -0.49))) is None


def test_a_part_that_hangs_from_two_edges_at_once_is_no_g_state() -> None:
    # A C that leaves the table over the near edge and comes back over the right one, round the free corner.
    points = [(-1, -0.69), (-0.5, -0.69), (-0.5, -0.35), (-0.6, -0.35), (-0.6, -0.6), (-0.9, -0.6)]
    points += [(-0.9, -0.3), (-0.6, -0.3), (-0.6, -0.2), (-1, -0.2)]
    found = required(why(spread(points), friction=9.0))
    assert found.code == "not_a_g_state" and "right and near" in found.message


def test_nothing_on_the_table_is_no_g_state() -> None:
    found = required(why(ClothState.spread_out(rectangle(0.3, 0.3, -1.2, 0.0))))
    assert found.code == "not_a_g_state" and "nothing" in found.message


def test_a_triangle_that_hangs_by_its_base_stays_and_by_its_tip_does_not() -> None:
    by_base = [(-1.0, 0.0), (-0.8, -0.2), (-0.5, -0.2), (-0.5, 0.2), (-0.8, 0.2)]
    assert why(spread(by_base)) is None
    # Its sides lean by 26.6 degrees: 0.1 m to each side for 0.2 m down.
    by_tip = [(-0.4, -0.1), (-0.4, 0.1), (-0.8, 0.1), (-1.0, 0.2), (-1.0, -0.2), (-0.8, -0.1)]
    found = required(why(spread(by_tip)))
    x, y = required(found.point)
    assert found.code == "not_a_g_state" and (x, abs(y)) == pytest.approx((-1.0, 0.2))
    assert why(spread(by_tip), support_deg=26.0) is not None
    assert why(spread(by_tip), support_deg=27.0) is None


def with_hanging_flap(end_x: float, line_x: float) -> ClothState:
    """Return a strip over the near edge whose near end is folded up over a line beside the table."""
    strip = ClothState.spread_out(rectangle(-0.3 - end_x, 0.4, end_x, -0.2))
    return fold_cloth(strip, Segment((line_x, -0.2), (line_x, 0.2)), "blue").cloth


def test_a_flap_that_hangs_from_nothing_but_its_crease_does_not_stay() -> None:
    # Crease 0.2 m below the edge; the flap's end at 0.05 m below the edge reaches up to nothing.
    found = required(why(with_hanging_flap(-1.15, -1.0)))
    x, y = required(found.point)
    assert found.code == "not_a_g_state" and (x, abs(y)) == pytest.approx((-0.85, 0.2))


def test_a_flap_that_reaches_back_onto_the_table_stays() -> None:
    # Crease 0.1 m below the edge; the flap's end 0.1 m onto the table.
    assert why(with_hanging_flap(-1.1, -0.9)) is None


def test_where_the_garment_frame_lies_makes_no_difference() -> None:
    rng = random.Random(10)
    for _ in range(60):
        points = [(x - 0.7, 0.8 * y) for x, y in star(rng, 7)]
        if not Region.polygon(points).shape.is_valid:
            continue
        turn, dx, dy = rng.uniform(-3.0, 3.0), rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0)
        there = Isometry.rotation(turn, dx, dy)
        moved = spread([there.inverse.apply_point(p) for p in points])
        here = why(spread(points), support_deg=5.0)
        seen = stability_violation(moved, TableInGarment.seen_from(Pose2(dx, dy, turn), TABLE), 1.0, math.radians(5.0))
        assert (here and here.code) == (seen and seen.code)


def test_a_mirrored_scene_has_the_mirrored_answer() -> None:
    rng = random.Random(11)
    for _ in range(60):
        points: list[Point2] = [(x - 0.7, y) for x, y in star(rng, 7)]
        if Region.polygon(points).shape.is_valid:
            here, mirrored = why(spread(points)), why(spread([(x, -y) for x, y in points]))
            assert (here and here.code) == (mirrored and mirrored.code)


def test_more_friction_never_makes_cloth_slip() -> None:
    rng = random.Random(12)
    for _ in range(40):
        cloth = spread(rectangle_points(rng.uniform(0.3, 0.9), 0.3, rng.uniform(-1.4, -0.7), -0.1))
        codes = [found and found.code for found in (why(cloth, mu) for mu in (0.1, 0.5, 1.0, 3.0))]
        if "not_a_g_state" not in codes:
            assert codes == sorted(codes, key=lambda code: code is None)
