"""The simulation against hand calculations."""

import math
from dataclasses import replace

import numpy as np
import pytest

from app.rehearsal.physics.bending import angle_over_sine, bent_rad, moments_rad
from app.rehearsal.physics.fabric import Fabric, Resolution
from app.rehearsal.physics.pinch import clamped, pinched
from app.rehearsal.physics.simulation import ClothSimulation
from planner.geometry.table import Table, TableTop
from planner.geometry.woven_mesh import woven_mesh
from tests.builders import rectangle

G = 9.81

LIGHT = Fabric(density_kg_m2=0.14, thickness_m=0.0004)
"""A cloth whose layers are near to each other, with stiffer contacts."""


def lying(length_m: float, width_m: float, fabric: Fabric, edge_m: float, x_m: float = 0.0) -> ClothSimulation:
    points, triangles = woven_mesh(rectangle(length_m, width_m, x_m), edge_m)
    rest = np.column_stack([points, np.full(len(points), fabric.layer_m / 2.0)])
    return ClothSimulation(rest, points, triangles, fabric, Resolution(edge_m, 0.004), Table())


@pytest.mark.parametrize("fabric", [Fabric(), LIGHT])
def test_cloth_that_lies_stays_where_it_is(fabric: Fabric) -> None:
    cloth = lying(0.2, 0.2, fabric, 0.04)
    before = cloth.positions
    cloth.run(1.0)
    assert np.abs(cloth.positions - before).max() < 1e-4


@pytest.mark.parametrize("fabric", [Fabric(), LIGHT])
@pytest.mark.parametrize("friction", [0.3, 0.6])
def test_sliding_cloth_stops_after_the_way_of_a_block(fabric: Fabric, friction: float) -> None:
    # v^2 / (2 mu g); the air is left out.
    cloth, speed = lying(0.12, 0.12, replace(fabric, friction=friction, drag_per_s=0.0), 0.04), 0.5
    cloth.push(np.array([speed, 0.0, 0.0]))
    before = cloth.positions
    cloth.run(1.0)
    way = (cloth.positions - before)[:, 0].mean()
    assert way == pytest.approx(speed**2 / (2.0 * friction * G), rel=0.05)


@pytest.mark.parametrize("bias_rad", [0.0, math.pi / 4.0])
def test_hung_cloth_stretches_by_its_weight_along_its_threads_and_more_across(bias_rad: float) -> None:
    # The end of a strip that hangs by its edge sinks by w L^2 / (2 K). Pulled at 45 degrees to threads that do not
    # contract, it grows by both threads' stretch and by shear: 4 / K is 2 / stretch + 1 / shear.
    fabric, length = Fabric(stretch_n_m=100.0, push_n_m=100.0, shear_n_m=20.0), 0.3
    stiffness = fabric.stretch_n_m if bias_rad == 0.0 else 4.0 / (2.0 / fabric.stretch_n_m + 1.0 / fabric.shear_n_m)
    points, triangles = woven_mesh(rectangle(0.04, length), 0.02)
    rest = np.column_stack([points[:, 0], np.zeros(len(points)), points[:, 1]])
    turned = points @ np.array([[math.cos(bias_rad), math.sin(bias_rad)], [-math.sin(bias_rad), math.cos(bias_rad)]])
    upright = ClothSimulation(rest, turned, triangles, fabric, Resolution(0.02, 0.004))
    top = np.flatnonzero(points[:, 1] > length - 1e-6)
    upright.hold({int(i): rest[i] for i in top})
    upright.run(2.0)
    sunk = (rest - upright.positions)[points[:, 1] < 1e-6, 2].mean()
    assert sunk == pytest.approx(fabric.density_kg_m2 * G * length**2 / (2.0 * stiffness), rel=0.1)


def test_a_panel_that_stands_gives_way_to_its_weight_where_a_hung_one_hardly_stretches() -> None:
    # Upright, held by its lower or its upper edge, and too stiff to topple: the free edge sinks by w L^2 / (2 K), with
    # the stiffness of threads that are pushed together, or of threads that are pulled.
    fabric, length = Fabric(push_n_m=10.0, bending_length_m=0.1), 0.1
    points, triangles = woven_mesh(rectangle(0.04, length), 0.02)
    rest = np.column_stack([points[:, 0], np.zeros(len(points)), points[:, 1]])
    lower, upper = points[:, 1] < 1e-6, points[:, 1] > length - 1e-6
    sunk = []
    for held, free in ((lower, upper), (upper, lower)):
        panel = ClothSimulation(rest, points, triangles, fabric, Resolution())
        panel.hold({int(i): rest[i] for i in np.flatnonzero(held)})
        panel.run(1.0)
        sunk.append(float((rest - panel.positions)[free, 2].mean()))
    assert sunk[0] == pytest.approx(fabric.density_kg_m2 * G * length**2 / (2.0 * 10.0), rel=0.05)
    assert 0.0 < sunk[1] < 0.02 * sunk[0]


