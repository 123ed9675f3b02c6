"""The cases of the paper's Figures 1 and 4, worked out by hand.

Figure 1: which vertices of a hanging part must be held, and so which shapes may hang by themselves. Down is -y here,
the table's edge is y = 0. Figure 4: folds of a hanging part, and what stays afterwards. There the frame is the
table's, whose near edge is x = -0.8; a towel 0.4 m wide lies over it with 0.3 m hanging and 0.5 m lying.
"""

import math
from collections.abc import Sequence

import numpy as np
import pytest

from planner.cloth.cloth_state import ClothState
from planner.cloth.g_state import StabilityViolation, TableInGarment, stability_violation
from planner.cloth.must_hold import must_hold
from planner.folds.fold_cloth import fold_cloth
from planner.geometry.isometry import Isometry
from planner.geometry.pose import Point2, Pose2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.table import Table
from planner.primitives.fold_obstacles import geometric_obstacle
from planner.primitives.state import State
from planner.task.reason import Code
from tests.builders import context, fold, garment, rectangle
from tests.required import required

TABLE = Table(1.6, 0.98, 0.79)
UP = (0.0, 1.0)
EDGE = Segment((-5.0, 0.0), (5.0, 0.0))


def loose(hanging: Sequence[Point2], support_deg: float = 0.0) -> set[Point2]:
    """Return the vertices of a hanging part that must be held and are not on the edge."""
    found = must_hold(Region.polygon(hanging), UP, (EDGE,), math.radians(support_deg))
    return {(round(float(x), 4), round(float(y), 4)) for x, y in found}


def on_table(hanging: Sequence[Point2]) -> ClothState:
    """Return a cloth with a hanging part of this shape over the table's near edge; 0.5 m of it lie."""
    top = [x for x, y in hanging if y == 0.0]
    below = Region.polygon([(y - 0.8, -x) for x, y in hanging])
    return ClothState.spread_out(Region.union([below, rectangle(0.5, max(top) - min(top), -0.8, -max(top))]))


def why(cloth: ClothState, support_deg: float = 0.0) -> StabilityViolation | None:
    return stability_violation(
        cloth, TableInGarment.seen_from(Pose2(0.0, 0.0, 0.0), TABLE), 1.0, math.radians(support_deg)
    )


# Each shape hangs from y = 0, is named by what it looks like, and has its loose vertices with it.
STAYS: dict[str, list[Point2]] = {
    # Straight sides: above each lower corner the side itself leads up.
    "rectangle": [(0, 0), (0, -0.3), (0.4, -0.3), (0.4, 0)],
    # The tip is below the middle, all of the triangle is above it.
    "triangle on its tip": [(0, 0), (0.2, -0.3), (0.4, 0)],
    "trapezoid that narrows": [(0, 0), (0.1, -0.3), (0.3, -0.3), (0.4, 0)],
    # The notch's vertex (0.2, -0.1) has cloth above it, and is none of the hull's.
    "two points with a notch between": [(0, 0), (0.1, -0.3), (0.2, -0.1), (0.3, -0.3), (0.4, 0)],
    # Two legs: above their inner corners (0.15, -0.3) and (0.25, -0.3) the leg goes up as well.
    "two legs": [(0, 0), (0, -0.3), (0.15, -0.3), (0.15, -0.1), (0.25, -0.1), (0.25, -0.3), (0.4, -0.3), (0.4, 0)],
}
FALLS: dict[str, tuple[list[Point2], set[Point2]]] = {
    "triangle by its tip, a trapezoid that widens": (
        [(0.15, 0), (0, -0.3), (0.4, -0.3), (0.25, 0)],
        {(0, -0.3), (0.4, -0.3)},
    ),
    # The left lower corner hangs beside all the cloth above it, the right one below it.
    "parallelogram": ([(0.2, 0), (0, -0.3), (0.2, -0.3), (0.4, 0)], {(0, -0.3)}),
    # The bar's upper corners have nothing above them. Its lower ones are below its upper ones.
    "bar on a stem": (
        [(0.15, 0), (0.15, -0.2), (0, -0.2), (0, -0.3), (0.4, -0.3), (0.4, -0.2), (0.25, -0.2), (0.25, 0)],
        {(0, -0.2), (0.4, -0.2)},
    ),
    # A sleeve that droops to the right: straight above its upper corner there is nothing, nor above the one at its end.
    "sleeve": (
        [(0, 0), (0, -0.3), (0.2, -0.3), (0.2, -0.2), (0.4, -0.25), (0.35, -0.1), (0.2, 0)],
        {(0.35, -0.1), (0.4, -0.25)},
    ),
    # A waist: below it the sides lead outwards again, though no further than they were above it.
    "waist": ([(0, 0), (0.1, -0.15), (0, -0.3), (0.4, -0.3), (0.3, -0.15), (0.4, 0)], {(0, -0.3), (0.4, -0.3)}),
    # A hook: its point is on the hull, outside what is above.
    "hook": ([(0, 0), (0, -0.3), (0.4, -0.3), (0.4, -0.1), (0.3, -0.2), (0.1, -0.2), (0.1, 0)], {(0.4, -0.1)}),
}


