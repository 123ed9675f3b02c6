"""Find dependencies between folds that overlap does not show.

Folds whose parts overlap must keep their order, and mostly that is all. But a line may end on the crease of an earlier
fold, or run along cloth that it laid down, with next to no overlap. Before the earlier fold is done, such a line is not
legal, or moves something else. So where the parts of two independent folds touch, the two are tried in reverse order,
and if that makes a difference they depend on each other after all.
"""

from collections.abc import Sequence

import networkx as nx

from planner.cloth.cloth_state import ClothState
from planner.cloth.fold_kinds import FOLD_KINDS
from planner.errors import FoldError
from planner.folds.fold import Fold
from planner.folds.fold_cloth import fold_cloth
from planner.geometry.region import Region
from planner.geometry.tolerance import AREA_M2, SNAP_M


def is_order_free(
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


def is_touching(line_of: Fold, part: Region) -> bool:
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