def test_threads_pushed_together_give_way_before_they_bear_what_buckles_a_row() -> None:
    # Euler: a row of width 1 m and the bending stiffness B buckles under pi^2 B over its length squared, and bears no
    # more however far it is pushed. Layers that bore ten times as much stood over creases as folded plates.
    fabric, row_m = Fabric(), Resolution().edge_m
    buckles_n_m = math.pi**2 * fabric.bend_nm / row_m**2
    assert 0.1 * fabric.pushed_n_m(row_m) < buckles_n_m < 0.25 * fabric.pushed_n_m(row_m)
    assert fabric.pushed_n_m(row_m / 2.0) == pytest.approx(4.0 * fabric.pushed_n_m(row_m))


def test_cloth_over_an_edge_droops_as_a_cantilever_of_its_bending_length() -> None:
    # Peirce (1930): where a strip of length l hangs over an edge and the line to its end is theta below the horizontal,
    # its bending length is l (cos(theta / 2) / (8 tan(theta)))^(1/3): half of l at 41.5 degrees.
    bending, edge = 0.03, 0.005
    fabric = Fabric(bending_length_m=bending, bend_friction_per_m=0.0, drag_per_s=5.0)
    points, triangles = woven_mesh(rectangle(2.0 * bending + 2.0 * edge, 2.0 * edge), edge)
    rest = np.column_stack([points, np.zeros(len(points))])
    cloth = ClothSimulation(rest, points, triangles, fabric, Resolution(edge, 0.004))
    clamped = np.flatnonzero(points[:, 0] < 2.0 * edge)
    cloth.hold({int(i): rest[i] for i in clamped})
    cloth.run(1.5)
    start, end = points[clamped, 0].max(), points[:, 0].max()
    tip = cloth.positions[points[:, 0] > end - 1e-6].mean(axis=0)
    drooped = math.atan2(-tip[2], tip[0] - start)
    length = (end - start) * (math.cos(drooped / 2.0) / (8.0 * math.tan(drooped))) ** (1.0 / 3.0)
    assert length == pytest.approx(bending, rel=0.1)


def test_the_loop_at_a_fold_is_as_high_as_an_elastica_makes_it() -> None:
    # A strip that lies on itself leaves the table without curvature and comes to lie without. Between is a loop of the
    # heavy elastica: without thickness and tension, as a boundary value problem, .907 bending lengths high.
    bending, half, edge, duration = 0.03, 0.15, 0.01, 2.0
    fabric = Fabric(bending_length_m=bending, bend_friction_per_m=0.0)
    cloth = lying(2.0 * half, 2.0 * edge, fabric, edge, -half)
    flat = cloth.positions
    end = np.flatnonzero(flat[:, 0] > half - 1e-6)
    for left in np.arange(half, -half, -2.0 * half / duration * cloth.step_s):
        up = fabric.layer_m + half - abs(left)
        cloth.hold({int(i): np.array([left, flat[i, 1], up]) for i in end})
        cloth.step()
    cloth.release(frozenset(end.tolist()))
    cloth.run(1.0)
    places = cloth.positions
    loop = places[:, 2].max() - fabric.layer_m / 2.0
    assert loop == pytest.approx(0.907 * bending, rel=0.15)
    assert np.abs(places[:, 0] + np.abs(flat[:, 0])).mean() < 0.005


def test_an_edge_doubled_back_at_a_row_springs_open_under_its_own_weight() -> None:
    # At the rows' distance of a bending length. Doubled back the edge's weight bends the row w L^2 / 2; cloth bent by
    # nearly half a turn over that length resists about six times as much.
    edge = 0.018
    cloth = lying(0.2, 0.04, Fabric(), edge, 0.0)
    places, end = cloth.positions, cloth.positions[:, 0].max()
    row = np.unique(np.round(places[:, 0], 6))[-3]
    beyond = np.maximum(places[:, 0] - row, 0.0)
    slope = math.radians(20.0)
    places[:, 0] -= beyond * (1.0 + math.cos(slope))
    places[:, 2] += beyond * math.sin(slope) + Fabric().layer_m * (beyond > 0.0)
    assert 0.015 < beyond.max() < 0.036
    cloth.put(places)
    cloth.run(1.0)
    assert cloth.positions[:, 0].max() == pytest.approx(end, abs=0.005)


@pytest.mark.parametrize("angle_rad", [0.01, 1.0, 2.0, 2.9])
def test_the_moment_at_a_hinge_grows_as_its_angle(angle_rad: float) -> None:
    corners = np.array([[[0, 0, 0], [0, 1, 0], [-1, 0, 0], [math.cos(angle_rad), 0.3, math.sin(angle_rad)]]])
    assert bent_rad(corners) == pytest.approx([angle_rad], abs=1e-6)
    assert angle_over_sine(bent_rad(corners)) * math.sin(angle_rad) == pytest.approx([angle_rad], abs=1e-6)


