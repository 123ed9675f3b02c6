"""Even ways from rest to rest."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import CubicHermiteSpline

from planner.geometry.keyframes import least_s, ramps

WAYS, LIMITS = st.floats(1e-4, 10.0), st.floats(0.05, 20.0)


def test_a_long_way_speeds_up_goes_on_and_slows_down() -> None:
    # 1 m at 0.25 m/s and 0.5 m/s2: half a second and 6.25 cm each to speed up and to slow down.
    assert least_s(1.0, 0.25, 0.5) == pytest.approx(4.5)
    run = ramps(4.5, 1.0, 0.25, 0.5)
    assert run.times_s == pytest.approx((0.0, 0.5, 4.0, 4.5))
    assert run.fractions == pytest.approx((0.0, 0.0625, 0.9375, 1.0))
    assert run.rates == pytest.approx((0.0, 0.25, 0.25, 0.0))


def test_a_short_way_never_comes_to_top_speed() -> None:
    # 5 cm at 0.5 m/s2: to the middle in sqrt(0.1) s.
    assert least_s(0.05, 0.25, 0.5) == pytest.approx(2.0 * math.sqrt(0.1))
    run = ramps(least_s(0.05, 0.25, 0.5), 0.05, 0.25, 0.5)
    assert run.fractions[1] == pytest.approx(0.5)
    assert run.rates[1] * 0.05 == pytest.approx(0.5 * math.sqrt(0.1))


@given(WAYS, LIMITS, LIMITS, st.floats(1.0, 5.0))
def test_limits_hold_however_much_time_there_is(way: float, speed: float, acceleration: float, slack: float) -> None:
    duration_s = slack * least_s(way, speed, acceleration)
    run = ramps(duration_s, way, speed, acceleration)
    curve = CubicHermiteSpline(run.times_s, run.fractions, run.rates)
    assert (run.times_s[-1], run.fractions[-1]) == pytest.approx((duration_s, 1.0))
    assert max(run.rates) * way <= speed * (1.0 + 1e-6)
    inner = [0.5 * (a + b) for a, b in zip(run.times_s, run.times_s[1:], strict=False)]
    assert abs(curve(inner, 2)).max() * way <= acceleration * (1.0 + 1e-6)


@given(WAYS, LIMITS, LIMITS)
def test_the_least_time_uses_the_limits_fully(way: float, speed: float, acceleration: float) -> None:
    run = ramps(least_s(way, speed, acceleration), way, speed, acceleration)
    assert run.rates[1] / run.times_s[1] * way == pytest.approx(acceleration, rel=1e-5)


def test_no_way_takes_no_time() -> None:
    assert least_s(0.0, 1.0, 1.0) == 0.0
    assert ramps(0.0, 0.0, 1.0, 1.0).times_s == (0.0,)
