"""Choose how finely a phase is cut into waypoints: more finely where something moves or turns fast."""

import math

import numpy as np

from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import EDGE_RAD, LENGTH_M
from planner.task.phase import Phase

STEP_M = 0.01
"""The largest distance that a tool or the base goes from one moment to the next (m)."""

STEP_RAD = 0.05
"""The largest angle that a tool turns from one moment to the next (rad)."""


def shares_of(phase: Phase) -> FloatArray:
    """Return the fraction of a phase that is done at each of its waypoints, with even steps on each piece of its paths.

    The start is included. Some pieces need more steps than others: a hand near the fold line's end rolls there within a
    few centimetres. Cutting the whole phase as finely would take several times as many waypoints.

    Returns:
        Shape (n,), rising from 0 to 1.
    """
    hands = [hand for hand in phase.hands if hand is not None]
    pieces = max((len(hand.points) - 1 for hand in hands), default=1) or 1
    way = np.array([phase.base[1].x_m - phase.base[0].x_m, phase.base[1].y_m - phase.base[0].y_m, 0.0])
    drive = math.hypot(way[0], way[1])
    if all(len(hand.points) == 1 for hand in hands):
        count = max(math.ceil((drive - LENGTH_M) / STEP_M), 1)
        return np.arange(count + 1) / count
    wanted = np.full(pieces, (drive - LENGTH_M) / pieces / STEP_M)
    for hand in hands:
        if len(hand.points) > 1:
            points = np.array(hand.points)
            gone = points[1:] - points[:-1]
            # Over the table, and seen from the base, which drives meanwhile: a drag's tools rest on it.
            for seen in (gone, gone - way / len(gone)):
                _need(wanted, (np.sqrt((seen**2).sum(axis=1)) - LENGTH_M) / STEP_M)
        if len(hand.rolls_rad) > 1:
            rolls = np.array(hand.rolls_rad)
            _need(wanted, (np.abs(rolls[1:] - rolls[:-1]) - EDGE_RAD) / STEP_RAD)
    steps = np.maximum(np.ceil(wanted), 1.0).astype(np.int64)
    ends = steps.cumsum()
    each, whole = steps.repeat(steps), np.arange(pieces).repeat(steps)
    shares = np.zeros(int(ends[-1]) + 1)
    shares[1:] = (whole + (np.arange(1, len(shares)) - (ends - steps).repeat(steps)) / each) / pieces
    return shares


def _need(wanted: FloatArray, steps: FloatArray) -> None:
    """Raise the steps wanted in each piece of a phase to those that a hand needs in each piece of its path."""
    shared, rest = divmod(len(wanted), len(steps))
    each = (steps if shared == 1 else steps.repeat(shared) / shared) if rest == 0 else steps.max()
    np.maximum(wanted, each, out=wanted)
