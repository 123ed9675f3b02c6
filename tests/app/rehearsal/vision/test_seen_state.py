import pytest

from app.rehearsal.vision.fit_fold import FoldedOutline
from app.rehearsal.vision.seen_state import state_of
from app.rehearsal.vision.stack_fit import FoldFit
from planner import load_garment
from planner.folds.fold_sequence import replayed
from planner.geometry.pose import Pose2
from tests.app.rehearsal.vision.outlines_seen import seen

PLACEMENT = Pose2(0.05, -0.1, -1.2)


def test_which_fold_was_done_last_is_told_and_how_far_off_it_is() -> None:
    sequence = replayed(load_garment("jeans"))
    actual = FoldedOutline(sequence, 0b1, 1).region(0.016, 0.0)
    found, unknown = state_of(seen(actual, PLACEMENT), sequence)
    assert unknown is None
    assert (found.done, found.last) == (0b11, 1)
    assert isinstance(found.fit, FoldFit)
    assert found.fit.offset_m == pytest.approx(0.016, abs=0.004)


@pytest.mark.long
def test_what_is_none_of_the_states_is_not_known() -> None:
    sequence = replayed(load_garment("tie"))
    _, unknown = state_of(seen(load_garment("vest").pattern, PLACEMENT), sequence)
    assert unknown is not None and unknown.code == "seen_does_not_fit"
