"""Cloth without a robot: a garment spread out on a table, or folded there by nobody."""

from dataclasses import dataclass, replace

from planner.cloth.garment import Garment
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.table import Table
from planner.geometry.table_top import TableTop
from planner.motion.cloth_surface import ClothMoment, ClothSurfaces
from planner.motion.sample import ClothSurface
from planner.task.phase import ClothMotion


@dataclass(frozen=True, slots=True)
class ClothAlone:
    """A garment that is folded where it lies, each fold in the same time.

    Attributes:
        sequence: the garment and its folds.
        table: the table over whose edges it hangs.
    """

    sequence: FoldSequence
    table: Table
    _surfaces: ClothSurfaces

    @staticmethod
    def of(sequence: FoldSequence, table: Table) -> "ClothAlone":
        """Return a garment at its placement on a table."""
        return ClothAlone(sequence, table, ClothSurfaces(sequence))

    def at(self, share: float) -> tuple[ClothSurface, frozenset[int]]:
        """Return the cloth after a share of all folds, 0 to 1, and the folds that are done by then."""
        count = len(self.sequence.folds)
        done = min(int(share * count), count)
        placement = self.sequence.garment.placement
        fold = done if done < count else None
        motion = ClothMotion((1 << done) - 1, placement, placement, TableTop.of(self.table), fold, (0.0, 2.0))
        moment = ClothMoment.of(motion, share * count - done, 1.0)
        return self._surfaces.at(moment), frozenset(range(done))


def spread_cloth(garment: Garment, table: Table) -> ClothSurface:
    """Return a garment at its placement before any fold, hanging where it extends beyond the table."""
    return ClothAlone.of(FoldSequence.of(replace(garment, folds=())), table).at(0.0)[0]
