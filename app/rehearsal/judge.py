"""Judge a step by the distance of the cloth from where the plan has it."""

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.rehearsal.planned_cloth import crease_distances, planned_positions
from app.rehearsal.world import Truth
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.region import Region
from planner.geometry.table import Table
from planner.task.world_state import WorldState

_MM = 1000.0

GAP_M = 0.002
"""The height of a layer above the one below (m)."""

BESIDE_CREASE_M = 0.03
"""How far from a planned crease cloth may face either way (m): a crease that slides rolls over what is beside it."""

_UPRIGHT_M2 = 1e-8
"""Twice the area of a triangle's shadow up to which it counts as upright and covers nothing (m^2)."""


@dataclass(frozen=True, slots=True)
class Gate:
    """The limits within which a step counts as held, provided that every hand has found cloth.

    The motion of the cloth as a whole is left out, since the next grips can be corrected for it; if they are not, the
    next step fails.

    Attributes:
        outline_mm: the mean distance between the outlines of the silhouettes at most (mm). It is a length because an
            overlap's meaning depends on the size: 93 % is 3 mm all round a folded tie, and 7 mm round a scarf.
        mean_mm: the mean error of the points of the cloth at most (mm).
        p95_mm: the error that 95 % of the points keep within (mm).
        wrong_face_m2: the area of cloth away from the planned creases that faces the wrong way, at most (m^2): that of
            a corner doubled back with legs of 6.3 cm. Like the other limits it is the same for every size: 5 % of the
            points, which may be anywhere, are a flap of 50 cm2 of a small towel and of 300 cm2 of a large one.
    """

    outline_mm: float = 5.0
    mean_mm: float = 15.0
    p95_mm: float = 40.0
    wrong_face_m2: float = 0.002


@dataclass(frozen=True, slots=True)
class StepVerdict:
    """The verdict on one step of a plan.

    Attributes:
        step: the index of the step.
        iou: the overlap of the silhouettes, seen from above, as a fraction of what either covers.
        outline_mm: the mean distance between their outlines: what one of them covers alone, over the length of the
            planned outline (mm).
        mean_mm: the mean error of the points of the cloth, what slid as a whole taken off (mm).
        p95_mm: the error that 95 % of them keep within (mm).
        slid_mm: how far the cloth's middle is from where it should be (mm).
        turned_rad: how far the cloth has turned as a whole (rad).
        wrong_face_m2: the area of cloth further than `BESIDE_CREASE_M` from the planned creases that faces the wrong
            way (m^2).
        empty: the arms that found no cloth.
        held: whether it meets the gate.
        of_plan: the index of the step of the plan as it was at first that leaves the cloth folded alike; None where
            none does, since the rest was planned again.
    """

    step: int
    iou: float
    outline_mm: float
    mean_mm: float
    p95_mm: float
    slid_mm: float
    turned_rad: float
    wrong_face_m2: float = 0.0
    empty: tuple[str, ...] = field(default=())
    held: bool = True
    of_plan: int | None = None

    def to_dict(self) -> dict[str, Any]:
        """Return the verdict as JSON."""
        return {name: getattr(self, name) for name in self.__slots__} | {"empty": list(self.empty)}


@dataclass(frozen=True, slots=True)
class Slide:
    """The rigid motion of the cloth against its plan.

    Attributes:
        isometry: from where it should be to where it is, table frame.
        slid_m: how far its middle has moved (m).
        turned_rad: how far it has turned (rad).
    """

    isometry: Isometry
    slid_m: float
    turned_rad: float


def carry(start: Pose2, end: Pose2) -> Isometry:
    """Return the isometry that carries a garment from one placement to another, table frame."""
    to, back = (Isometry.rotation(pose.yaw_rad, pose.x_m, pose.y_m) for pose in (end, start))
    return to.after(back.inverse)


def carried_pose(placement: Pose2, carried: Isometry) -> Pose2:
    """Return the placement of a garment that was carried elsewhere by an isometry."""
    x, y = carried.apply_point((placement.x_m, placement.y_m))
    return Pose2(x, y, placement.yaw_rad + math.atan2(carried.c, carried.a))


