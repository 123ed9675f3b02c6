"""The solution of a drawing: the lines of its folds, the cloth before each of them, and the problems."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from app.drawing.drawing import Drawing
from app.drawing.problem import Problem
from planner.cloth.cloth_state import ClothState
from planner.cloth.garment import Garment
from planner.folds.attachment import Replay
from planner.folds.fold_cloth import Folded
from planner.geometry.isometry import Isometry
from planner.geometry.region import Region
from planner.geometry.segment import Segment

Ring: TypeAlias = list[list[float]]


@dataclass(frozen=True)
class Solution:
    """A solved drawing.

    Attributes:
        drawing: the drawing with the folds' ends at their current positions.
        problems: the problems; empty if the drawing can be planned.
        replay: the cloth before each legal fold, up to the first illegal one; None without a valid outline.
        folded: the results of the legal folds.
        garment: the garment to plan; None while there are problems.
        spread: the garment with the legal folds, for display; None without a valid outline.
        steps: the cloth step by step, as JSON (see `steps_of`).
    """

    drawing: Drawing
    problems: tuple[Problem, ...]
    replay: Replay | None
    folded: tuple[Folded, ...]
    garment: Garment | None
    spread: Garment | None
    steps: list[dict[str, Any]]

    @property
    def cloths(self) -> tuple[ClothState, ...]:
        """The stack before each legal fold, and after the last."""
        return self.replay.cloths if self.replay else ()

    def layers(self) -> list[dict[str, Any]]:
        """Return as JSON the layers of each of `cloths`, bottom to top, and whether the last fold moved them."""
        return [
            {"layers": [{**layer.to_dict(), "moved": layer in cloth.flap} for layer in cloth.layers]}
            for cloth in self.cloths
        ]

    def fold_states(self) -> list[dict[str, Any]]:
        """Return as JSON the status of each fold (legal, illegal or unchecked) and its ends (m)."""
        return [
            {"fold": fold.id, "status": self._status(i), "start": list(fold.start.point), "end": list(fold.end.point)}
            for i, fold in enumerate(self.drawing.folds)
        ]

    def _status(self, index: int) -> str:
        if index < len(self.folded):
            return "legal"
        return "illegal" if any(problem.fold == index for problem in self.problems) else "unchecked"


def steps_of(replay: Replay, folded: Sequence[Folded]) -> list[dict[str, Any]]:
    """Return as JSON, for each fold, the silhouette, the moving cloth and where it lands; then the last silhouette."""
    steps: list[dict[str, Any]] = []
    flap: list[Ring] = []
    for cloth, fold, line in zip(replay.cloths, folded, replay.lines, strict=False):
        landed = landed_rings(fold.moving, line)
        steps.append(
            {"silhouette": rings(cloth.silhouette), "flap": flap, "moving": rings(fold.moving), "landed": landed}
        )
        flap = landed
    last = rings(replay.cloths[-1].silhouette)
    return [*steps, {"silhouette": last, "flap": flap, "moving": None, "landed": None}]


def rings(region: Region) -> list[Ring]:
    """Return the outer rings of a region's parts, counter-clockwise, as JSON (m)."""
    return [ring.tolist() for ring in region.rings]


def landed_rings(moving: Region, line: Segment) -> list[Ring]:
    """Return the outer rings of a region reflected over a line, counter-clockwise, as JSON (m)."""
    over = Isometry.reflection(line)
    return [over.apply(ring)[::-1].tolist() for ring in moving.rings]
