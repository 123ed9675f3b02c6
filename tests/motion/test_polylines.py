"""Compiled polylines, against NumPy's plain way, and by hand."""

import numpy as np
import pytest

from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import LENGTH_M
from planner.motion.polylines import lengths_along, lengths_on_table, resampled, stepped

STEP_M = 0.01
RNG_SEED = 5


def corners(rng: np.random.Generator) -> FloatArray:
    """Return three corners, of which neighbours may coincide."""
    found = rng.uniform(-0.2, 0.2, (3, 3))
    if rng.integers(3) == 0:
        found[1] = found[0]
    return found


def test_lengths_are_summed_along_the_line() -> None:
    points = np.array([[0.0, 0.0, 0.0], [3.0, 4.0, 0.0], [3.0, 4.0, 2.0], [3.0, 4.0, 2.0]])
    assert lengths_along(points).tolist() == [0.0, 5.0, 7.0, 7.0]


def test_a_tool_that_rests_on_the_base_goes_as_far_as_the_base_drives() -> None:
    bases = np.array([[0.0, 0.0, 0.0], [0.3, 0.4, 0.0], [0.3, 0.4, np.pi]])
    tools = np.tile([1.0, 0.0, 0.8], (3, 1))
    assert lengths_on_table(bases, tools) == pytest.approx([0.0, 0.5, 2.5])
    assert lengths_on_table(bases[:1], tools) == pytest.approx([0.0, 0.0, 0.0])


def test_steps_are_even_and_no_longer_than_allowed() -> None:
    rng = np.random.default_rng(RNG_SEED)
    for line in (corners(rng) for _ in range(200)):
        points = stepped(line, STEP_M)
        lengths = np.linalg.norm(np.diff(line, axis=0), axis=1)
        counts = np.ceil((lengths - LENGTH_M) / STEP_M).clip(0).astype(int)
        parts = [
            start + np.linspace(0.0, 1.0, n + 1)[1:, None] * (end - start)
            for start, end, n in zip(line[:-1], line[1:], counts, strict=True)
        ]
        np.testing.assert_allclose(points, np.concatenate([line[:1], *parts]), rtol=0.0, atol=1e-15)


def test_a_line_of_no_length_has_two_points() -> None:
    point = np.array([0.1, 0.2, 0.3])
    assert stepped(np.tile(point, (3, 1)), STEP_M).tolist() == [point.tolist()] * 2


def test_more_steps_lie_on_the_same_line() -> None:
    rng = np.random.default_rng(RNG_SEED)
    for points in (stepped(corners(rng), STEP_M) for _ in range(100)):
        steps = len(points) - 1 + int(rng.integers(0, 9))
        numbers = np.linspace(0.0, len(points) - 1, steps + 1)
        expected = np.column_stack([np.interp(numbers, np.arange(len(points)), column) for column in points.T])
        np.testing.assert_allclose(resampled(points, steps), expected, rtol=0.0, atol=1e-15)
