"""How high tools rest at a stack: over the table, and over what lies there."""

from dataclasses import replace

import numpy as np
import pytest

from planner.cloth.garment import Garment
from planner.folds.fold_path import FoldPath, rest_height_m
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.pose import Pose2
from planner.geometry.segment import Segment
from planner.geometry.table import Table, TableTop
from tests.builders import fold, garment, rectangle_points

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