def test_bent_on_and_back_a_hinge_resists_by_its_friction_more_and_less_than_its_stiffness() -> None:
    friction, slid = np.array([0.5]), np.array([0.0])
    told = {}
    for way, angles in (("on", np.arange(0.0, 2.5, 0.01)), ("back", np.arange(2.5, 0.0, -0.01))):
        for angle in angles:
            moment, slid = moments_rad(np.array([angle]), slid, friction)
            told[way, round(float(angle), 2)] = float(moment[0])
    for angle in (0.7, 1.2, 1.9):
        assert told["on", angle] - angle == pytest.approx(0.5)
        assert angle - told["back", angle] == pytest.approx(0.5)
    assert told["on", 2.49] > told["back", 2.45] > 1.95  # it turns over within two thirds of the friction
    assert told["back", 0.3] == 0.0


def opened_m(friction_per_m: float) -> float:
    """Return how far the end of a narrow strip, laid down folded in half, slides back (m)."""
    half, edge, duration = 0.05, 0.012, 1.0
    fabric = Fabric(bend_friction_per_m=friction_per_m, self_friction=0.1)
    cloth = lying(2.0 * half, 0.03, fabric, edge, -half)
    flat = cloth.positions
    end = np.flatnonzero(flat[:, 0] > half - 1e-6)
    for left in np.arange(half, -half, -2.0 * half / duration * cloth.step_s):
        cloth.hold({int(i): np.array([left, flat[i, 1], fabric.layer_m + half - abs(left)]) for i in end})
        cloth.step()
    laid = float(cloth.positions[end, 0].mean())
    cloth.release(frozenset(end.tolist()))
    cloth.run(1.0)
    return float(cloth.positions[end, 0].mean()) - laid


def test_a_crease_whose_threads_rub_pushes_a_light_end_back_less() -> None:
    free_m = opened_m(0.0)
    assert free_m > 0.005
    assert opened_m(Fabric().bend_friction_per_m) < 0.6 * free_m


def test_a_crease_folded_flat_rolls_on_when_the_upper_layer_is_pulled() -> None:
    # The upper layer is pulled by 3 cm, so the crease rolls by 1.5 cm, over a row of the mesh. The lower layer, twice
    # as long, is held by friction of .6 times the weight of both; the upper one drags it with .5 times its own at most.
    fabric, edge, pulled_m, duration = Fabric(friction=0.6), 0.02, 0.03, 0.5
    cloth = lying(0.3, 0.04, fabric, edge, -0.2)
    places = cloth.positions
    crease = float(places[np.abs(places[:, 0]).argmin(), 0])
    is_over = places[:, 0] > crease + 1e-6
    places[is_over, 0] = 2.0 * crease - places[is_over, 0]
    places[is_over, 2] += fabric.layer_m
    cloth.put(places)
    end, still = np.flatnonzero(is_over & (places[:, 0] < places[is_over, 0].min() + 1e-6)), places[:, 0] < -0.15
    for share in np.arange(0.0, 1.0, cloth.step_s / duration):
        cloth.hold({int(i): places[i] - np.array([pulled_m * share, 0.0, 0.0]) for i in end})
        cloth.step()
    assert np.abs(cloth.positions - places)[still].max() < 0.002
    assert cloth.positions[:, 0].max() == pytest.approx(crease - pulled_m / 2.0, abs=0.007)


def test_cloth_held_by_its_edge_beside_its_middle_hangs_level_and_does_not_turn_in_the_fingers() -> None:
    # An upright strip, 10 cm long, is held 3 cm from one end. Free to turn it would hang with its middle below.
    points, triangles = woven_mesh(rectangle(0.1, 0.04), 0.02)
    rest = np.column_stack([points[:, 0], np.zeros(len(points)), points[:, 1]])
    tip = np.array([0.03, 0.0, 0.04])
    nearest = int(np.linalg.norm(rest - tip, axis=1).argmin())
    sunk = {}
    for is_clamped in (False, True):
        strip = ClothSimulation(rest, points, triangles, Fabric(), Resolution())
        found = {nearest: rest[nearest]}
        taken = clamped(found, rest, triangles, tip, np.array([0.0, 1.0])) if is_clamped else found
        strip.hold({vertex: rest[vertex] for vertex in taken})
        strip.run(1.0)
        sunk[is_clamped] = float((rest - strip.positions)[points[:, 0] > 0.1 - 1e-6, 2].mean())
    assert sunk[False] > 0.03
    assert abs(sunk[True]) < 0.005


def test_fingers_pinch_all_layers_at_their_place_and_nothing_beside_the_cloth() -> None:
    points, triangles = woven_mesh(rectangle(0.1, 0.1), 0.02)
    count, top = len(points), TableTop.of(Table())
    stack = np.concatenate([np.column_stack([points, np.full(count, z)]) for z in (0.001, 0.003)])
    both = np.concatenate([triangles, triangles + count])
    at_corner = pinched(stack, both, np.array([0.0, 0.0, 0.02]), top, 0.03)
    apart = np.hypot(stack[:, 0], stack[:, 1])
    assert set(np.flatnonzero(apart < 1e-6).tolist()) <= at_corner.keys()
    assert {number + count for number in at_corner if number < count} == {n for n in at_corner if n >= count}
    assert apart[list(at_corner)].max() < 0.02  # the nearest vertex of a triangle that the pad touches
    assert not pinched(stack, both, np.array([-0.03, 0.05, 0.02]), top, 0.03)
