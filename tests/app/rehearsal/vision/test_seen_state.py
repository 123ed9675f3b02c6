import numpy as np
import pytest

from app.rehearsal.vision.fit_fold import FoldedOutline
from app.rehearsal.vision.neatness import Neatness
from app.rehearsal.vision.seen_state import state_of
from app.rehearsal.vision.stack_fit import FoldFit
from planner import load_garment
from planner.folds.fold_sequence import replayed
from planner.geometry.pose import Pose2
from planner.geometry.region import Region
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


def test_a_stacks_neatness_is_how_far_it_is_off_turned_and_skewed() -> None:
    packet = replayed(load_garment("letter-towel")).final.silhouette
    ought = Pose2(0.1, 0.0, -1.3)
    neat = Neatness.of(seen(packet, PLACEMENT), packet, PLACEMENT, None)
    assert neat.iou > 0.95 and neat.edge_error_m < 0.003 and abs(neat.skewed_rad) < 0.02
    assert neat.turned_rad is None and "degrees." in neat.text
    shear = np.array([[1.0, 0.1], [0.0, 1.0]])
    skewed = Region.polygon((packet.ring - packet.ring.mean(axis=0)) @ shear.T + packet.ring.mean(axis=0))
    askew = Neatness.of(seen(skewed, PLACEMENT), packet, PLACEMENT, ought)
    assert askew.skewed_rad == pytest.approx(0.1, abs=0.02)
    assert askew.iou < neat.iou - 0.02 and askew.edge_error_m > neat.edge_error_m
    assert askew.turned_rad == pytest.approx(PLACEMENT.yaw_rad - ought.yaw_rad)
    assert "turned by 5.7 degrees" in askew.text
