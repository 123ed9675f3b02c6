"""Builders that many tests use: regions, garments, folds, a robot that reaches everything."""

import math
import random
from collections.abc import Sequence
from itertools import combinations
from typing import TypedDict

import numpy as np

from planner.cloth.cloth_state import ClothState
from planner.cloth.garment import DrawnFold, Garment, centred_placement
from planner.cloth.layer import Layer
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.pose import FloatArray, Point2, Pose2
from planner.geometry.region import Region
from planner.primitives.context import Context
from planner.task.scene import Scene
from tests.wide_reach import WideReach

CIRCLE_M = 0.47


class SceneFields(TypedDict, total=False):
    """Fields of a scene that a task may be made wider or narrower by."""

    friction: float
    approach_cone_rad: float
    back_off_max_m: float


def rectangle(width_m: float, height_m: float, x_m: float = 0.0, y_m: float = 0.0) -> Region:
    """Return a rectangle with its lower left corner at a place."""
    return Region.polygon(rectangle_points(width_m, height_m, x_m, y_m))


def rectangle_points(width_m: float, height_m: float, x_m: float = 0.0, y_m: float = 0.0) -> tuple[Point2, ...]:
    x1, y1 = x_m + width_m, y_m + height_m
    return ((x_m, y_m), (x1, y_m), (x1, y1), (x_m, y1))


def star(rng: random.Random, corners: int) -> tuple[Point2, ...]:
    """Return a simple polygon, mostly not convex, that winds once round the origin."""
    turns = sorted(rng.uniform(0.0, math.tau) for _ in range(corners))
    reach = [rng.uniform(0.15, 0.5) for _ in turns]
    return tuple((r * math.cos(a), r * math.sin(a)) for r, a in zip(reach, turns, strict=True))


def noisy(ring: FloatArray, count: int, amplitude_m: float, rng: random.Random) -> FloatArray:
    """Return about `count` points along a ring, each up to an amplitude (m) beside its place, as if traced."""
    sides = np.roll(ring, -1, axis=0) - ring
    lengths = np.hypot(*sides.T)
    parts = [max(1, round(count * length / lengths.sum())) for length in lengths]
    points = [
        start + side * (number / part)
        for start, side, part in zip(ring, sides, parts, strict=True)
        for number in range(part)
    ]
    turns = [rng.uniform(0.0, math.tau) for _ in points]
    beside = [amplitude_m * rng.random() * np.array([math.cos(turn), math.sin(turn)]) for turn in turns]
    return np.asarray(np.array(points) + np.array(beside))


def fold(start: Point2, end: Point2, kind: str = "blue", name: str = "a fold", radius_m: float = 0.127) -> DrawnFold:
    return DrawnFold(name, kind, start, end, radius_m)


def garment(outline: Sequence[Point2], *folds: DrawnFold, placement: Pose2 | None = None) -> Garment:
    """Return a garment of the given folds; by default it lies in the middle of the table."""
    points = tuple(outline)
    return Garment("cloth", "Cloth", points, 0.2, folds, 0.127, placement or centred_placement(points))


def spread(outline: Sequence[Point2]) -> ClothState:
    return ClothState.spread_out(Region.polygon(outline))


def is_same_stack(one: ClothState, other: ClothState) -> bool:
    """Return whether the same pieces lie at the same places, stacked alike wherever they overlap."""
    if len(one.layers) != len(other.layers):
        return False
    partner = []
    for layer in one.layers:
        twins = [i for i, twin in enumerate(other.layers) if i not in partner and is_same_layer(layer, twin)]
        if not twins:
            return False
        partner.append(twins[0])
    for low, high in combinations(range(len(partner)), 2):
        is_turned = partner[low] > partner[high]
        if is_turned and not one.layers[low].region.intersection(one.layers[high].region).is_sliver:
            return False
    return True


def is_same_layer(one: Layer, other: Layer) -> bool:
    corners = one.pattern_piece.coordinates
    gaps = one.isometry.apply(corners) - other.isometry.apply(corners)
    is_same_place = one.face == other.face and float(np.abs(gaps).max()) < 1e-5
    return is_same_place and is_same_region(one.pattern_piece, other.pattern_piece)


def is_same_region(one: Region, other: Region, area_m2: float = 2e-5) -> bool:
    """Return whether two regions differ by less than a sliver."""
    return one.difference(other).area + other.difference(one).area < area_m2


def context(cloth: Garment, scene: Scene | None = None, reach: WideReach | None = None) -> Context:
    """Return a planning context for a robot that reaches everything by default."""
    return Context(FoldSequence.of(cloth), scene or Scene(), reach or WideReach(), cloth.placement, CIRCLE_M)


def evenly_along(ring: FloatArray, spacing_m: float) -> FloatArray:
    """Return points along a closed ring, shape (n, 2), at most a distance apart, its corners among them (m)."""
    parts = []
    for start, end in zip(ring, np.roll(ring, -1, axis=0), strict=True):
        count = max(1, math.ceil(float(np.hypot(*(end - start))) / spacing_m))
        parts.append(start + np.arange(count)[:, None] / count * (end - start))
    return np.concatenate(parts)
