"""Land hands short round whose finger ends cloth turns over.

A hand that points along its way does not roll with the cloth. Its fingers reach further in than the edge that they
hold, so cloth turns over round their ends, down the finger under it and back. What turned about the fold line is the
cloth at these ends, and once the fingers are drawn out the edge falls forward, as far beyond them as it was behind: a
hand that ended where the plan has the edge would lay it down beyond that by twice what fingers reach ahead and by their
thickness, and would draw the crease inside of its line on the way. So such hands turn the ends of their fingers about
the line; of fingers that point aslant it is their corner that reaches furthest.
"""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from typing import Protocol

import numpy as np

from app.rehearsal.physics.fingers import FingerSize
from app.rehearsal.physics.pinch import PAD_M
from app.rehearsal.world import GripMotion, StepMotion
from planner.geometry.pose import BoolArray, FloatArray

_LEAST_WAY_M = 4.0 * PAD_M
"""The least way of a hand for which there is room to land short (m)."""


_SHARES = np.linspace(1.0, 0.0, 9)
"""How much of what is wanted beyond a limit is tried, in this order, until it is in reach."""


class Reaches(Protocol):
    """What is in reach of a hand at the end of a step."""

    def ends_in(self, step: int, arm: str, points: FloatArray) -> BoolArray:
        """Return at which points, table frame, an arm can open its hand in a step, shape (n, 3) -> (n,)."""


def round_finger_ends(
    motions: Iterable[StepMotion], fingers: Mapping[str, FingerSize], most_m: float, reaches: Reaches
) -> Iterator[StepMotion]:
    """Yield a plan's motions, in folds with hands that turn the ends of their fingers about the line, unless they roll.

    They begin as planned and stay over their planned ways. Hands that hold cloth from one fold to another keep to it.

    Args:
        motions: the steps.
        fingers: their size, by the arms' names.
        most_m: how far short of their places hands may land whatever is in reach (m).
        reaches: what else is in reach.
    """
    from_fold: set[str] = set()
    for motion in motions:
        hold_on = {grip.arm for grip in motion.grips if not grip.opens}
        if motion.is_fold:
            grips = (
                grip
                if grip.arm in from_fold | hold_on
                else _turned(grip, fingers[grip.arm], most_m, partial(reaches.ends_in, motion.step, grip.arm))
                for grip in motion.grips
            )
            yield replace(motion, grips=tuple(grips))
        else:
            yield motion
        from_fold = hold_on if motion.is_fold else from_fold & hold_on


def reach_ahead(grip: GripMotion) -> float:
    """Return how far the fingers of a hand that does not roll reach ahead on its way over the table (m); else 0."""
    way = np.subtract(grip.points[-1][:2], grip.points[0][:2])
    if grip.heading_rad is None or any(grip.turned_rad) or not way.any():
        return 0.0
    heading = np.array([math.cos(grip.heading_rad), math.sin(grip.heading_rad)])
    return PAD_M * max(0.0, float(heading @ way) / float(np.hypot(*way)))


def corner_ahead(grip: GripMotion, width_m: float) -> float:
    """Return how far the corner of such fingers reaches ahead, which are so wide (m): cloth turns over round that."""
    ahead_m = reach_ahead(grip)
    return ahead_m + width_m / 2.0 * math.sqrt(1.0 - (ahead_m / PAD_M) ** 2) if ahead_m else 0.0


def _turned(
    grip: GripMotion, size: FingerSize, most_m: float, in_reach: Callable[[FloatArray], BoolArray]
) -> GripMotion:
    points, ahead_m = np.array(grip.points), corner_ahead(grip, size.width_m)
    way = points[-1] - points[0]
    way_m = float(np.hypot(*way[:2]))
    if not ahead_m or way_m < _LEAST_WAY_M:
        return grip
    scale, wanted_m = 1.0, 2.0 * ahead_m + size.thickness_m
    if wanted_m > most_m:
        shorts_m = most_m + _SHARES * (wanted_m - most_m)
        ends = points[-1] - shorts_m[:, None] * np.array([*way[:2], 0.0]) / way_m
        is_fine = np.append(in_reach(ends[:-1]), True)
        scale = float(shorts_m[is_fine.argmax()]) / wanted_m
    done = np.clip((points[:, :2] - points[0, :2]) @ way[:2] / way_m**2, 0.0, 1.0)
    # The cloth goes round a finger's thickness from the apex on.
    short_m = scale * (2.0 * ahead_m * done + size.thickness_m * np.maximum(0.0, 2.0 * done - 1.0))
    points[:, :2] -= short_m[:, None] * way[:2] / way_m
    on_table = points[0, 2] + way[2] * done
    points[:, 2] = on_table + (1.0 - 2.0 * scale * ahead_m / way_m) * (points[:, 2] - on_table)
    return grip.along(points)
