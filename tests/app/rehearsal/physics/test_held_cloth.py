"""How fingers hold cloth, and how it turns over with them."""

import math
from dataclasses import replace

import numpy as np
import pytest

from app.rehearsal.physics.hand_way import HandWay
from app.rehearsal.physics.held_cloth import HeldCloth
from app.rehearsal.physics.pinch import PAD_M, clamped, fingertip, nearest_weights, pinched
from app.rehearsal.world import GripMotion
from planner.folds.fold_path import REST_HEIGHT_M
from planner.geometry.table import Table, TableTop

TOP = TableTop.of(Table())


def held(between: tuple[float, float, float], beside: tuple[float, float, float]) -> HeldCloth:
    return HeldCloth((7,), np.array([between]), np.array([beside]))


def fold(turned_rad: tuple[float, ...] = ()) -> GripMotion:
    """A hand that brings the tip from x = 10 cm over the apex to x = -10 cm."""
    points = tuple((x, 0.0, z + REST_HEIGHT_M) for x, z in ((0.1, 0.0), (0.0, 0.1), (-0.1, 0.0)))
    return GripMotion("left", (0.0, 1.0, 2.0), points, turned_rad=turned_rad)


def test_cloth_beside_the_fingers_lies_on_their_other_side_after_a_fold() -> None:
    # 1.5 cm inwards of the tip before the fold, as far inwards of it afterwards: the fold's mirror image.
    way = HandWay(fold(), held((0.0, 0.0, 0.0), (-0.015, 0.004, 0.0)), is_fold=True, top=TOP)
    assert way.at(0.0)[7] == pytest.approx([0.085, 0.004, 0.0])
    assert way.at(1.0)[7] == pytest.approx([0.0, 0.004, 0.1 - 0.015])
    assert way.at(2.0)[7] == pytest.approx([-0.085, 0.004, 0.0])


def test_cloth_between_the_fingers_turns_over_only_with_a_hand_that_rolls() -> None:
    between = held((-0.01, 0.0, 0.001), (0.0, 0.0, 0.0))
    still = HandWay(fold(), between, is_fold=True, top=TOP)
    rolls = HandWay(fold((0.0, math.pi / 2.0, math.pi)), between, is_fold=True, top=TOP)
    assert still.at(2.0)[7] == pytest.approx([-0.11, 0.0, 0.001])
    assert rolls.at(2.0)[7] == pytest.approx([-0.09, 0.0, -0.001])


def test_cloth_turns_over_round_the_ends_of_fingers_that_point_along_the_way_and_do_not_roll() -> None:
    # Fingers point from x = 10 cm to x = -10 cm and end PAD_M ahead of their tip: what is beyond lies under them then.
    along = replace(fold(), heading_rad=math.pi)
    for ahead, after in ((-0.005, -0.005), (-0.5 * PAD_M, -0.5 * PAD_M), (-0.02, 0.02 - 2.0 * PAD_M)):
        way = HandWay(along, held((0.0, 0.0, 0.0), (ahead, 0.004, 0.0)), is_fold=True, top=TOP)
        assert way.at(0.0)[7] == pytest.approx([0.1 + ahead, 0.004, 0.0])
        assert way.at(2.0)[7] == pytest.approx([-0.1 + after, 0.004, 0.0], abs=1e-9)


def test_nothing_turns_over_in_a_drag() -> None:
    way = HandWay(fold(), held((0.0, 0.0, 0.0), (-0.015, 0.0, 0.0)), is_fold=False, top=TOP)
    assert way.at(2.0)[7] == pytest.approx([-0.115, 0.0, 0.0])


