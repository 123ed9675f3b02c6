import pytest

from app.rehearsal.vision.fit_fold import FoldedOutline, fit_fold
from planner import load_garment
from planner.folds.fold_sequence import replayed
from planner.geometry.pose import Pose2
from tests.app.rehearsal.vision.outlines_seen import most_off, seen

PLACEMENT = Pose2(0.05, -0.1, -1.2)
NEAR = Pose2(0.065, -0.09, -1.15)


@pytest.mark.parametrize("name", ["t-shirt", "jeans", "letter-towel"])
def test_with_the_crease_on_its_line_the_outline_is_that_of_the_planned_stack(name: str) -> None:
    sequence = replayed(load_garment(name))
    for index in range(len(sequence.folds)):
        done = (1 << index) - 1
        planned = sequence.folded(done, index).cloth.silhouette
        redone = FoldedOutline(sequence, done, index).region(0.0, 0.0)
        assert redone.difference(planned).area + planned.difference(redone).area < 1e-8


@pytest.mark.parametrize(
    ("name", "index"),
    [
        pytest.param("t-shirt", 2, marks=pytest.mark.long),
        ("jeans", 1),
        pytest.param("shirt", 4, marks=pytest.mark.long),
    ],
)
def test_a_crease_beside_its_line_is_measured(name: str, index: int) -> None:
    sequence = replayed(load_garment(name))
    done = (1 << index) - 1
    actual = FoldedOutline(sequence, done, index).region(0.016, 0.0)
    fit = fit_fold(seen(actual, PLACEMENT), sequence, done, index, NEAR)
    assert fit.stack.is_known
    assert fit.offset_m == pytest.approx(0.016, abs=0.003)
    assert fit.off_m == pytest.approx(0.032, abs=0.006)
    assert most_off(actual, fit.stack.placement, PLACEMENT) < 0.006


def test_where_halved_cloth_may_stick_out_on_either_side_the_error_covers_both() -> None:
    sequence = replayed(load_garment("hand-towel"))
    actual = FoldedOutline(sequence, 0, 0).region(0.02, 0.0)
    fit = fit_fold(seen(actual, PLACEMENT), sequence, 0, 0)
    assert abs(fit.offset_m) == pytest.approx(0.02, abs=0.003)
    assert fit.offset_error_m > 0.035
    assert not fit.stack.is_known
