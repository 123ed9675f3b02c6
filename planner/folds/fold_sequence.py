"""A garment with its folds made legal, and the cloth after each of them.

The folds are replayed once in the user's order. The replay snaps each line, finds the part that moves and where it
lands, and yields the Fold-DAG. Every order that the DAG allows leaves the same stack. So the cloth after a set of folds
is found by doing that set in the user's order, except that an unfinished chain comes last. Results are cached.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import networkx as nx
import numpy as np

from planner.cloth.cloth_state import ClothState
from planner.cloth.fold_kinds import FOLD_KINDS
from planner.cloth.garment import Garment
from planner.cloth.grips import GripCovers, grip_covers
from planner.cloth.must_hold import must_hold
from planner.errors import FoldError
from planner.folds.fold import Fold, snapped_line
from planner.folds.fold_cloth import Folded, fold_cloth
from planner.folds.fold_dag import FoldDag, overlap_graph, reduced
from planner.folds.fold_path import RestHeights
from planner.folds.missed_flap import flap_missed, is_flap_missed
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import AREA_M2, SNAP_M

_REMEMBERED = 12
"""The number of garments whose replays are cached."""


@dataclass(frozen=True)
class FoldSequence:
    """The folds of one garment.

    Attributes:
        garment: the garment.
        folds: the legal folds in the user's order.
        dag: the order in which they must precede each other.
        final: the stack after all of them.
    """

    garment: Garment
    folds: tuple[Fold, ...]
    dag: FoldDag
    final: ClothState
    _folded: dict[tuple[int, int], Folded]
    _cloths: dict[int, ClothState]
    _covers: dict[tuple[int, float, int], GripCovers]

    @staticmethod
    def of(garment: Garment) -> "FoldSequence":
        """Replay a garment's folds in the user's order.

        Raises:
            FoldError: a fold is not legal; the field names it, as ``folds[2].start``.
        """
        cloth = ClothState.spread_out(garment.pattern)
        cloths, parts = {0: cloth}, {}
        folds: list[Fold] = []
        for index in range(len(garment.folds)):
            try:
                fold, folded = _replay(garment, index, cloth, folds)
            except FoldError as error:
                raise error.within(f"folds[{index}]") from None
            folds.append(fold)
            cloth = folded.cloth
            parts[(1 << index) - 1, index] = folded
            cloths[(2 << index) - 1] = cloth
        dag = _dag(garment.pattern, folds, [folded.moving for folded in parts.values()])
        return FoldSequence(garment, tuple(folds), dag, cloth, parts, cloths, {})

    def to_dict(self) -> dict[str, Any]:
        """Return the Fold-DAG and the final stack, bottom to top, as JSON."""
        return {**self.dag.to_dict(), "layers": [layer.to_dict() for layer in self.final.layers]}

    def cloth(self, done: int) -> ClothState:
        """Return the stack after a set of folds, given as a bit mask.

        The last fold done of an unfinished chain comes last, because a red fold takes the layers that it moved.
        """
        if done not in self._cloths:
            last = self.last_done(done)
            self._cloths[done] = self.folded(done & ~(1 << last), last).cloth
        return self._cloths[done]

    def last_done(self, done: int) -> int:
        """Return the fold that `cloth` takes to be the last of a set of folds, which is not empty."""
        begun = self.dag.last_of_begun_chain(done)
        return done.bit_length() - 1 if begun is None else begun

    def folded(self, done: int, index: int) -> Folded:
        """Return the result of one more fold on the stack after a set of folds."""
        key = (done, index)
        if key not in self._folded:
            fold = self.folds[index]
            crease = self.folds[index - 1].line if fold.is_red else None
            self._folded[key] = fold_cloth(self.cloth(done), fold.line, fold.kind, crease)
        return self._folded[key]

    def moving(self, index: int) -> Region:
        """Return the silhouette of the part that a fold moves, before it moves.

        By the DAG's law it is the same after every set of folds that the fold may follow. So the known one, of the
        replay in the user's order, is returned; folding the cloth anew for every set would take most of a search's
        time.
        """
        return self.folded((1 << index) - 1, index).moving

    def rests(self, done: int) -> RestHeights:
        """Return the heights at which tools rest at the stack after a set of folds."""
        return RestHeights(self.cloth(done), self.garment.thickness_m)

    def rests_of(self, index: int) -> tuple[RestHeights, RestHeights] | None:
        """Return the heights at which tools rest before and after a fold; None if they are the same everywhere.

        Whatever overlaps the fold's part is done before it or after it in any order, so the user's order serves.
        """
        found = self.rests((1 << index) - 1), self.rests((2 << index) - 1)
        return None if found[0].are_even and found[1].are_even else found

    @cached_property
    def covered(self) -> FloatArray:
        """Points whose extent contains the cloth after any set of folds, shape (n, 2), m.

        They are the parts' outlines before and after they move.
        """
        parts = (self.moving(fold.index) for fold in self.folds)
        landed = (
            Isometry.reflection(fold.line).apply(part.coordinates) for fold, part in zip(self.folds, parts, strict=True)
        )
        return np.concatenate([self.garment.pattern.coordinates, *landed])

    def covers(self, index: int, support_angle_rad: float, arms: int) -> GripCovers:
        """Return the points that must be held during a fold, and the best grips for them."""
        key = (index, support_angle_rad, arms)
        if key not in self._covers:
            fold, moving = self.folds[index], self.moving(index)
            vertices = must_hold(moving, fold.line.left, (fold.line,), support_angle_rad)
            if not len(vertices):  # cloth so stiff that it holds itself, but to be folded it must be taken somewhere
                vertices = moving.coordinates[[np.argmax(fold.line.left_distances(moving.coordinates))]]
            self._covers[key] = grip_covers(moving, vertices, fold.grip_radius_m, arms, (fold.line,))
        return self._covers[key]


def fold_dag(garment: Garment) -> FoldSequence:
    """Return a garment's folds made legal, with their Fold-DAG; `FoldSequence.to_dict` is its JSON.

    Raises:
        FoldError: a fold is not legal; the field names it.
    """
    return replayed(garment)


replayed = lru_cache(_REMEMBERED)(FoldSequence.of)
"""Replay a garment's folds; the sequences of the latest garments, with all they have cached, are kept."""


