"""Timings of paths: within the limits, at rest where they must be, as long as planned where that is enough."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import CubicHermiteSpline
from toppra import SplineInterpolator
from toppra.algorithm import TOPPRA
from toppra.constraint import DiscretizationType, JointAccelerationConstraint, JointVelocityConstraint

from planner.motion.path_timing import EXCESS, PathTiming, quickest, timed

ONE = (np.array([1.0]), np.array([2.0]))


def excess(values: np.ndarray, timing: PathTiming, limits: tuple[np.ndarray, np.ndarray]) -> tuple[float, float]:
    """Return the greatest speed and acceleration as shares of their limits, on dense samples between keyframes."""
    keep = np.append(True, np.diff(timing.times_s) > 1e-9)
    curve = CubicHermiteSpline(timing.times_s[keep], values[keep], timing.velocities[keep])
    ends = zip(timing.times_s[keep], timing.times_s[keep][1:], strict=False)
    dense = np.concatenate([np.linspace(a, b, 12)[1:-1] for a, b in ends])
    return np.abs(curve(dense, 1) / limits[0]).max(), np.abs(curve(dense, 2) / limits[1]).max()


def walk(seed: int, count: int, columns: int) -> np.ndarray:
    """Return a path that wanders about, with a few sharp turns."""
    steps = np.random.default_rng(seed).normal(0.0, 0.02, (count, columns))
    steps[:: max(count // 4, 1)] *= 5.0
    return np.cumsum(steps, axis=0)


def run_of(values: np.ndarray, speeds: np.ndarray) -> np.ndarray:
    return np.append(0.0, np.cumsum((np.abs(np.diff(values, axis=0)) / speeds).max(axis=1)))


def test_a_straight_way_takes_little_more_than_ramps_do() -> None:
    values = np.linspace(0.0, 3.0, 61)[:, None]
    timing = quickest(values, values[:, 0], ONE)
    assert timing.duration_s == pytest.approx(3.0 / 1.0 + 1.0 / 2.0, rel=0.01)  # way / speed + speed / acceleration
    assert not timing.velocities[[0, -1]].any()


def test_with_time_left_it_goes_evenly_but_for_its_ends() -> None:
    values = np.linspace(0.0, 3.0, 61)[:, None]
    rest = np.zeros(61, dtype=bool)
    rest[[0, -1]] = True
    timing = timed(values[:, 0], values, rest, np.zeros(61, dtype=np.int64), np.array([6.0]), ONE)
    assert timing.duration_s == pytest.approx(6.0, abs=1e-9)
    middle = timing.velocities[8:-8, 0]
    assert np.ptp(middle) < 1e-9
    assert middle[0] == pytest.approx(3.0 / (6.0 - middle[0] / 2.0), rel=0.01)


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10_000), st.integers(3, 60), st.integers(1, 6), st.floats(0.2, 4.0))
def test_speeds_and_accelerations_stay_within_their_limits(seed: int, count: int, columns: int, slack: float) -> None:
    values = walk(seed, count, columns)
    limits = np.full(columns, 1.0), np.full(columns, 3.0)
    at = run_of(values, limits[0])
    rest = np.zeros(count, dtype=bool)
    rest[[0, count // 2, -1]] = True
    groups = (np.arange(count) > count // 2).astype(np.int64)
    ways = np.array([at[count // 2], at[-1] - at[count // 2]])
    timing = timed(at, values, rest, groups, slack * ways, limits)
    speed, acceleration = excess(values, timing, limits)
    assert speed <= 1.0 + 1e-6
    assert acceleration <= EXCESS * (1.0 + 1e-6)
    assert not timing.velocities[rest].any()
    durations = np.array([timing.times_s[count // 2], timing.duration_s - timing.times_s[count // 2]])
    assert (durations >= slack * ways - 1e-9).all()
    quick = quickest(values[: count // 2 + 1], at[: count // 2 + 1], limits).duration_s
    assert durations[0] <= max(slack * ways[0], quick) * 1.1 + 1e-9


@settings(max_examples=30, deadline=None)
@given(st.integers(0, 10_000), st.floats(1.05, 3.0))
def test_what_has_time_takes_as_long_as_planned(seed: int, slack: float) -> None:
    values = walk(seed, 40, 3)
    limits = np.full(3, 1.0), np.full(3, 3.0)
    at = run_of(values, limits[0])
    rest = np.zeros(40, dtype=bool)
    rest[[0, -1]] = True
    planned_s = slack * quickest(values, at, limits).duration_s
    timing = timed(at, values, rest, np.zeros(40, dtype=np.int64), np.array([planned_s]), limits)
    assert timing.duration_s == pytest.approx(planned_s, abs=1e-9)


@pytest.mark.parametrize("seed", range(6))
def test_on_smooth_paths_it_is_nearly_as_quick_as_a_general_solver(seed: int) -> None:
    phases = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, (2, 4))
    knots = np.linspace(0.0, 6.0, 241)
    values = 0.6 * np.sin(knots[:, None] + phases[0]) + 0.2 * np.sin(2.0 * knots[:, None] + phases[1])
    limits = np.full(4, 1.0), np.full(4, 4.0)
    bounds = [
        JointVelocityConstraint(np.column_stack([-limits[0], limits[0]])),
        JointAccelerationConstraint(np.column_stack([-limits[1], limits[1]]), DiscretizationType.Interpolation),
    ]
    least_s = TOPPRA(bounds, SplineInterpolator(knots, values), gridpoints=knots).compute_trajectory(0, 0).duration
    found_s = quickest(values, run_of(values, limits[0]), limits).duration_s
    assert 0.98 * least_s < found_s < 1.12 * least_s


def test_between_keyframes_no_joint_leaves_the_range_of_their_values() -> None:
    values = walk(5, 50, 4)
    limits = np.full(4, 1.0), np.full(4, 3.0)
    timing = quickest(values, run_of(values, limits[0]), limits)
    curve = CubicHermiteSpline(timing.times_s, values, timing.velocities)
    for number in range(len(values) - 1):
        start_s, end_s = timing.times_s[number : number + 2]
        inner = curve(np.linspace(start_s, end_s, 9))
        low, high = np.minimum(*values[number : number + 2]), np.maximum(*values[number : number + 2])
        width = 0.02 * (high - low)  # in time a cubic is not quite monotone where its pace changes
        assert (inner >= low - width).all() and (inner <= high + width).all()


def test_keyframes_at_one_parameter_have_one_time() -> None:
    values = np.repeat(np.linspace(0.0, 3.0, 31), 2)[:, None]
    timing = quickest(values, values[:, 0], ONE)
    assert timing.times_s[::2].tolist() == timing.times_s[1::2].tolist()
    assert timing.duration_s == quickest(values[::2], values[::2, 0], ONE).duration_s


def test_two_keyframes_alone_are_one_cubic_from_rest_to_rest() -> None:
    # Its greatest speed is 1.5 ways a second, its greatest acceleration 6 ways a second squared.
    for way, wanted_s in ((3.0, 4.5), (0.03, np.sqrt(6.0 * 0.03 / 2.0))):
        values = np.array([[0.0], [way]])
        assert quickest(values, values[:, 0], ONE).duration_s == pytest.approx(wanted_s)


def test_what_does_not_move_takes_no_time() -> None:
    timing = quickest(np.ones((4, 2)), np.zeros(4), (np.ones(2), np.ones(2)))
    assert timing.duration_s == 0.0 and not timing.velocities.any()


def test_where_all_turns_round_little_time_is_lost() -> None:
    # A narrow step before the turn makes its pace low; the wide one after it takes what it takes alone.
    values = np.array([[0.0], [0.2], [0.21], [0.0]])
    timing = quickest(values, run_of(values, ONE[0]), ONE)
    assert timing.times_s[3] - timing.times_s[2] == pytest.approx(np.sqrt(6.0 * 0.21 / 2.0), rel=0.02)
    speed, acceleration = excess(values, timing, ONE)
    assert speed <= 1.0 + 1e-6 and acceleration <= EXCESS * (1.0 + 1e-6)


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10_000), st.integers(3, 30), st.integers(1, 6))
def test_a_mirror_image_takes_as_long(seed: int, count: int, columns: int) -> None:
    values, limits = walk(seed, count, columns), (np.full(columns, 1.0), np.full(columns, 3.0))
    mirrored = np.random.default_rng(seed).choice([-1.0, 1.0], columns) * values + 2.0 * np.pi
    one, other = (quickest(each, run_of(each, limits[0]), limits) for each in (values, mirrored))
    assert other.duration_s == pytest.approx(one.duration_s, rel=1e-6)
