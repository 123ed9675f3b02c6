"""The path of grips in a fold: up along (b, d - b) to the apex, down along (-b, d - b); how high tools rest."""

import math
import random
from dataclasses import replace

import numpy as np
import pytest

from planner.cloth.garment import Garment
from planner.folds.fold_path import REST_HEIGHT_M, SPACING_M, FoldPath, rest_height_m
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.segment import Segment
from planner.geometry.table import Table, TableTop
from tests.builders import fold, garment, rectangle_points

TOP = TableTop.of(Table(1.6, 0.98, 0.79))
# Across the middle of the table; what lies at larger x (its left) moves.
ACROSS = Segment((0.0, 0.3), (0.0, -0.3))


def path(line: Segment = ACROSS, depth_m: float = 0.4, rising_top: TableTop = TOP, clear_m: float = 0.0) -> FoldPath:
    return FoldPath(line, depth_m, TOP, rising_top, clear_m)


def tools(of: FoldPath, *grips: tuple[float, float], sweeps: int = 401) -> FloatArray:
    """Return the tools' paths, shape (grips, sweeps, 3)."""
    return of.tool_paths(np.array(grips), np.linspace(0.0, 2.0, sweeps))


def test_a_tool_begins_and_ends_at_its_rest_height_at_mirrored_places() -> None:
    way = tools(path(), (0.4, 0.1))[0]
    assert way[0] == pytest.approx([0.4, 0.1, REST_HEIGHT_M])
    assert way[-1] == pytest.approx([-0.4, 0.1, REST_HEIGHT_M])


def test_the_apex_is_over_the_line_as_high_as_the_grip_is_far() -> None:
    for distance in (0.4, 0.25):
        apex = path().tool_points(np.array([[distance, 0.1]]), 1.0)[0]
        assert apex == pytest.approx([0.0, 0.1, distance + REST_HEIGHT_M])


def test_a_grip_nearer_than_the_farthest_point_rests_until_the_baseline_comes() -> None:
    # D = 0.4, d = 0.3: the baseline is there at a quarter of the way up, and is back there three quarters down.
    of, grip = path(), np.array([[0.3, 0.0]])
    assert of.tool_points(grip, 0.2)[0] == pytest.approx([0.3, 0.0, REST_HEIGHT_M])
    assert of.tool_points(grip, 0.25)[0] == pytest.approx([0.3, 0.0, REST_HEIGHT_M])
    # b = 0.2 at sweep 0.5: (0.2, 0.1).
    assert of.tool_points(grip, 0.5)[0] == pytest.approx([0.2, 0.0, 0.1 + REST_HEIGHT_M])
    assert of.tool_points(grip, 1.5)[0] == pytest.approx([-0.2, 0.0, 0.1 + REST_HEIGHT_M])
    assert of.tool_points(grip, 1.75)[0] == pytest.approx([-0.3, 0.0, REST_HEIGHT_M])


def test_two_grips_keep_their_distance_along_the_cloth() -> None:
    # One behind the other: along the cloth, once round the baseline, they stay 0.15 m apart.
    of = path()
    for sweep in np.linspace(0.0, 2.0, 41):
        (ax, _, az), (bx, _, bz) = of.swept(np.array([[0.4, 0.0], [0.25, 0.0]]), float(sweep))
        assert abs(ax - bx) + abs(az - bz) == pytest.approx(0.15)


def test_two_grips_side_by_side_stay_as_far_apart_throughout() -> None:
    ways = tools(path(), (0.4, 0.2), (0.4, -0.2))
    assert np.hypot(*np.moveaxis(ways[0] - ways[1], 1, 0)[:2]) == pytest.approx(np.full(401, 0.4))


