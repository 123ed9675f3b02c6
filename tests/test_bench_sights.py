"""The table of landmarks in rendered pictures, from sights whose figures are known."""

import math

import pytest

from bench.sights import row_of
from bench.stack_sights import Sighted, overhead_bench


def sighted(*off_m: float, doubt: str | None = None, told_m: float = 0.01) -> Sighted:
    return Sighted("towel", 1, doubt, off_m, (told_m,) * len(off_m), 0.1, 0.5)


def test_landmarks_count_where_the_place_of_the_stack_is_told_as_known() -> None:
    row = row_of("kind", [sighted(0.002, 0.004), sighted(0.006, 0.03), sighted(0.5, doubt="hidden")])
    assert (row.data["pictures"], row.data["known"]) == (3, 2)
    # Of .002, .004, .006 and .03 m three are within a centimetre; the told centimetre covers the first stack alone.
    assert (row.data["near"], row.data["covers"], row.data["worst_m"]) == (0.75, 0.5, 0.03)


def test_a_landmark_that_is_told_to_be_unsure_is_not_told_as_known() -> None:
    row = row_of("kind", [sighted(0.002, 0.004), sighted(0.05, told_m=0.06)])
    assert (row.data["landmarks"], row.data["landmarks_known"]) == (3, 2)
    assert (row.data["near"], row.data["covers"]) == (1.0, 1.0)


def test_where_nothing_is_known_no_landmark_is_told() -> None:
    row = row_of("kind", [sighted(doubt="hidden")])
    assert row.data["near"] is None
    assert row.lines[0][4] == "-"


@pytest.mark.long
def test_a_sight_tells_every_landmark_and_how_far_off_it_may_be() -> None:
    seen = overhead_bench().sight(0, is_plain=True, has_arm=False)
    assert len(seen.told_m) == len(seen.off_m)
    assert seen.doubt is not None or (
        0.0 < max(seen.off_m) < math.inf and max(seen.told_m) == pytest.approx(0.0, abs=0.1)
    )
