"""Fold a stack of layers: cut along the segment, reflect the left part, lay it on top (paper, section 6)."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from planner.cloth.cloth_state import ClothState
from planner.cloth.cut_line import require_both
from planner.cloth.fold_kinds import FOLD_KINDS
from planner.cloth.layer import Layer
from planner.errors import FoldError
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M
from planner.message import Message

_FOLDED_KEPT = 256
"""The number of folds whose results are cached."""


@dataclass(frozen=True)
class Folded:
    """The result of one fold.

    Attributes:
        cloth: the stack afterwards.
        moving: the silhouette of the part that moved, before it moved.
        layers: the layers that moved, before they moved, bottom to top.
    """

    cloth: ClothState
    moving: Region
    layers: tuple[Layer, ...]


@lru_cache(_FOLDED_KEPT)
def fold_cloth(cloth: ClothState, line: Segment, kind: str, crease: Segment | None = None) -> Folded:
    """Fold the cloth to the left of a line over it. Cached, because drawing, checking and planning all repeat it.

    Args:
        cloth: the stack before.
        line: the fold line, garment frame.
        kind: the fold's kind, by name.
        crease: the line of the fold before, which joins the layers that a red fold moves to the rest; others take no
            notice of it.

    Raises:
        FoldError: no cloth lies to the left or to the right of the line, the line does not part the cloth, or a red
            fold would tear it.
    """
    rule = FOLD_KINDS[kind]
    active = rule.layers(cloth)
    below = cloth.layers[: len(cloth.layers) - len(active)]
    moving = rule.moving(rule.silhouette(cloth), line)
    if below and crease is not None:
        _require_no_tear(moving, line, crease)
    stays: list[Layer] = []
    moves: list[Layer] = []
    slivers = list(cloth.slivers)
    for layer in active:
        inside, outside, dropped = ((layer,), (), ()) if rule.is_whole else layer.cut(line, moving)
        moves.extend(inside)
        stays.extend(outside)
        slivers.extend(dropped)
    require_both(bool(moves), rule.is_whole or bool(stays))
    landed = [layer.reflected(line) for layer in reversed(moves)]
    return Folded(ClothState([*below, *stays, *landed], len(landed), slivers), moving, tuple(moves))


def _require_no_tear(moving: Region, line: Segment, crease: Segment) -> None:
    """Raise unless a red fold leaves the crease that joins its layers to the rest in place.

    Raises:
        FoldError: the moving part reaches along the crease.
    """
    for end_a, end_b in moving.overlaps_with(crease):
        off_line = np.abs(line.left_distances(np.array([end_a, end_b])))
        if off_line.max() > LENGTH_M:
            along_m = float(off_line.max())
            mm = f"{along_m * 1000:.1f} mm"
            text = f"the part that moves reaches {mm} along the crease of the fold before: it would tear"
            raise FoldError("start", Message("would_tear", text, {"along_m": along_m}))
