"""Hands that keep cloth from going slack while they fold it over."""

import math

import numpy as np
import pytest

from app.rehearsal.corrections import taut
from app.rehearsal.world import GripMotion, StepMotion
from planner.geometry.pose import Point2

FAR_M, NEAR_M, REST_M = 0.2, 0.05, 0.02


def folding(arm: str, from_line_m: float, y_m: float, *, opens: bool = True) -> GripMotion:
    """Return the path of a plan's fold over the line x = 0: each hand waits until the baseline has come to it."""
    waits_s = 5.0 * (FAR_M - from_line_m)
    times_s: tuple[float, ...] = (waits_s, 1.0, 2.0 - waits_s)
    places: tuple[Point2, ...] = ((from_line_m, REST_M), (0.0, REST_M + from_line_m), (-from_line_m, REST_M))
    if waits_s > 0.0:
        times_s, places = (0.0, *times_s, 2.0), (places[0], *places, places[-1])
    return GripMotion(arm, times_s, tuple((x, y_m, z) for x, z in places), opens=opens)


def fold(*grips: GripMotion, kind: str = "fold") -> StepMotion:
    return StepMotion(0, kind, 2.0, grips)


def least_from_line_m(grip: GripMotion) -> float:
    places = np.array([grip.at(t_s) for t_s in np.linspace(0.0, 2.0, 201)])
    return float(np.hypot(places[:, 0], places[:, 2] - REST_M).min())


def test_hands_keep_their_cloth_longer_and_end_where_they_should() -> None:
    planned = folding("left", FAR_M, 0.0)
    (kept,) = taut(fold(planned), math.inf).grips
    assert least_from_line_m(planned) == pytest.approx(FAR_M / math.sqrt(2.0), abs=1e-3)
    assert least_from_line_m(kept) == pytest.approx(FAR_M * (1.0 + math.sqrt(0.5)) / 2.0, abs=2e-3)
    for t_s in (0.0, 1.0, 2.0):
        assert kept.at(t_s) == pytest.approx(planned.at(t_s), abs=1e-6)


def test_the_cloth_between_two_hands_stays_longer_too() -> None:
    planned = fold(folding("left", FAR_M, 0.0), folding("right", NEAR_M, 0.0))

    def least_apart_m(motion: StepMotion) -> float:
        left, right = motion.grips
        return min(float(np.linalg.norm(left.at(t_s) - right.at(t_s))) for t_s in np.linspace(0.0, 2.0, 201))

    assert least_apart_m(planned) < 0.75 * (FAR_M - NEAR_M)
    assert least_apart_m(taut(planned, math.inf)) > 0.82 * (FAR_M - NEAR_M)


def test_hands_leave_their_paths_no_further_than_is_in_reach() -> None:
    planned, most_m = folding("left", FAR_M, 0.0), 0.01
    (kept,) = taut(fold(planned), most_m).grips
    left_m = max(float(np.linalg.norm(kept.at(t_s) - planned.at(t_s))) for t_s in np.linspace(0.0, 2.0, 201))
    assert left_m == pytest.approx(most_m, rel=0.05)


def test_hands_that_hold_on_and_steps_that_do_not_fold_keep_their_paths() -> None:
    held, drag = fold(folding("left", FAR_M, 0.0, opens=False)), fold(folding("left", FAR_M, 0.0), kind="drag")
    assert taut(held, math.inf) is held
    assert taut(drag, math.inf) is drag