def test_everything_stands_or_lies_at_every_moment() -> None:
    points = np.array([[x, 0.0] for x in np.linspace(0.0, 0.4, 21)])
    for sweep in np.linspace(0.0, 2.0, 21):
        swept = path().swept(points, float(sweep))
        lies = np.abs(swept[:, 2]) < 1e-9
        baseline = 0.4 * abs(1.0 - sweep) * (1 if sweep <= 1.0 else -1)
        assert np.all(lies | (np.abs(swept[:, 0] - baseline) < 1e-9))


def test_a_way_over_the_table_has_no_jumps() -> None:
    way = tools(path(), (0.4, 0.1))[0]
    steps = np.linalg.norm(np.diff(way, axis=0), axis=1)
    # The baseline goes 0.4 / 200 m a step, the tool sqrt(2) times as far.
    assert steps == pytest.approx(np.full(400, math.sqrt(2.0) * 0.002))


# A line 0.1 m inside the near edge (x = -0.8) and along it; what lies nearer, and hangs, moves.
NEAR = Segment((-0.7, -0.2), (-0.7, 0.2))


def test_a_hanging_grip_rises_at_the_edge_from_as_deep_as_it_hangs_to_as_high() -> None:
    # d = 0.25, so it hangs h = 0.15 below the edge. While the baseline comes from 0.25 to 0.1 it rises to +0.15.
    way = path(NEAR, 0.25)
    grip = np.array([[-0.95, 0.0]])
    assert way.tool_points(grip, 0.0)[0] == pytest.approx([-0.8, 0.0, -0.15 + REST_HEIGHT_M])
    assert way.tool_points(grip, 0.6)[0] == pytest.approx([-0.8, 0.0, 0.15 + REST_HEIGHT_M])
    for sweep in np.linspace(0.0, 0.6, 13):
        x, _, z = way.tool_points(grip, float(sweep))[0]
        assert x == pytest.approx(-0.8)
        assert z == pytest.approx(-0.15 + 0.5 * sweep + REST_HEIGHT_M)
    assert way.tool_points(grip, 1.0)[0] == pytest.approx([-0.7, 0.0, 0.25 + REST_HEIGHT_M])


def test_a_hanging_grip_is_held_clear_of_the_edge_until_it_is_above_the_top() -> None:
    # h = 0.15 as before. Beyond the edge by less than 0.02 m, where the tool is level with the top at rest, it comes to
    # the edge's plane: at b = 0.11 it is still 0.01 m beyond, so half of 0.03 m outside, and 0.14 - 0.01 m high.
    way, grip = path(NEAR, 0.25, clear_m=0.03), np.array([[-0.95, 0.0]])
    assert way.tool_points(grip, 0.0)[0] == pytest.approx([-0.83, 0.0, -0.15 + REST_HEIGHT_M])
    assert way.tool_points(grip, 0.52)[0] == pytest.approx([-0.83, 0.0, 0.11 + REST_HEIGHT_M])
    assert way.tool_points(grip, 0.56)[0] == pytest.approx([-0.815, 0.0, 0.13 + REST_HEIGHT_M])
    assert way.tool_points(grip, 0.6)[0] == pytest.approx([-0.8, 0.0, 0.15 + REST_HEIGHT_M])
    assert way.tool_points(grip, 1.0)[0] == pytest.approx([-0.7, 0.0, 0.25 + REST_HEIGHT_M])


def test_a_place_beyond_an_edge_is_clear_of_it_too() -> None:
    way = path(NEAR.reversed, 0.3, clear_m=0.03)
    assert way.tool_points(np.array([[-0.4, 0.0]]), 2.0)[0] == pytest.approx([-0.83, 0.0, -0.2 + REST_HEIGHT_M])


def test_a_grip_that_lands_beyond_an_edge_sinks_to_its_depth() -> None:
    # The far part comes over the line to 0.3 m on its other side: 0.2 m beyond the edge.
    way = path(NEAR.reversed, 0.3)
    assert way.tool_points(np.array([[-0.4, 0.0]]), 2.0)[0] == pytest.approx([-0.8, 0.0, -0.2 + REST_HEIGHT_M])


