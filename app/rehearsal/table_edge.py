"""Lay cloth down over the table's edge as far beyond it as it should hang.

A plan's hand ends as low as the cloth is to hang, and clear of the edge's plane. From the edge to there is further than
the cloth hangs, which draws it out of the stack by the difference; and a hand that follows cloth sideways would still
end as low. So hands end as far from the edge as the cloth is to hang, straight out where that is less than tools keep
clear.
"""

import math
from dataclasses import replace

import numpy as np

from app.rehearsal.step_seen import StepSeen
from app.rehearsal.world import GripMotion, StepMotion, way_done
from planner.folds.fold_path import REST_HEIGHT_M
from planner.geometry.pose import FloatArray
from planner.geometry.table import TableTop


def over_edge(motion: StepMotion, seen: StepSeen) -> StepMotion:
    """Have hands that lay cloth down over the table's edge end where it is as long as it should hang."""
    top, clear_m = TableTop.of(seen.plan.scene.table), seen.plan.scene.edge_clear_m
    planned = {grip.arm: np.array(grip.points[-1]) for grip in seen.planned.grips}

    def moved(grip: GripMotion) -> GripMotion:
        points, end = np.array(grip.points), planned[grip.arm]
        if not grip.opens or top.covers(end[None]):
            return grip
        nearest, outwards, _ = top.edge_beside(end)
        hangs_at = nearest + (REST_HEIGHT_M - end[2]) * outwards  # if the table went on
        late = np.clip(2.0 * way_done(points) - 1.0, 0.0, 1.0)[:, None]
        laid = laid_over(hangs_at + points[-1, :2] - end[:2], top, clear_m)
        return grip.along(points + late * (laid - points[-1]))

    return replace(motion, grips=tuple(map(moved, motion.grips))) if motion.is_fold else motion


def laid_over(place: FloatArray, top: TableTop, clear_m: float) -> FloatArray:
    """Return where a hand lays cloth down that would be at a place if the table went on, shape (2,) -> (3,), m.

    Args:
        place: the place.
        top: the table's top.
        clear_m: how far outside of an edge's plane a tool keeps at most (m).
    """
    nearest, outwards, beyond = top.edge_beside(place)
    out_m = min(float(beyond), clear_m)
    return np.array([*(nearest + out_m * outwards), REST_HEIGHT_M - math.sqrt(float(beyond) ** 2 - out_m**2)])