@pytest.mark.parametrize("name", STAYS)
def test_a_shape_with_cloth_above_all_its_convex_vertices_hangs_by_itself(name: str) -> None:
    assert loose(STAYS[name]) == set()
    assert why(on_table(STAYS[name])) is None


@pytest.mark.parametrize("name", FALLS)
def test_a_shape_with_a_convex_vertex_under_nothing_does_not(name: str) -> None:
    shape, wanted = FALLS[name]
    assert loose(shape) == {(float(x), float(y)) for x, y in wanted}
    found = why(on_table(shape))
    assert found is not None and found.code == "not_a_g_state"
    # Below (x, 0) of the edge is (-0.8, -x) of the table.
    assert any(found.point == pytest.approx((y - 0.8, -x)) for x, y in wanted)


@pytest.mark.parametrize("name", FALLS)
def test_held_where_it_must_be_it_hangs_as_well(name: str) -> None:
    # A grip is to a hanging part what the edge is: give the loose vertices to the baseline.
    shape, wanted = FALLS[name]
    grips = tuple(Segment(vertex, (vertex[0], vertex[1] - 1e-6)) for vertex in wanted)
    assert len(must_hold(Region.polygon(shape), UP, (EDGE, *grips), 0.0)) == 0


def test_a_turned_square_may_hang_by_one_corner_and_not_by_three() -> None:
    # A square of 0.5 m turned by 30 degrees, its lowest corner at the origin: its sides go up at 30 and 120
    # degrees. The next corners are at 0.5 (cos 30, sin 30) = (0.433, 0.25) and 0.5 (-sin 30, cos 30) = (-0.25,
    # 0.433).
    c, s = 0.5 * math.cos(math.radians(30.0)), 0.5 * math.sin(math.radians(30.0))
    square = Region.polygon([(0, 0), (c, s), (c - s, s + c), (-s, c)])
    for depth, wanted in ((0.2, set()), (0.3, {(0.433, -0.05)}), (0.5, {(0.433, -0.25), (-0.25, -0.067)})):
        lowered = square.moved(Isometry.rotation(0.0, 0.0, -depth))
        hanging = lowered.parted_by(EDGE)[1]
        found = must_hold(hanging, UP, (EDGE,), 0.0)
        assert {(round(float(x), 3), round(float(y), 3)) for x, y in found} == wanted


def test_a_disc_may_hang_by_less_than_half_of_it() -> None:
    # Below its middle the rim leads inwards on its way down: something is above each of its vertices. Above the
    # middle it leads outwards.
    angles = np.linspace(0.0, math.tau, 72, endpoint=False)
    disc = Region.polygon(np.column_stack([0.3 * np.cos(angles), 0.3 * np.sin(angles)]))
    for middle_m, stays in ((0.1, True), (0.02, True), (-0.1, False)):
        hanging = disc.moved(Isometry.rotation(0.0, 0.0, middle_m)).parted_by(EDGE)[1]
        assert (len(must_hold(hanging, UP, (EDGE,), 0.0)) == 0) == stays


def test_only_convex_vertices_count_so_a_tongue_under_a_slit_counts_as_held() -> None:
    # A slit from the side, 0.2 m deep and 0.02 m high. The lip under it, (0.0, -0.12), has nothing above it; it lies on
    # the hull's side, not at a vertex of it. As soon as it sticks out it must be held.
    slit = [(0, 0), (0, -0.1), (0.2, -0.1), (0.2, -0.12), (0, -0.12), (0, -0.3), (0.4, -0.3), (0.4, 0)]
    assert loose(slit) == set()
    sticking_out = [(x - 0.01 if (x, y) == (0, -0.12) else x, y) for x, y in slit]
    assert loose(sticking_out) == {(-0.01, -0.12)}