def test_cloth_held_out_beyond_an_edge_starts_there_and_not_hanging() -> None:
    grip = np.array([[-0.95, 0.0]])
    held = path(NEAR, 0.25, TOP.open_towards(grip))
    assert held.tool_points(grip, 0.0)[0] == pytest.approx([-0.95, 0.0, REST_HEIGHT_M])
    assert held.tool_points(grip, 0.4)[0] == pytest.approx([-0.85, 0.0, 0.1 + REST_HEIGHT_M])
    assert held.tool_points(grip, 1.0)[0] == pytest.approx([-0.7, 0.0, 0.25 + REST_HEIGHT_M])


def longest_step(of: FoldPath, grip: tuple[float, float]) -> float:
    return float(np.linalg.norm(np.diff(tools(of, grip, sweeps=4001)[0], axis=0), axis=1).max())


@pytest.mark.parametrize("clear_m", [0.0, 0.03])
def test_no_way_jumps_wherever_line_and_grips_lie(clear_m: float) -> None:
    rng = random.Random(15)
    for _ in range(200):
        x, y, angle = rng.uniform(-0.7, 0.7), rng.uniform(-0.4, 0.4), rng.uniform(0.0, math.tau)
        line = Segment((x, y), (x + 0.3 * math.cos(angle), y + 0.3 * math.sin(angle)))
        depth, along = rng.uniform(0.05, 0.5), rng.uniform(0.0, 0.3)
        (nx, ny), (ax, ay) = line.left, line.at(along)
        of = path(line, depth, clear_m=clear_m)
        grip = (ax + depth * nx, ay + depth * ny)
        # At the edge a tool goes twice as far as the baseline. Where it is to clear it, it goes outwards too while the
        # baseline goes 0.02 m, or as far as the grip hangs at either end if that is less.
        deep = [0.02, *(d for d in TOP.beyond(of.swept(np.array([grip]), np.array([[0.0], [2.0]]))).ravel() if d > 0.0)]
        steepest = math.hypot(2.0, clear_m / min(deep))
        assert longest_step(of, grip) < steepest * depth / 2000 + 1e-9


def test_a_grip_held_out_beside_its_line_cannot_be_folded_without_a_jump() -> None:
    # The line runs across the near edge, and the grip was dragged out 0.05 m beyond it: a narrow strip that is
    # pulled a little off the table and folded lengthwise while it is held. Its apex would hang beyond the edge.
    line = Segment((-0.85, 0.0), (-0.6, 0.0))
    beyond, over_table = np.array([(-0.85, 0.1)]), np.array([(-0.7, 0.1)])
    assert not path(line, 0.1, TOP.open_towards(beyond)).is_continuous(beyond)
    assert path(line, 0.1, TOP.open_towards(beyond)).is_continuous(over_table)
    assert path(line, 0.1, TOP).is_continuous(beyond)


def test_the_farthest_grip_is_moved_from_the_very_beginning_to_the_very_end_whatever_was_rounded() -> None:
    line = Segment((-0.61, 0.3), (-0.61, -0.4))
    for aside in np.linspace(-3e-6, 3e-6, 61):
        sweeps = path(line, depth_m=0.05).sweeps(np.array([[-0.56 + aside, 0.1]]))
        assert sweeps[0] == 0.0 and sweeps[-1] == 2.0


