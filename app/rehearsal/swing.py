"""The turn of cloth that one hand drags: it swings behind the hand.

Held at one point, cloth turns about it so that friction has no torque there. Each piece resists along its own velocity;
for small turns a way ds of the hand turns the cloth by ds mean(b) / mean(a^2), where a is how far pieces are ahead of
the hand along its way, b how far to the left of it. Cloth that trails behind comes into line with the way.
"""

import itertools
from collections.abc import Sequence

import numpy as np

from app.rehearsal.corrections import carry
from app.rehearsal.planned_cloth import planned_positions
from app.rehearsal.world import GripMotion
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray
from planner.geometry.table import Table
from planner.geometry.woven_mesh import woven_mesh
from planner.task.plan_step import PlanStep

_PIECE_M = 0.03
"""The distance of the points that stand for the cloth (m)."""

_STRIDE_M = 0.01
"""The way of the hand after which the cloth is looked at anew (m)."""


def swung(
    grips: Sequence[GripMotion], step: PlanStep, sequence: FoldSequence, table: Table, carried: Isometry
) -> Isometry:
    """Return how far from where it should be cloth lies after a drag, table frame.

    Two hands, which end where they should, bring all of it to where it should be.

    Args:
        grips: the motions of the hands that have dragged it.
        step: the plan's step.
        sequence: the garment's folds.
        table: the table.
        carried: how far from where it should be the cloth lay before.
    """
    if len(grips) != 1:
        return Isometry()
    (grip,) = grips
    begin, end = (Isometry(x=grip.points[number][0], y=grip.points[number][1]) for number in (0, -1))
    pieces = begin.inverse.after(carried).apply(_pieces(step, sequence, table))
    turned = end.after(Isometry.rotation(_turn(grip, pieces))).after(begin.inverse).after(carried)
    return turned.after(carry(step.after.placement, step.before.placement))


def _turn(grip: GripMotion, pieces: FloatArray) -> float:
    """Return by how much a hand's way turns the pieces that are so far from it at first, shape (n, 2), m (rad)."""
    points, turned_rad = np.array(grip.points)[:, :2], 0.0
    for begin, end in itertools.pairwise(points):
        length_m = float(np.hypot(*(end - begin)))
        count = int(np.ceil(length_m / _STRIDE_M))
        for _ in range(count):
            apart, way = Isometry.rotation(turned_rad).apply(pieces), (end - begin) / length_m
            ahead, left = apart @ way, apart @ np.array([-way[1], way[0]])
            turned_rad += length_m / count * float(left.mean() / (ahead**2).mean())
    return turned_rad


def _pieces(step: PlanStep, sequence: FoldSequence, table: Table) -> FloatArray:
    """Return where equal pieces of the cloth that lies on the table should be before a step, shape (n, 2), m."""
    before, (points, _) = step.before, woven_mesh(sequence.garment.pattern, _PIECE_M, 0)
    planned = planned_positions(sequence, points, before.done, before.placement, table, 0.0)
    return planned[planned[:, 2] >= 0.0, :2]
