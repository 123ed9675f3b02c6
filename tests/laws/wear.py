"""Random hoods, ponchos and jumpers with four to eight folds, as people fold them: flaps in, sides in, halved."""

import math
from collections.abc import Sequence
from dataclasses import replace
from random import Random
from typing import TypeVar

import numpy as np

from planner.cloth.garment import DrawnFold, Garment
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.task.scene import Scene
from tests.builders import fold, garment, spread
from tests.laws.outlines import Outline
from tests.laws.scenes import Problem
from tests.laws.tasks import after_fold, lying, smaller_part_over

T = TypeVar("T")

Line = tuple[int, float]
"""A line across the cloth as it lies: the axis along which its place is told (0: x, 1: y), and its share of the way."""

Drawn = tuple[Outline, list[DrawnFold], list[Line]]
"""An outline, folds between its corners, and the lines over which the rest is folded then."""


def wear_task(rng: Random) -> Problem:
    """Return a hood, poncho or jumper in front of the robot, with the default scene."""
    outline, corners, lines = rng.choice((_hood, _poncho, _jumper))(rng)
    worn = _folded(outline, corners, lines)
    middle = np.array(outline).min(axis=0) / 2 + np.array(outline).max(axis=0) / 2
    yaw = -math.pi / 2 + rng.choice((0.0, 0.0, rng.uniform(-0.1, 0.1)))
    placement = lying(middle, rng.uniform(-0.5, -0.4), rng.choice((0.0, rng.uniform(-0.1, 0.1))), yaw)
    return Problem(replace(worn, placement=placement), Scene(), "front", 0.03)


def _folded(outline: Outline, corners: Sequence[DrawnFold], lines: Sequence[Line]) -> Garment:
    """Return a garment folded between corners, and then over lines, the smaller part each time."""
    cloth, folds, done = spread(outline), list(corners), list[Segment]()
    for drawn in corners:
        line, cloth = _required(after_fold(cloth, drawn, done))
        done.append(line)
    for across in lines:
        drawn = _required(smaller_part_over(cloth.silhouette, _across(cloth.silhouette, *across), "blue"))
        line, cloth = _required(after_fold(cloth, drawn, done))
        folds.append(drawn)
        done.append(line)
    return garment(outline, *folds)


def _across(silhouette: Region, axis: int, share: float) -> Segment:
    low, high = np.array(silhouette.bounds).reshape(2, 2)
    at = low + share * (high - low)
    along = np.array([1.0 - axis, float(axis)])[::-1]
    return Segment((float(at[0]), float(at[1])), (float(at[0] + along[0]), float(at[1] + along[1])))


def _required(found: T | None) -> T:
    if found is None:
        raise ValueError("a fold of a garment drawn here is not legal")
    return found


def _hood(rng: Random) -> Drawn:
    """Return a hooded top whose sleeves point down: sleeves, sides, and halves; sometimes the hood first."""
    wide, low, high = rng.uniform(0.3, 0.4), rng.uniform(0.24, 0.34), rng.uniform(0.38, 0.5)
    out, cuff = rng.uniform(0.13, 0.25), rng.uniform(0.04, 0.07)
    neck, hood = 0.3 * wide, rng.uniform(0.14, 0.18)
    shoulder = high + rng.uniform(0.01, 0.03)
    right = [
        (wide, 0.0),
        (wide, low),
        (wide + out - cuff, low - 0.25 * out),
        (wide + out, low - 0.25 * out + 1.6 * cuff),
        (wide, high),
        (wide - neck, shoulder),
        (wide - 1.07 * neck, shoulder + hood),
    ]
    corners = [fold((0.0, low), (0.0, high)), fold((wide, high), (wide, low))]
    if rng.random() < 0.5:
        corners.insert(0, fold((neck, shoulder), (wide - neck, shoulder)))
    in_m = rng.uniform(0.24, 0.3) * wide
    return _symmetric(right, wide), corners, [*_sides(in_m / wide), *_halves(rng.choice((1, 2)))]


def _jumper(rng: Random) -> Drawn:
    """Return a top with straight long sleeves: sleeves, their ends back, sides, and halves."""
    wide, high = rng.uniform(0.3, 0.4), rng.uniform(0.45, 0.55)
    low, out = high - rng.uniform(0.12, 0.16), rng.uniform(0.18, 0.3)
    drop = rng.uniform(0.0, 0.05)
    right = [(wide, 0.0), (wide, low), (wide + out, low - drop), (wide + out, high - drop - 0.02), (wide, high)]
    corners = [fold((0.0, low), (0.0, high)), fold((wide, high), (wide, low))]
    return _symmetric(right, wide), corners, [*_sides(rng.uniform(0.22, 0.3)), *_halves(rng.choice((1, 2, 3)))]


def _poncho(rng: Random) -> Drawn:
    """Return a square with its corners cut off: two corners or sides in, then halves along and across."""
    wide = rng.uniform(0.45, 0.6)
    cut = rng.uniform(0.08, 0.3) * wide
    right = [(wide - cut, 0.0), (wide, cut), (wide, wide - cut), (wide - cut, wide)]
    halves = [(1, rng.uniform(0.47, 0.53)), (0, 0.49)]
    again = [(1, 0.51)] if rng.random() < 0.5 else []
    return _symmetric(right, wide), [], [*_sides(rng.uniform(0.15, 0.25)), *halves, *again]


def _symmetric(right: Sequence[Point2], wide: float) -> Outline:
    """Return the outline of which the right half is given, from below to above."""
    return (*right, *((wide - x, y) for x, y in reversed(right)))


def _sides(share: float) -> list[Line]:
    """Return upright lines at an equal distance from both sides, a share of the width."""
    return [(0, share), (0, 1.0 - share / (1.0 - share))]


def _halves(count: int) -> list[Line]:
    """Return level lines that halve what is left each time, a little off the middle."""
    return [(1, share) for share in (0.49, 0.47, 0.48)[:count]]
