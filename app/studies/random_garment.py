"""Random garments: a star-shaped outline, and folds along random chords, each legal when its turn comes.

The same seed gives the same garment on every machine: corners and ends of folds are on a grid of a millimetre.
"""

import math
import random
from dataclasses import dataclass

from planner.cloth.cloth_state import ClothState
from planner.cloth.garment import DEFAULT_DENSITY_KG_M2, DEFAULT_GRIP_RADIUS_M, DrawnFold, Garment, centred_placement
from planner.cloth.outline import require_simple_outline
from planner.errors import FieldError, GarmentError
from planner.folds.fold import snapped_line
from planner.folds.fold_cloth import fold_cloth
from planner.geometry.chord import nearest_chord
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.split import split_along

_TRIES = 40
"""Chords tried for a fold before the garment is left with fewer folds."""

_LEAST_SHARE = 0.1
"""The smallest share of the cloth that a fold moves."""


@dataclass(frozen=True, slots=True)
class RandomShape:
    """The distribution of random garments.

    Attributes:
        corners: the least and the most corners.
        folds: the least and the most folds.
        size_m: the least and the largest diameter (m).
    """

    corners: tuple[int, int] = (4, 8)
    folds: tuple[int, int] = (1, 3)
    size_m: tuple[float, float] = (0.3, 0.7)


def random_garment(seed: int, shape: RandomShape) -> Garment:
    """Return the garment of a seed, in the middle of the table; it may have fewer folds where few are legal."""
    draw = random.Random(seed)
    outline = _outline(draw, shape)
    cloth = ClothState.spread_out(Region.polygon(outline))
    folds: list[DrawnFold] = []
    for _ in range(draw.randint(*shape.folds)):
        for _ in range(_TRIES):
            fold = _fold(draw, cloth.silhouette, f"fold {len(folds) + 1}")
            if fold is not None and (after := _folded(cloth, fold)) is not None:
                folds.append(fold)
                cloth = after
                break
    return Garment(
        f"random-{seed}",
        f"Random {seed}",
        outline,
        DEFAULT_DENSITY_KG_M2,
        tuple(folds),
        DEFAULT_GRIP_RADIUS_M,
        centred_placement(outline),
    )


def _outline(draw: random.Random, shape: RandomShape) -> tuple[Point2, ...]:
    while True:
        corners, size = draw.randint(*shape.corners), draw.uniform(*shape.size_m)
        turns = sorted(draw.random() for _ in range(corners))
        radii = [size / 2 * draw.uniform(0.6, 1.0) for _ in turns]
        outline = tuple(
            (round(r * math.cos(math.tau * t), 3), round(r * math.sin(math.tau * t), 3))
            for r, t in zip(radii, turns, strict=True)
        )
        try:
            require_simple_outline(outline)
        except GarmentError:
            continue
        return outline


def _fold(draw: random.Random, silhouette: Region, name: str) -> DrawnFold | None:
    """Return a fold of the smaller part of the cloth along a random chord; None where that part is too small."""
    x0, y0, x1, y1 = silhouette.bounds
    through, turn = (draw.uniform(x0, x1), draw.uniform(y0, y1)), draw.uniform(0.0, math.tau)
    guide = Segment(through, (through[0] + math.cos(turn), through[1] + math.sin(turn)))
    chord = nearest_chord(silhouette, guide)
    parts = None if chord is None else split_along(silhouette, chord)
    if chord is None or parts is None:
        return None
    left, right = (part.area for part in parts)
    if min(left, right) < _LEAST_SHARE * (left + right):
        return None
    start, end = (chord.start, chord.end) if left <= right else (chord.end, chord.start)
    try:
        return DrawnFold(name, "blue", _on_grid(start), _on_grid(end), DEFAULT_GRIP_RADIUS_M)
    except GarmentError:
        return None


def _folded(cloth: ClothState, fold: DrawnFold) -> ClothState | None:
    """Return the cloth after a fold; None if it is not legal."""
    try:
        return fold_cloth(cloth, snapped_line(fold, cloth.silhouette), fold.kind).cloth
    except FieldError:
        return None


def _on_grid(point: Point2) -> Point2:
    return (round(point[0], 3), round(point[1], 3))
