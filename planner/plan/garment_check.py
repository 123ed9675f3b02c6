"""Whether a garment's folds are legal, and by how many grippers each can be held."""

from dataclasses import dataclass

from planner.cloth.garment import Garment
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.pose import Point2
from planner.primitives.scene import Scene
from planner.robot.pr2 import load_robot


@dataclass(frozen=True, slots=True)
class FoldCheck:
    """What one fold needs.

    Attributes:
        name: the fold's name.
        must_hold: the vertices that must be held, article frame (m).
        grips: the grips that hold them, article frame (m); empty when the arms do not suffice.
        grips_needed: how many; None when more than there are arms.
    """

    name: str
    must_hold: tuple[Point2, ...]
    grips: tuple[Point2, ...]
    grips_needed: int | None


@dataclass(frozen=True, slots=True)
class GarmentCheck:
    """What all folds need.

    Attributes:
        folds: one entry for each fold in the user's order.
    """

    folds: tuple[FoldCheck, ...]

    @property
    def is_holdable(self) -> bool:
        """Whether the arms suffice for every fold."""
        return all(fold.grips_needed is not None for fold in self.folds)


def check_garment(garment: Garment, scene: Scene | None = None, *, robot: str = "pr2") -> GarmentCheck:
    """Check every fold of a garment, in the user's order.

    Args:
        garment: the garment.
        scene: for its support angle; None for the default scene.
        robot: the robot's name, for its number of arms.

    Raises:
        FoldError: a fold is not legal.
    """
    sequence = FoldSequence.of(garment)
    support_angle_rad = (scene or Scene()).support_angle_rad
    arms = len(load_robot(robot).card.arms)
    checks = []
    for fold in sequence.folds:
        found = sequence.covers((1 << fold.index) - 1, fold.index, support_angle_rad, arms)
        grips = found.covers[0] if found.covers else ()
        checks.append(FoldCheck(fold.name, found.vertices, grips, found.count))
    return GarmentCheck(tuple(checks))
