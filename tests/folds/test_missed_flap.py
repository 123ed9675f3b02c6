"""A red fold takes the flap of the fold before it; a line that misses the flap is refused with that reason."""

import pytest

from planner.errors import FoldError
from planner.folds.fold_sequence import FoldSequence
from tests.builders import fold, garment, rectangle_points

# The last 0.1 m of a towel of 0.4 x 0.3 m go over x = 0.3 and cover 0.2 to 0.3 then.
CUFF = ((0.3, 0.3), (0.3, 0.0))


def test_a_red_line_beside_the_flap_names_the_flap() -> None:
    red = fold((0.1, 0.0), (0.1, 0.3), kind="red")
    with pytest.raises(FoldError) as caught:
        FoldSequence.of(garment(rectangle_points(0.4, 0.3), fold(*CUFF, name="cuff"), red))
    assert caught.value.field == "folds[1].start"
    assert "crosses the cloth, but not the flap of 'cuff'" in caught.value.message


def test_a_red_line_across_the_flap_is_none_of_that() -> None:
    red = fold((0.25, 0.3), (0.25, 0.0), kind="red")
    with pytest.raises(FoldError, match="would tear"):  # what is right of it hangs on the crease
        FoldSequence.of(garment(rectangle_points(0.4, 0.3), fold(*CUFF), red))
    sequence = FoldSequence.of(
        garment(rectangle_points(0.4, 0.3), fold(*CUFF), fold((0.25, 0.0), (0.25, 0.3), kind="red"))
    )
    assert [found.is_red for found in sequence.folds] == [False, True]