def slide_of(planned: FloatArray, found: FloatArray) -> Slide:
    """Return the turn and shift that bring points nearest to where they are, by least squares; shapes (n, 2), m."""
    middle, target = planned.mean(axis=0), found.mean(axis=0)
    a, b = planned - middle, found - target
    turned = float(np.arctan2((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum(), (a * b).sum()))
    turn = Isometry.rotation(turned)
    x, y = (target - turn.apply(middle[None])[0]).tolist()
    return Slide(Isometry.rotation(turned, x, y), float(np.hypot(*(target - middle))), turned)


def judged(
    truth: Truth,
    step: int,
    sequence: FoldSequence,
    state: WorldState,
    carried: Isometry,
    table: Table,
    gate: Gate,
    empty: tuple[str, ...],
) -> StepVerdict:
    """Return the verdict on a step.

    Args:
        truth: where the cloth is.
        step: the step's index.
        sequence: the garment's folds.
        state: the world as it should be.
        carried: how far the cloth was known to lie from there, table frame.
        table: the table.
        gate: what counts as held.
        empty: the arms that found no cloth.
    """
    lies = carried_pose(state.placement, carried)
    planned = planned_positions(sequence, truth.pattern, state.done, lies, table, GAP_M)
    slide = slide_of(planned[:, :2], truth.positions[:, :2])
    back = slide.isometry.inverse
    places = np.column_stack([back.apply(truth.positions[:, :2]), truth.positions[:, 2]])
    errors = _MM * np.linalg.norm(places - planned, axis=1)
    covered, seen = (silhouette(points[:, :2], truth.triangles) for points in (planned, places))
    shared = covered.intersection(seen).area
    either = covered.area + seen.area - shared
    outline = _MM * (either - shared) / covered.outline_length
    mean, p95 = float(errors.mean()), float(np.quantile(errors, 0.95))
    wrong_m2 = wrong_face_area(planned, places, truth.triangles, truth.pattern, sequence, state.done)
    held = outline <= gate.outline_mm and mean <= gate.mean_mm and p95 <= gate.p95_mm and not empty
    return StepVerdict(
        step,
        shared / either,
        outline,
        mean,
        p95,
        _MM * slide.slid_m,
        slide.turned_rad,
        wrong_m2,
        empty,
        held and wrong_m2 <= gate.wrong_face_m2,
    )


def wrong_face_area(
    planned: FloatArray,
    found: FloatArray,
    triangles: NDArray[np.int64],
    pattern: FloatArray,
    sequence: FoldSequence,
    done: int,
) -> float:
    """Return the area of cloth away from creases that faces the wrong way (m^2).

    Each triangle counts by its shadow along the direction in which it should face, so that cloth that stands upright
    counts for nothing.

    Args:
        planned: the points where they should be, shape (n, 3), m.
        found: the points where they are, what they slid as a whole taken off, shape (n, 3), m.
        triangles: the triangles between them, shape (m, 3).
        pattern: the points in the pattern's frame, shape (n, 2), m.
        sequence: the garment's folds.
        done: the folds done, as a bit mask.
    """
    away = triangles[crease_distances(sequence, pattern[triangles].mean(axis=1), done) > BESIDE_CREASE_M]
    should, does = _areas(planned, away), _areas(found, away)
    facing = should / np.maximum(np.linalg.norm(should, axis=1, keepdims=True), _UPRIGHT_M2)
    return float(np.maximum(0.0, -(facing * does).sum(axis=1)).sum())


def silhouette(points: FloatArray, triangles: NDArray[np.int64]) -> Region:
    """Return what a mesh covers, seen from above; its points have the shape (n, 2), m.

    The planned cloth is seen by the same mesh: one without a row on a crease ends short of it. Measured against the
    true outline, cloth just as planned overlapped by no more than .95 to 1, with rows 20 mm apart.
    """
    corners = points[triangles]
    (ax, ay), (bx, by) = (corners[:, i].T - corners[:, 0].T for i in (1, 2))
    lying = corners[np.abs(ax * by - ay * bx) > _UPRIGHT_M2]
    return Region.union(Region.polygon(triangle) for triangle in lying)


def _areas(points: FloatArray, triangles: NDArray[np.int64]) -> FloatArray:
    """Return each triangle's area times its normal, shape (m, 3), m^2."""
    first, second = (points[triangles[:, i]] - points[triangles[:, 0]] for i in (1, 2))
    return np.asarray(np.cross(first, second) / 2.0)
