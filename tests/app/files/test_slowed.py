"""A plan's motion at a share of its speed."""

import numpy as np
import pytest

from app.files.slowed import slowed
from planner import Plan
from planner.motion.motion_values import accelerations_at, positions_at, velocities_at
from planner.planning.plan_check import require_replay
from tests.small_plan import small_plan, unsolved

SPEED = 0.4


@pytest.fixture(scope="module")
def slow() -> Plan:
    return slowed(small_plan(), SPEED)


def test_the_path_stays_and_times_velocities_and_accelerations_scale(slow: Plan) -> None:
    quick = small_plan()
    assert slow.trajectory is not None and quick.trajectory is not None and quick.cost_s is not None
    assert slow.cost_s == pytest.approx(quick.cost_s / SPEED)
    times_s = np.linspace(0.001, quick.cost_s - 0.001, 97)
    for values, power in ((positions_at, 0), (velocities_at, 1)):
        np.testing.assert_allclose(
            values(slow.trajectory, times_s / SPEED), values(quick.trajectory, times_s) * SPEED**power, atol=1e-9
        )
    np.testing.assert_allclose(
        accelerations_at(slow.trajectory, times_s / SPEED, slow.trajectory.duration_s),
        accelerations_at(quick.trajectory, times_s, quick.cost_s) * SPEED**2,
        atol=1e-9,
    )


def test_a_slowed_plan_replays_like_any_other(slow: Plan) -> None:
    again = Plan.from_dict(slow.to_dict())
    assert again == slow
    require_replay(again)


def test_at_full_speed_or_without_a_motion_a_plan_stays_as_it_is() -> None:
    assert slowed(small_plan(), 1.0) is small_plan()
    assert slowed(unsolved(), SPEED) == unsolved()
