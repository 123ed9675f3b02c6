"""Check whether a garment's folds are legal, how many grippers can hold each, and which corners need them.

While a part is folded it stands over the fold line, held by the hands: "above" a corner is what lies further from the
line. A corner must be held unless it is on the line, or is no corner of the convex hull, or has cloth above it (paper,
Theorem 1).
"""

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np

from planner.cloth.garment import Garment
from planner.cloth.must_hold import must_hold
from planner.explain.reason_obstacle import of_obstacle
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray, Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M, grid_key
from planner.planning.robot_task import default_scene
from planner.primitives.context import Context
from planner.primitives.fold_trial import grips_obstacle
from planner.primitives.grasping import held_covers
from planner.primitives.obstacle import Obstacle
from planner.primitives.state import UNDRAGGED, Held, State
from planner.robots.load_robot import load_robot
from planner.task.reason import Code, Reason
from planner.task.scene import Scene
from planner.task.task import DEFAULT_ROBOT


class Support(StrEnum):
    """The support of a corner, if there is any."""

    HANGS_FREELY = "hangs_freely"
    ON_THE_LINE = "on_the_line"
    WITHIN_THE_HULL = "within_the_hull"
    CLOTH_ABOVE = "cloth_above"
    CLOTH_NEARLY_ABOVE = "cloth_nearly_above"


@dataclass(frozen=True, slots=True)
class VertexCheck:
    """A corner of the part that a fold moves.

    Attributes:
        point: its position before the fold, garment frame (m).
        support: what holds it.
    """

    point: Point2
    support: Support

    @property
    def must_be_held(self) -> bool:
        """Whether a hand must hold it."""
        return self.support is Support.HANGS_FREELY


def vertex_checks(part: Region, line: Segment, support_angle_rad: float) -> tuple[VertexCheck, ...]:
    """Return the check of every corner of the part that moves, counter-clockwise.

    Args:
        part: the silhouette of the part, garment frame.
        line: the fold line; the part is to its left.
        support_angle_rad: the angle from straight above within which cloth counts as above (rad).
    """
    free = _keys(must_hold(part, line.left, (line,), support_angle_rad))
    not_straight = _keys(must_hold(part, line.left, (), 0.0))
    hull = _keys(part.hull)
    found = []
    for vertex in np.vstack(part.rings):
        key = _key(vertex)
        if key in free:
            support = Support.HANGS_FREELY
        elif line.distances(vertex[None])[0] <= LENGTH_M:
            support = Support.ON_THE_LINE
        elif key not in hull:
            support = Support.WITHIN_THE_HULL
        else:
            support = Support.CLOTH_NEARLY_ABOVE if key in not_straight else Support.CLOTH_ABOVE
        found.append(VertexCheck((float(vertex[0]), float(vertex[1])), support))
    return tuple(found)


def _keys(points: FloatArray) -> set[tuple[int, int]]:
    return {_key(point) for point in points}


def _key(point: FloatArray) -> tuple[int, int]:
    return (grid_key(point[0]), grid_key(point[1]))


@dataclass(frozen=True, slots=True)
class FoldCheck:
    """The requirements of one fold.

    Attributes:
        name: the fold's name.
        kind: the fold's kind, by name.
        vertices: every corner of the part that moves, and why it must be held or need not be.
        grips: the grips that hold what must be held, garment frame (m); empty when the hands do not suffice.
        grips_needed: the number of grips; None when it exceeds the number of hands.
        reason: why the hands cannot hold it, and what would help; None if they can.
    """

    name: str
    kind: str
    vertices: tuple[VertexCheck, ...]
    grips: tuple[Point2, ...]
    grips_needed: int | None
    reason: Reason | None

    @property
    def problem(self) -> str | None:
        """The reason as a sentence."""
        return None if self.reason is None else self.reason.message

    @property
    def must_hold(self) -> tuple[Point2, ...]:
        """The corners that must be held, garment frame (m)."""
        return tuple(vertex.point for vertex in self.vertices if vertex.must_be_held)

    def to_dict(self) -> dict[str, Any]:
        """Return the check as JSON."""
        return {
            "name": self.name,
            "kind": self.kind,
            "grips_needed": self.grips_needed,
            "grips": [list(grip) for grip in self.grips],
            "problem": self.problem,
            "vertices": [
                {"point": list(v.point), "must_be_held": v.must_be_held, "why": v.support.value} for v in self.vertices
            ],
        }


