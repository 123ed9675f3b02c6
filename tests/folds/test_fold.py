"""Drawn lines are snapped onto the silhouette's boundary, or refused with their distance from it."""

import pytest

from planner.errors import FoldError
from planner.folds.fold import snapped_line
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from tests.builders import fold, garment, rectangle, rectangle_points

TOWEL = rectangle(0.4, 0.3)


def refusal(start: Point2, end: Point2, silhouette: Region = TOWEL) -> tuple[str, str]:
    with pytest.raises(FoldError) as caught:
        snapped_line(fold(start, end), silhouette)
    return caught.value.field, caught.value.message


def test_ends_on_the_boundary_stay_where_they_are() -> None:
    line = snapped_line(fold((0.1, 0.0), (0.1, 0.3)), TOWEL)
    assert line.start == pytest.approx((0.1, 0.0)) and line.end == pytest.approx((0.1, 0.3))


def test_an_end_a_few_micrometres_off_is_on_the_boundary_and_stays_exactly_where_it_is() -> None:
    line = snapped_line(fold((0.1, 4e-6), (0.1000001, 0.299995)), TOWEL)
    assert line == Segment((0.1, 4e-6), (0.1000001, 0.299995))


@pytest.mark.parametrize("off", [0.0049, -0.0049])
def test_ends_less_than_five_millimetres_off_are_put_onto_the_boundary(off: float) -> None:
    line = snapped_line(fold((0.1, off), (0.1, 0.3 + off)), TOWEL)
    assert line.start == pytest.approx((0.1, 0.0))
    assert line.end == pytest.approx((0.1, 0.3))


def test_an_end_further_off_is_refused_with_the_distance() -> None:
    field, message = refusal((0.1, 0.0), (0.1, 0.3052))
    assert field == "end" and "is 5.2 mm from the silhouette's boundary" in message
    field, message = refusal((0.1, 0.1), (0.1, 0.3))
    assert field == "start" and "100.0 mm" in message


def test_a_line_that_leaves_the_cloth_between_its_ends_is_refused() -> None:
    ell = Region.polygon([(0.0, 0.0), (0.4, 0.0), (0.4, 0.2), (0.2, 0.2), (0.2, 0.4), (0.0, 0.4)])
    assert refusal((0.4, 0.1), (0.1, 0.4), ell) == ("end", "the line between its ends leaves the silhouette")


def test_a_line_whose_ends_fall_together_is_refused() -> None:
    assert "nearly the same point" in refusal((0.1, 0.003), (0.102, -0.003))[1]


def test_the_error_of_a_sequence_names_the_fold_and_its_end() -> None:
    cloth = garment(rectangle_points(0.4, 0.3), fold((0.4, 0.1), (0.0, 0.1)), fold((0.1, 0.0), (0.1, 0.3)))
    with pytest.raises(FoldError) as caught:
        FoldSequence.of(cloth)
    # After the first fold the cloth below y = 0.1 has gone up: the silhouette begins there.
    assert caught.value.field == "folds[1].start"
    assert "100.0 mm" in caught.value.message


def test_a_later_fold_is_snapped_to_the_silhouette_of_its_turn() -> None:
    cloth = garment(rectangle_points(0.4, 0.3), fold((0.4, 0.1), (0.0, 0.1)), fold((0.1, 0.098), (0.1, 0.302)))
    line = FoldSequence.of(cloth).folds[1].line
    assert line.start == pytest.approx((0.1, 0.1)) and line.end == pytest.approx((0.1, 0.3))
