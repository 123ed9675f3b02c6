"""Where the base is while hands are empty."""

import numpy as np
import pytest

from planner.geometry.pose import Pose2
from planner.geometry.table import Table, TableTop
from planner.motion.timed_phase import TimedPhase, TransitTime
from planner.task.trajectory import ClothMotion, Phase

STATION, BACK, TURNED = Pose2(-0.95, 0.0, 3.0), Pose2(-1.15, 0.1, 3.0), Pose2(-1.15, 0.1, -3.0)
STILL = ClothMotion(0, Pose2(0.0, 0.0, 0.0), Pose2(0.0, 0.0, 0.0), TableTop.of(Table()))


def test_the_base_goes_evenly_through_one_phase_after_the_other_and_turns_the_short_way() -> None:
    legs = [
        Phase(seconds, ends, (None, None), STILL) for seconds, ends in ((2.0, (STATION, BACK)), (4.0, (BACK, TURNED)))
    ]
    free = TransitTime([TimedPhase.even(0, leg, leg.duration_s) for leg in legs], None)  # type: ignore[arg-type]
    assert (free.last, free.end_s) == (TURNED, 6.0)
    short = 2.0 * np.pi - 6.0
    expected = [
        (-0.95, 0.0, 3.0),
        (-1.05, 0.05, 3.0),
        (-1.15, 0.1, 3.0),
        (-1.15, 0.1, 3.0 + 0.25 * short),
        (-1.15, 0.1, 3.0 + short),
    ]
    np.testing.assert_allclose(free.bases_at(np.array([0.0, 1.0, 2.0, 3.0, 6.0])), expected, atol=1e-12)
    assert free.bases_at(np.array([2.0]))[0] == pytest.approx([-1.15, 0.1, 3.0])