@dataclass(frozen=True, slots=True)
class GarmentCheck:
    """The measures of a garment, and the requirements of its folds.

    Attributes:
        points: the number of points of its outline.
        size_m: the extents of its drawing along x and y (m).
        area_m2: its area (m^2).
        folds: one entry for each fold in the user's order.
    """

    points: int
    size_m: Point2
    area_m2: float
    folds: tuple[FoldCheck, ...]

    @property
    def is_holdable(self) -> bool:
        """Whether the hands suffice for every fold."""
        return all(fold.problem is None for fold in self.folds)

    def to_dict(self) -> dict[str, Any]:
        """Return the check as JSON."""
        return {
            "outline": {"points": self.points, "size_m": list(self.size_m), "area_m2": self.area_m2},
            "is_holdable": self.is_holdable,
            "folds": [fold.to_dict() for fold in self.folds],
        }


def check_garment(garment: Garment, scene: Scene | None = None, *, robot: str = DEFAULT_ROBOT) -> GarmentCheck:
    """Check every fold of a garment, in the user's order.

    Args:
        garment: the garment.
        scene: for its support angle; None for the one that suits the robot.
        robot: the robot's name, for its number of arms.

    Raises:
        FoldError: a fold is not legal.
    """
    scene, machine = scene or default_scene(robot), load_robot(robot)
    reach = machine.reach(scene.torso_m, 0.0)
    context = Context(FoldSequence.of(garment), scene, reach, garment.placement, machine.card.base_radius_m)
    x0, y0, x1, y1 = garment.pattern.bounds
    folds = tuple(_checks(context))
    return GarmentCheck(len(garment.outline), (x1 - x0, y1 - y0), garment.pattern.area, folds)


def _checks(context: Context) -> Iterator[FoldCheck]:
    """Yield the check of every fold, each with what the fold before it may leave held."""
    angle, arms = context.scene.support_angle_rad, len(context.reach.arm_names)
    left_held: list[tuple[Point2, ...]] = []
    for fold in context.sequence.folds:
        done = (1 << fold.index) - 1
        found = context.sequence.covers(fold.index, angle, arms)
        if fold.is_red:
            held_sets = [c for held in left_held for c in held_covers(context, fold.index, _as_held(held))]
            covers = [tuple(h.point for h in cover) for cover in held_sets]
            obstacle = None if covers else _not_held(context, done, fold.index, left_held)
        else:
            covers = list(found.covers)
            obstacle = grips_obstacle(context, State(done, UNDRAGGED, 0, 0), fold.index)
        over = Isometry.reflection(fold.line)
        left_held = [tuple(over.apply_point(grip) for grip in cover) for cover in covers]
        yield FoldCheck(
            fold.name,
            fold.kind,
            vertex_checks(context.sequence.moving(fold.index), fold.line, angle),
            covers[0] if covers else (),
            len(covers[0]) if covers else found.count,
            None if obstacle is None else of_obstacle(context, obstacle),
        )


def _not_held(context: Context, done: int, fold: int, left_held: list[tuple[Point2, ...]]) -> Obstacle:
    """Return the obstacle that no grips left held by the fold before hold all that this fold needs."""
    held = _as_held(left_held[0]) if left_held else ()
    return Obstacle(fold, Code.RED_NEEDS_HOLD, None, 1.0, State(done, UNDRAGGED, 0, 0, held))


def _as_held(grips: tuple[Point2, ...]) -> tuple[Held, ...]:
    return tuple(Held(arm, grip) for arm, grip in enumerate(grips))