def test_cloth_that_hung_beside_the_table_turns_over_by_a_quarter_more() -> None:
    # It hangs up to the edge from the fingers; laid down it leads back towards the edge.
    x = -Table().depth_m / 2.0
    points = ((x - 0.03, 0.0, -0.1), (x, 0.0, 0.1), (x + 0.1, 0.0, 0.02))
    hung = replace(held((0.0, 0.0, 0.0), (0.0, 0.0, 0.01)), hangs=True)
    way = HandWay(GripMotion("left", (0.0, 1.0, 2.0), points), hung, is_fold=True, top=TOP)
    assert way.at(2.0)[7] - fingertip(np.array(points[-1])) == pytest.approx([-0.01, 0.0, 0.0])
    assert not way.held_at(2.0).hangs


def test_cloth_taken_on_the_table_turns_over_by_half_a_turn_wherever_it_was_dragged_before() -> None:
    # The tie's folds begin beyond the table's edge, where drags end: its creases were turned by a quarter too far.
    x = -Table().depth_m / 2.0
    points = ((x - 0.1, 0.0, 0.02), (x + 0.1, 0.0, 0.2), (x + 0.3, 0.0, 0.02))
    way = HandWay(
        GripMotion("left", (0.0, 1.0, 2.0), points), held((0.0, 0.0, 0.0), (0.015, 0.0, 0.0)), is_fold=True, top=TOP
    )
    assert way.at(2.0)[7] - fingertip(np.array(points[-1])) == pytest.approx([-0.015, 0.0, 0.0])


def test_the_lowest_cloth_in_a_hand_is_laid_on_the_stack_and_stays_as_high_if_the_hand_holds_on() -> None:
    layers = HeldCloth((1, 2), np.array([[0.0, 0.0, 0.001], [0.0, 0.0, 0.003]]), np.zeros((2, 3)))
    way = HandWay(fold(), layers, is_fold=True, top=TOP).landing_on(0.009)
    assert way.at(0.0)[1] == pytest.approx([0.1, 0.0, 0.001])
    assert way.at(1.0)[1] == pytest.approx([0.0, 0.0, 0.101])
    assert way.at(2.0)[1] == pytest.approx([-0.1, 0.0, 0.009])
    assert way.held_at(2.0).lowest_m == pytest.approx(0.009)
    assert HandWay(fold(), layers, is_fold=True, top=TOP).landing_on(0.0).rise_m == 0.0


def test_fingers_close_a_loop_and_leave_layers_that_lie_on_one_another_as_they_are() -> None:
    loop = HeldCloth(
        (1, 2), np.array([[0.0, 0.0, 0.001], [0.0, 0.0, 0.015]]), np.array([[0.0] * 3, [0.0, 0.01, 0.006]])
    )
    half, closed = (loop.pressed(0.002, share).at(np.zeros(3)) for share in (0.5, 1.0))
    assert (half[1][2], half[2][2]) == pytest.approx((0.001, 0.012))
    assert closed[1] == pytest.approx([0.0, 0.0, 0.001])
    assert closed[2] == pytest.approx([0.0, 0.01, 0.003])
    layers = HeldCloth((1, 2, 3), np.array([[0.0, 0.0, z] for z in (0.001, 0.003, 0.005)]), np.zeros((3, 3)))
    assert layers.pressed(0.002).between == pytest.approx(layers.between)


def test_a_hand_that_holds_on_keeps_a_finger_between_its_cloth_and_the_stack() -> None:
    way = HandWay(replace(fold(), opens=False), held((0.0, 0.0, 0.001), (0.0, 0.0, 0.0)), is_fold=True, top=TOP)
    assert way.landing_on(0.009).at(2.0)[7][2] == pytest.approx(0.009 + way.under_m)


def test_a_vertex_is_held_as_far_beside_the_fingers_as_it_is() -> None:
    # One triangle whose edge passes under the tip, 2 cm from either of its ends: the vertex nearest to it is held.
    positions = np.array([[0.0, 0.02, 0.001], [0.0, -0.021, 0.001], [0.03, 0.0, 0.001]])
    found = pinched(positions, np.array([[0, 1, 2]]), np.array([0.0, 0.0, REST_HEIGHT_M]), TOP, 0.03)
    assert list(found) == [0]
    assert found[0] == pytest.approx([0.0, 0.0, 0.001])
    cloth = HeldCloth.of(found, positions, np.zeros(3))
    assert cloth.between == pytest.approx(np.array([[0.0, 0.0, 0.001]]))
    assert cloth.beside == pytest.approx(np.array([[0.0, 0.02, 0.0]]))