# Figure 4. The towel: 0.3 m hang, x from -1.1 to -0.8, and 0.5 m lie.
TOWEL = ClothState.spread_out(rectangle(0.8, 0.4, -1.1, -0.2))


def folded(start: Point2, end: Point2) -> ClothState:
    return fold_cloth(TOWEL, Segment(start, end), "blue").cloth


def hanging_and_lying_m2(cloth: ClothState) -> tuple[float, float]:
    table = Region.polygon(TABLE.corners)
    lying = sum(layer.region.intersection(table).area for layer in cloth.layers)
    return cloth.area - lying, lying


def test_a_fold_across_the_edge_stays_on_either_side_of_it() -> None:
    # The right half over the line y = 0: two layers, each straight down from the edge.
    cloth = folded((-1.1, 0.0), (-0.3, 0.0))
    assert hanging_and_lying_m2(cloth) == pytest.approx((0.12, 0.2))
    assert why(cloth) is None


def test_a_corner_folded_up_onto_the_table_stays() -> None:
    # The lower left corner, (-1.1, 0.2), over the line from the lower right one to (-0.7, 0.2), which is y = x + 0.9:
    # it lands at (-0.7, -0.2). The flap's hanging part is the triangle (-0.8, 0.1) (-1.1, -0.2) (-0.8, -0.2): it hangs
    # from the edge, and its lowest vertex is straight below the edge. So is the layer under it: 2 x 0.045 m^2.
    cloth = folded((-1.1, -0.2), (-0.7, 0.2))
    hanging, _ = hanging_and_lying_m2(cloth)
    assert hanging == pytest.approx(2 * 0.3 * 0.3 / 2)
    assert why(cloth) is None


def test_a_fold_along_the_edge_that_brings_all_of_it_back_stays() -> None:
    # Over x = -0.75: from -1.1 to -0.4. What hung, 0.3 m, and 0.05 m more lie on the table now.
    cloth = folded((-0.75, -0.2), (-0.75, 0.2))
    assert hanging_and_lying_m2(cloth) == pytest.approx((0.0, 0.32))
    assert why(cloth) is None


def test_a_fold_along_the_edge_whose_flap_hangs_from_its_crease_alone_does_not_stay() -> None:
    # Over x = -1.0: the last 0.1 m come to lie against the cloth above, from -1.0 to -0.9, 0.1 m short of the edge. Up
    # from the flap there is nothing: its upper corners are loose.
    found = why(folded((-1.0, -0.2), (-1.0, 0.2)))
    assert found is not None and found.point is not None and found.code == "not_a_g_state"
    assert (found.point[0], abs(found.point[1])) == pytest.approx((-0.9, 0.2))


def test_it_stays_once_the_flap_is_long_enough_to_reach_the_table() -> None:
    # Over x = -0.96 the end at -1.1 comes to -0.82, over x = -0.94 to -0.78.
    assert required(why(folded((-0.96, -0.2), (-0.96, 0.2)))).code == "not_a_g_state"
    assert why(folded((-0.94, -0.2), (-0.94, 0.2))) is None


def test_not_quite_along_the_edge_it_does_not_stay_either() -> None:
    # The line leans by 0.02 m over the towel's width. The flap still ends short of the edge.
    assert required(why(folded((-1.01, -0.2), (-0.99, 0.2)))).code == "not_a_g_state"


def test_the_figures_two_folds_are_told_apart_when_planning() -> None:
    # The towel in its own frame, y away from the robot; at yaw -90 degrees garment (x, y) is at table (y - 1.1,
    # 0.2 - x).
    outline = [(0.0, 0.0), (0.4, 0.0), (0.4, 0.8), (0.0, 0.8)]
    start, placement = State(0, (0.0, 0.0), 0, 0), Pose2(-1.1, 0.2, -math.pi / 2)
    across, along, short = (
        context(garment(outline, line, placement=placement))
        for line in (fold((0.2, 0.0), (0.2, 0.8)), fold((0.4, 0.35), (0.0, 0.35)), fold((0.4, 0.1), (0.0, 0.1)))
    )
    assert geometric_obstacle(across, start, 0) is None
    assert geometric_obstacle(along, start, 0) is None
    # Its line is at x = -1.0, beside the table: refused as such, before asking what would become of the flap.
    refused = geometric_obstacle(short, start, 0)
    assert refused is not None and refused.code is Code.LINE_OFF_TABLE
