"""Values between keyframes: cubics with given rates, or straight lines without."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import CubicHermiteSpline

from planner.geometry.keyframes import acceleration_at, rate_at, value_at, values_at
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