def test_of_several_triangles_at_a_vertex_the_one_nearest_to_the_fingers_tells_where_they_are() -> None:
    positions = np.array([[0.0, 0.0, 0.0], [0.02, 0.0, 0.0], [0.02, 0.02, 0.0], [0.0, -0.02, 0.0], [0.02, -0.02, 0.0]])
    triangles = np.array([[0, 3, 4], [0, 1, 2]])
    found = pinched(positions, triangles, np.array([0.008, 0.004, REST_HEIGHT_M]), TOP, 0.03)
    assert found[0] == pytest.approx([0.008, 0.004, 0.0])


def test_fingers_hold_a_sheet_at_one_line_and_each_sheet_at_its_own() -> None:
    # Two strips of two triangles on one another, of which the tip touches the first triangle, and only the lower
    # strip reaches the tip: all that is held of a strip turns about where that comes nearest to the fingers.
    strip = np.array([[0.0, -0.01, 0.001], [0.0, 0.01, 0.001], [0.02, -0.01, 0.001], [0.02, 0.01, 0.001]])
    positions = np.concatenate([strip, strip + np.array([0.006, 0.0, 0.002])])
    triangles = np.array([[0, 2, 1], [1, 2, 3], [4, 6, 5], [5, 6, 7]])
    found = pinched(positions, triangles, np.array([0.001, -0.002, REST_HEIGHT_M]), TOP, 0.03)
    assert {vertex // 4 for vertex in found} == {0, 1}
    for vertex, point in found.items():
        assert point == pytest.approx([0.001, -0.002, 0.001] if vertex < 4 else [0.006, -0.002, 0.003])


def test_fingers_take_as_many_sheets_from_the_top_down_as_they_should() -> None:
    # Three strips on one another, the edge of each 6 mm further in than that of the one below.
    strip = np.array([[0.0, -0.01, 0.001], [0.0, 0.01, 0.001], [0.02, -0.01, 0.001], [0.02, 0.01, 0.001]])
    positions = np.concatenate([strip + number * np.array([0.006, 0.0, 0.002]) for number in range(3)])
    triangles = np.concatenate([np.array([[0, 2, 1], [1, 2, 3]]) + 4 * number for number in range(3)])
    tool = np.array([0.005, 0.0, REST_HEIGHT_M])

    def taken(layers: int | None) -> set[int]:
        return {vertex // 4 for vertex in pinched(positions, triangles, tool, TOP, 0.03, layers)}

    assert [taken(layers) for layers in (1, 2, 3, 4, None)] == [{2}, {1, 2}, {0, 1, 2}, {0, 1, 2}, {0, 1, 2}]
    beyond = np.array([-0.015, 0.0, REST_HEIGHT_M])  # from here fingers reach no more than the two lower ones
    assert {vertex // 4 for vertex in pinched(positions, triangles, beyond, TOP, 0.03, 1)} == {1}


def test_the_two_sheets_that_meet_at_a_crease_are_each_held_at_their_own_height() -> None:
    # Held at one line they would change places as they turn about it, and the other layers of the stack would not: a
    # layer beside such a crease was pushed out of the stack by 5 cm in a T-shirt's last fold.
    rows = ((0.0, 0.003), (-0.02, 0.001), (-0.02, 0.005))
    positions = np.array([[x, y, z] for x, z in rows for y in (-0.01, 0.01)])
    triangles = np.array([[0, 1, 2], [1, 3, 2], [0, 4, 1], [1, 4, 5]])
    found = pinched(positions, triangles, np.array([-0.015, 0.0, REST_HEIGHT_M]), TOP, 0.03)
    heights = {vertex // 2: round(float(point[2]), 6) for vertex, point in found.items()}
    assert heights == {1: 0.0015, 2: 0.0045}


@pytest.mark.parametrize(("way", "second"), [((1.0, 0.0), 2), ((0.0, -1.0), 1)])
def test_fingers_hold_two_vertices_across_their_way_so_that_cloth_does_not_turn_in_them(
    way: tuple[float, float], second: int
) -> None:
    # Of a square that is held by its first corner the one after it lies along x, the other along y.
    positions = np.array([[0.0, 0.0, 0.0], [0.02, 0.0, 0.0], [0.0, 0.02, 0.0], [0.02, 0.02, 0.0]])
    triangles, point, tip = np.array([[0, 1, 2], [1, 3, 2]]), np.array([0.001, 0.002, 0.0]), np.zeros(3)
    taken = clamped({0: point}, positions, triangles, tip, np.array(way))
    assert list(taken) == [0, second]
    assert taken[second] == pytest.approx(point)
    assert clamped(taken, positions, triangles, tip, np.array(way)).keys() == taken.keys()


def test_at_a_crease_fingers_hold_a_vertex_beside_it_in_each_of_the_two_sheets() -> None:
    # A crease at x = 0 and a row of each sheet behind it, the upper one 2 mm further back: with its lower sheet alone
    # held, the upper one slid out of the hand by as much as it liked.
    rows = ((0.0, 0.003), (-0.02, 0.001), (-0.022, 0.005))
    positions = np.array([[x, y, z] for x, z in rows for y in (0.0, 0.02)])
    triangles = np.array([[0, 1, 2], [1, 3, 2], [0, 4, 1], [1, 4, 5]])
    point, tip, way = np.array([-0.001, 0.0, 0.003]), np.array([0.004, 0.0, 0.0]), np.array([0.0, 1.0])
    taken = clamped({0: point}, positions, triangles, tip, way)
    assert sorted(taken) == [0, 2, 4]
    assert clamped({0: point, 4: point}, positions, triangles, tip, way).keys() == taken.keys()
    flat = positions * np.array([1.0, 1.0, 0.0])
    flat[4:, 0] *= -1.0
    assert len(clamped({0: point}, flat, triangles, tip, way)) == 2


@pytest.mark.parametrize(
    ("point", "wanted"),
    [
        ((0.2, 0.2), (0.6, 0.2, 0.2)),
        ((0.5, -0.5), (0.5, 0.5, 0.0)),
        ((1.0, 1.0), (0.0, 0.5, 0.5)),
        ((-3.0, -4.0), (1.0, 0.0, 0.0)),
    ],
)
def test_the_weights_of_a_triangle_are_those_of_its_nearest_point(
    point: tuple[float, ...], wanted: tuple[float, ...]
) -> None:
    triangle = np.array([[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]])
    assert nearest_weights(triangle, np.array(point))[0] == pytest.approx(wanted)


def test_layers_between_fingers_are_as_high_as_they_are_many() -> None:
    layers = HeldCloth((1, 2, 3), np.array([[0.0, 0.0, z] for z in (0.001, 0.003, 0.015)]), np.zeros((3, 3)))
    assert layers.stack_m(0.002) == pytest.approx(0.006)
    beside = HeldCloth((1, 2), np.array([[0.0, 0.0, 0.001]] * 2), np.array([[0.0] * 3, [0.01, 0.0, 0.0005]]))
    assert beside.stack_m(0.002) == pytest.approx(0.002)


def test_a_hand_with_a_finger_under_its_cloth_lays_it_down_as_much_higher() -> None:
    way = HandWay(replace(fold(), heading_rad=0.0), held((0.0, 0.0, 0.001), (0.0, 0.0, 0.0)), True, TOP, 0.012)
    assert way.landing_on(0.009).at(2.0)[7][2] == pytest.approx(0.009 + 0.012)
