"""Values between keyframes: cubics with given rates, or straight lines without; even ways from rest to rest."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import CubicHermiteSpline

from planner.geometry.keyframes import acceleration_at, least_s, ramps, rate_at, value_at, values_at
from planner.geometry.pose import FloatArray

TIMES, VALUES, RATES = (0.0, 1.0, 1.5, 4.0), (0.0, 2.0, 1.0, 1.0), (0.0, 1.5, -3.0, 0.0)
SPLINE = CubicHermiteSpline(TIMES, VALUES, RATES)
INSIDE = st.floats(0.0, 3.999)


@given(INSIDE)
def test_a_value_and_its_derivatives_are_those_of_the_cubic(t: float) -> None:
    assert value_at(TIMES, VALUES, RATES, t) == pytest.approx(float(SPLINE(t)), abs=1e-9)
    assert rate_at(TIMES, VALUES, RATES, t) == pytest.approx(float(SPLINE(t, 1)), abs=1e-9)
    assert acceleration_at(TIMES, VALUES, RATES, t) == pytest.approx(float(SPLINE(t, 2)), abs=1e-9)


def test_at_the_last_keyframe_derivatives_are_those_just_before_it() -> None:
    assert rate_at(TIMES, VALUES, RATES, 4.0) == pytest.approx(0.0)
    assert acceleration_at(TIMES, VALUES, RATES, 4.0) == pytest.approx(float(SPLINE(4.0, 2)))


def test_outside_of_its_keyframes_a_value_rests() -> None:
    assert [value_at(TIMES, VALUES, RATES, t) for t in (-1.0, 9.0)] == [0.0, 1.0]
    assert [rate_at(TIMES, VALUES, RATES, t) for t in (-1.0, 9.0)] == [0.0, 0.0]
    assert [acceleration_at(TIMES, VALUES, RATES, t) for t in (-1.0, 9.0)] == [0.0, 0.0]
    assert (value_at((2.0,), (7.0,), (0.0,), 2.0), rate_at((2.0,), (7.0,), (0.0,), 2.0)) == (7.0, 0.0)


@given(INSIDE)
def test_without_rates_it_goes_straight_from_keyframe_to_keyframe(t: float) -> None:
    assert value_at(TIMES, VALUES, (), t) == pytest.approx(np.interp(t, TIMES, VALUES))
    after = int(np.searchsorted(TIMES, t, side="right"))
    slope = (VALUES[after] - VALUES[after - 1]) / (TIMES[after] - TIMES[after - 1])
    assert rate_at(TIMES, VALUES, (), t) == pytest.approx(slope)
    assert acceleration_at(TIMES, VALUES, (), t) == 0.0


@pytest.mark.parametrize("rates", [np.array(RATES), np.empty(0)])
def test_many_values_at_once_are_the_same(rates: FloatArray) -> None:
    at = np.array([-1.0, 0.0, 0.3, 1.0, 1.2, 3.9, 4.0, 7.0])
    found = values_at(np.array(TIMES), np.array(VALUES), rates, at)
    assert found == pytest.approx([value_at(TIMES, VALUES, rates.tolist(), t) for t in at.tolist()])
    rows = np.column_stack([VALUES, VALUES])
    both = np.column_stack([rates, rates]) if len(rates) else rates
    assert values_at(np.array(TIMES), rows, both, at) == pytest.approx(np.column_stack([found, found]))
    assert values_at(np.zeros(1), rows[:1], both[:1], at).shape == (len(at), 2)


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
