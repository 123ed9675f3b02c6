"""Land hands short if the cloth turns over round the ends of their fingers.

A hand that points along its way does not roll with the cloth. Its fingers reach further in than the edge that they
hold, so cloth turns over round their ends, down the finger under it and back. What turned about the fold line is the
cloth at these ends, and once the fingers are drawn out the edge falls forward, as far beyond them as it was behind: a
hand that ended where the plan has the edge would lay it down beyond that by twice what fingers reach ahead and by their
thickness, and would draw the crease inside of its line on the way. So such hands turn the ends of their fingers about
the line. Cloth whose threads rub may stay doubled back there, so once open they go on until it is pushed over, past
where the plan has the edge.
"""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

import numpy as np

from app.rehearsal.physics.pinch import PAD_M
from app.rehearsal.world import GripMotion, StepMotion

_LEAST_WAY_M = 4.0 * PAD_M
"""The shortest horizontal path of a hand on which there is room to land short (m)."""

_PAST_M = 0.02
"""How far past the edge's place open hands go on (m): about a row of the simulated mesh, as long as a bend can be."""


def round_finger_ends(
    motions: Iterable[StepMotion], thickness_m: Mapping[str, float], most_m: float
) -> Iterator[StepMotion]:
    """Yield a plan's motions; in folds the finger ends of hands that do not roll turn about the line.

    They begin as planned and stay over their planned ways. Hands that hold cloth from one fold to another keep to it.

    Args:
        motions: the steps.
        thickness_m: of the fingers, by the arms' names (m).
        most_m: how far short of their places hands may land (m).
    """
    from_fold: set[str] = set()
    for motion in motions:
        hold_on = {grip.arm for grip in motion.grips if not grip.opens}
        if motion.is_fold:
            grips = (
                grip if grip.arm in from_fold | hold_on else _turned(grip, thickness_m[grip.arm], most_m)
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


def _turned(grip: GripMotion, thickness_m: float, most_m: float) -> GripMotion:
    points, ahead_m = np.array(grip.points), reach_ahead(grip)
    way = points[-1] - points[0]
    way_m = float(np.hypot(*way[:2]))
    if not ahead_m or way_m < _LEAST_WAY_M:
        return grip
    scale = min(1.0, most_m / (2.0 * ahead_m + thickness_m))
    done = np.clip((points[:, :2] - points[0, :2]) @ way[:2] / way_m**2, 0.0, 1.0)
    # The cloth goes round a finger's thickness from the apex on.
    short_m = scale * (2.0 * ahead_m * done + thickness_m * np.maximum(0.0, 2.0 * done - 1.0))
    points[:, :2] -= short_m[:, None] * way[:2] / way_m
    on_table = points[0, 2] + way[2] * done
    points[:, 2] = on_table + (1.0 - 2.0 * scale * ahead_m / way_m) * (points[:, 2] - on_table)
    return replace(grip.along(points), goes_on_m=float(short_m[-1]) + _PAST_M)