def _dag(pattern: Region, folds: list[Fold], moving: list[Region]) -> FoldDag:
    """Return the order of folds: by overlap, and by trial where parts merely touch.

    Folds whose parts overlap must keep their order, and mostly that is all. But a line may end on the crease of an
    earlier fold, or run along cloth that it laid down, with next to no overlap. Before the earlier fold is done, such a
    line is not legal, or moves something else. So where the parts of two independent folds touch, the two are tried in
    reverse order, and if that makes a difference they depend on each other after all.
    """
    red = [fold.is_red for fold in folds]
    parts = [
        Region.union([part, part.moved(Isometry.reflection(fold.line))])
        for part, fold in zip(moving, folds, strict=True)
    ]
    graph = overlap_graph(parts, red)
    for b, later in enumerate(folds):
        for a, earlier in enumerate(folds[:b]):
            is_near = _is_touching(later, parts[a]) or _is_touching(earlier, parts[b])
            if is_near and not nx.has_path(graph, a, b) and not _is_order_free(pattern, folds, moving, graph, a, b):
                graph.add_edge(a, b)
    return reduced(graph, red)


def _replay(garment: Garment, index: int, cloth: ClothState, before: list[Fold]) -> tuple[Fold, Folded]:
    drawn = garment.folds[index]
    if drawn.is_red and is_flap_missed(cloth, Segment(drawn.start, drawn.end)):
        raise FoldError("start", flap_missed(before[-1].name))
    line = snapped_line(drawn, FOLD_KINDS[drawn.kind].silhouette(cloth))
    fold = Fold(index, drawn.name, drawn.kind, line, drawn.grip_radius_m)
    crease = before[-1].line if drawn.is_red else None
    return fold, fold_cloth(cloth, line, drawn.kind, crease)


def _is_order_free(
    pattern: Region, folds: Sequence[Fold], moving: Sequence[Region], dag: "nx.DiGraph[int]", a: int, b: int
) -> bool:
    """Return whether fold b, and then fold a with all that waits for it, moves the same as in the user's order.

    Args:
        pattern: the cloth spread out.
        folds: the folds in the user's order, at least up to b.
        moving: for each the part that it moves in that order, before it moves, garment frame.
        dag: the dependencies found so far.
        a: the earlier fold.
        b: the later fold, to which no path leads from a.
    """
    chain = _chain(folds, a)
    later = {f for c in chain for f in (c, *nx.descendants(dag, c)) if f < b}
    order = [i for i in range(b) if i not in later] + [b] + [i for i in range(b) if i in later]
    cloth = ClothState.spread_out(pattern)
    for index in order:
        fold = folds[index]
        kind, crease = FOLD_KINDS[fold.kind], folds[index - 1].line if fold.is_red else None
        if not kind.is_snapped(fold.line, kind.silhouette(cloth)):
            return False
        try:
            folded = fold_cloth(cloth, fold.line, fold.kind, crease)
        except FoldError:
            return False
        if not _is_same(folded.moving, moving[index]):
            return False
        cloth = folded.cloth
    return True


def _is_touching(line_of: Fold, part: Region) -> bool:
    """Return whether a fold's line comes near another fold's part."""
    return part.distance_to(line_of.line) <= SNAP_M


def _chain(folds: Sequence[Fold], index: int) -> list[int]:
    """Return the chain that contains a fold: a blue fold and the red ones after it."""
    first = index
    while folds[first].is_red:
        first -= 1
    last = first + 1
    while last < len(folds) and folds[last].is_red:
        last += 1
    return list(range(first, last))


def _is_same(one: Region, other: Region) -> bool:
    return one.difference(other).area + other.difference(one).area <= AREA_M2