def test_waypoints_are_at_most_five_centimetres_apart_and_hold_the_apex_and_both_ends() -> None:
    rng = random.Random(16)
    for _ in range(200):
        x, y, angle = rng.uniform(-0.7, 0.7), rng.uniform(-0.4, 0.4), rng.uniform(0.0, math.tau)
        line = Segment((x, y), (x + 0.3 * math.cos(angle), y + 0.3 * math.sin(angle)))
        depth = rng.uniform(0.05, 0.7)
        grips = []
        for distance, along in ((depth * rng.uniform(0.5, 1.0), 0.0), (depth * rng.uniform(0.5, 1.0), 0.3)):
            (nx, ny), (ax, ay) = line.left, line.at(along)
            grips.append((ax + distance * nx, ay + distance * ny))
        of, points = path(line, depth, clear_m=rng.choice((0.0, 0.03))), np.array(grips)
        sweeps = of.sweeps(points)
        assert np.all(np.diff(sweeps) > 0.0)
        assert np.abs(sweeps - 1.0).min() < 1e-12
        assert sweeps == pytest.approx((2.0 - sweeps)[::-1])
        ways = of.tool_paths(points, sweeps)
        assert np.linalg.norm(np.diff(ways, axis=1), axis=2).max() <= SPACING_M + 1e-9
        assert ways[:, 0] == pytest.approx(of.tool_points(points, 0.0))
        assert ways[:, -1] == pytest.approx(of.tool_points(points, 2.0))


FLEECE_M = 0.005


def towel(thickness_m: float) -> Garment:
    """A towel folded in half, its far half onto the near one, and then into a quarter."""
    halves = fold((0.0, 0.15), (0.4, 0.15)), fold((0.2, 0.0), (0.2, 0.15))
    return replace(garment(rectangle_points(0.4, 0.3), *halves), thickness_m=thickness_m)


# Two layers of fleece are 10 mm high, and a finger 12 mm over that.
@pytest.mark.parametrize(("stack_m", "height_m"), [(0.0, 0.02), (0.008, 0.02), (0.01, 0.022), (0.02, 0.032)])
def test_tools_rest_over_the_table_or_a_finger_over_the_stack(stack_m: float, height_m: float) -> None:
    assert rest_height_m(stack_m) == pytest.approx(height_m)


def test_heights_count_the_layers_at_each_place() -> None:
    sequence = FoldSequence.of(towel(FLEECE_M))
    # Once folded the cloth lies from y = 0 to .15, two layers; twice, from x = .2 to .4, four.
    assert sequence.rests(0b00).at(np.array([[0.0, 0.3]])) == pytest.approx([0.02])
    assert sequence.rests(0b01).at(np.array([[0.0, 0.0], [0.4, 0.15]])) == pytest.approx([0.022, 0.022])
    assert sequence.rests(0b11).at(np.array([[0.4, 0.0], [0.1, 0.1]])) == pytest.approx([0.032, 0.02])


def test_a_tool_goes_from_where_it_takes_its_stack_to_where_it_lays_it_down() -> None:
    sequence, top = FoldSequence.of(towel(FLEECE_M)), TableTop.of(Table())
    line = sequence.folds[1].line
    grip = np.array([[0.0, 0.0]])
    of = FoldPath(line, 0.2, top, top, placement=Pose2(0.0, 0.0, 0.0), stacks=sequence.rests_of(1))
    start, apex, end = of.tool_paths(grip, np.array([0.0, 1.0, 2.0]))[0]
    assert start == pytest.approx([0.0, 0.0, 0.022])
    assert apex == pytest.approx([0.2, 0.0, 0.2 + 0.027])
    assert end == pytest.approx([0.4, 0.0, 0.032])


@pytest.mark.parametrize("thickness_m", [0.0001, 0.001, 0.002])
def test_four_layers_of_thin_cloth_change_nothing(thickness_m: float) -> None:
    sequence = FoldSequence.of(towel(thickness_m))
    assert [sequence.rests_of(index) for index in range(2)] == [None, None]
    assert sequence.rests(0b11).raised_m == 0.0


def test_a_path_of_thin_cloth_rests_at_one_height() -> None:
    top = TableTop.of(Table())
    of = FoldPath(Segment((0.2, 0.0), (0.2, 0.15)), 0.2, top, top)
    ends = of.tool_paths(np.array([[0.0, 0.0]]), np.array([0.0, 2.0]))[0]
    assert ends[:, 2] == pytest.approx([0.02, 0.02])
