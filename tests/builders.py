"""Builders that many tests use: regions, garments, folds, a robot that reaches everything."""

import math
import random
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import TypedDict

import numpy as np
from numpy.typing import NDArray

from planner.cloth.cloth_state import ClothState
from planner.cloth.garment import DrawnFold, Garment, centred_placement
from planner.cloth.layer import Layer
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.driving import IMPOSSIBLE, Driving, Wanted
from planner.geometry.pose import Approach, BoolArray, FloatArray, Point2, Pose2
from planner.geometry.region import Region
from planner.primitives.context import Context
from planner.task.scene import Scene

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


class WideReach:
    """A robot whose arms reach every place from every standoff, or from those that a test allows."""

    arm_names = ("left", "right")
    approaches: tuple[Approach, ...] = (Approach(0.0, math.radians(30.0)), Approach(0.0, math.pi / 2))
    shoulders = ((-0.05, 0.19, 0.97), (-0.05, -0.19, 0.97))
    queries = 0
    query_time_s = 0.0

    def __init__(self, allowed: Callable[[int, FloatArray, int], bool] | None = None) -> None:
        """Set `allowed`, a function of an arm's index, a point in the base frame at standoff 0, and a standoff."""
        self._allowed = allowed or (lambda arm, point, standoff: True)

    def share(self) -> None:
        pass

    def forget(self) -> None:
        pass

    def standoffs(
        self,
        arm: int,
        points: FloatArray,
        approaches: NDArray[np.int64],
        count: int,
        step_m: float,
        enough: int | None = None,
        start: int | None = None,
    ) -> NDArray[np.uint32]:
        row = [sum(1 << j for j in range(count) if self._allowed(arm, point, j)) for point in points]
        row = connected(row, count, start)
        return np.array([row] * len(approaches), dtype=np.uint32).reshape(len(approaches), len(points))

    def following(
        self, arms: tuple[int, ...], paths: FloatArray, approaches: tuple[NDArray[np.int64], ...], step_m: float
    ) -> "WideFollowing":
        return WideFollowing(self._allowed, arms, paths)

    def from_anywhere(
        self,
        arm: int,
        points: FloatArray,
        approaches: NDArray[np.int64],
        count: int,
        step_m: float,
        enough: int | None = None,
    ) -> BoolArray:
        seen = [any(self._allowed(arm, point, j) for j in range(count)) for point in points]
        return np.array([seen] * len(approaches), dtype=bool).reshape(len(approaches), len(points))


@dataclass(frozen=True)
class WideFollowing:
    """Hands of such a robot on their paths: every approach is as good, so the first of each hand will do."""

    allowed: Callable[[int, FloatArray, int], bool]
    arms: tuple[int, ...]
    paths: FloatArray

    def least_driving(
        self, begun: NDArray[np.int64], most: int = IMPOSSIBLE - 1, wanted: Wanted = "unbeaten"
    ) -> Driving:
        """Return all ways by relaxation over waypoints and standoffs; `most` is ignored."""
        count = len(begun)
        first = np.arange(count)
        steps = begun.copy()
        for waypoint in range(self.paths.shape[1]):
            hands = list(zip(self.arms, self.paths[:, waypoint], strict=True))
            is_good = [all(self.allowed(arm, point, j) for arm, point in hands) for j in range(count)]
            steps = np.where(is_good, steps, IMPOSSIBLE)
            for _ in range(count):
                for j, beside in [(j, j + side) for j in range(count) for side in (-1, 1) if 0 <= j + side < count]:
                    if is_good[j] and steps[beside] + 1 < steps[j]:
                        steps[j], first[j] = steps[beside] + 1, first[beside]
        if wanted == "unbeaten":
            driven = [
                min(steps[o] + abs(o - e) for o in range(count) if o != e) if count > 1 else IMPOSSIBLE
                for e in range(count)
            ]
            steps = np.where(steps < driven, steps, IMPOSSIBLE)
        steps = np.minimum(steps, IMPOSSIBLE)
        return Driving(steps, first, np.zeros((len(self.arms), count), dtype=np.int64), IMPOSSIBLE)


def connected(row: list[int], count: int, start: int | None = None) -> list[int]:
    """Return a row of masks without the standoffs that the base cannot have reached; all 0 if it gets stuck."""
    kept, before = [], (1 << count) - 1 if start is None else 1 << start
    for mask in row:
        stretches, at = [], 0
        for j in range(count + 1):
            if j < count and mask >> j & 1:
                at |= 1 << j
            elif at:
                stretches.append(at)
                at = 0
        before = sum(s for s in stretches if s & before)
        kept.append(before)
    return kept if before else [0] * len(row)


def context(cloth: Garment, scene: Scene | None = None, reach: WideReach | None = None) -> Context:
    """Return a planning context for a robot that reaches everything by default."""
    wide = reach or WideReach()  # without what explanations ask
    return Context(FoldSequence.of(cloth), scene or Scene(), wide, cloth.placement, CIRCLE_M)  # type: ignore[arg-type]
