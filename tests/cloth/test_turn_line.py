"""Lines about which cloth is turned over: along its edge, all cloth to their left."""

import pytest

from planner.cloth.turn_line import is_turn, nearest_turn, snapped_turn
from planner.errors import FoldError
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from tests.builders import rectangle

TOWEL = rectangle(0.4, 0.3)
SHIRT = Region.polygon([(0.1, 0.0), (0.3, 0.0), (0.3, 0.2), (0.4, 0.2), (0.4, 0.3), (0.0, 0.3), (0.0, 0.2), (0.1, 0.2)])
"""A body of .2 x .2 m with sleeves: a T."""

TROUSERS = Region.polygon([(0.0, 0.0), (0.1, 0.0), (0.2, 0.3), (0.3, 0.0), (0.4, 0.0), (0.4, 0.5), (0.0, 0.5)])
"""Two legs, each with a hem of .1 m."""


@pytest.mark.parametrize("off_m", [0.0, 0.004, -0.004])
def test_a_line_near_an_edge_becomes_the_whole_edge(off_m: float) -> None:
    # Drawn along the middle of the edge, a little outside of it or inside: the corners are its ends.
    line = snapped_turn((0.1, off_m), (0.3, off_m), TOWEL)
    assert (line.start, line.end) == ((0.0, 0.0), (0.4, 0.0))
    assert is_turn(line, TOWEL)


def test_hems_that_lie_on_one_line_are_turned_about_together() -> None:
    line = snapped_turn((0.0, 0.0), (0.1, 0.0), TROUSERS)
    assert (line.start, line.end) == ((0.0, 0.0), (0.4, 0.0))


def test_a_line_over_a_bay_touches_the_cloth_at_the_bays_corners_alone() -> None:
    # From the hem's corner (.1, 0) to the sleeve's (0, .2): all cloth is to the left of that line turned round.
    with pytest.raises(FoldError) as refused:
        snapped_turn((0.0, 0.2), (0.1, 0.0), SHIRT)
    assert (refused.value.field, refused.value.says and refused.value.says.code) == ("end", "turn_touches_little")


@pytest.mark.parametrize(
    ("start", "end", "code"),
    [
        ((0.0, 0.1), (0.4, 0.1), "turn_off_edge"),  # through the cloth
        ((0.0, -0.1), (0.4, -0.1), "turn_off_edge"),  # 10 cm beside it
        ((0.4, 0.0), (0.0, 0.0), "turn_off_edge"),  # along the edge, but the cloth is to its right
        ((-0.1, 0.1), (0.1, -0.1), "turn_touches_little"),  # about a corner the cloth would swing
    ],
)
def test_a_line_that_is_no_edge_to_turn_about_is_refused(start: Point2, end: Point2, code: str) -> None:
    with pytest.raises(FoldError) as refused:
        snapped_turn(start, end, TOWEL)
    assert refused.value.says is not None
    assert refused.value.says.code == code


def test_cloth_beyond_a_line_is_measured() -> None:
    with pytest.raises(FoldError) as refused:
        snapped_turn((0.0, 0.1), (0.4, 0.1), TOWEL)
    assert refused.value.says is not None
    assert refused.value.says.values == {"off_m": pytest.approx(0.1), "most_m": 0.005}


def test_a_line_drawn_anywhere_means_the_edge_beside_it_whichever_way_it_runs() -> None:
    for guide in (Segment((0.3, 0.05), (0.1, 0.02)), Segment((0.1, 0.05), (0.3, 0.02))):
        line = nearest_turn(TOWEL, guide)
        assert line is not None
        assert (line.start, line.end) == ((0.0, 0.0), (0.4, 0.0))
