"""Equivalent planning problems: in another order or frame, turned, mirrored."""

import math
from dataclasses import replace
from itertools import islice
from random import Random

import numpy as np

from planner.cloth.garment import DrawnFold, Garment
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.pose import Point2, Pose2
from tests.laws.fold_orders import orders
from tests.laws.scenes import Problem

MOST_ORDERS = 24


def snapped(garment: Garment) -> Garment:
    """Return the garment with its lines drawn where they are snapped to."""
    folds = FoldSequence.of(garment).folds
    drawn = zip(garment.folds, folds, strict=True)
    return replace(garment, folds=tuple(replace(d, start=f.line.start, end=f.line.end) for d, f in drawn))


def reordered(problem: Problem, rng: Random) -> Problem:
    """Return the garment with its folds in another order that the Fold-DAG allows."""
    garment = snapped(problem.garment)
    order = rng.choice(list(islice(orders(FoldSequence.of(garment).dag), MOST_ORDERS)))
    return replace(problem, garment=replace(garment, folds=tuple(garment.folds[i] for i in order)))


def redrawn(problem: Problem, turn_rad: float, by: Point2) -> Problem:
    """Return the cloth at the same place, drawn elsewhere in the garment frame and turned."""
    frame = Pose2(*by, turn_rad)

    def moved(point: Point2) -> Point2:
        x, y = frame.to_outer(np.array(point))
        return (float(x), float(y))

    origin = frame.to_inner(np.zeros(2))
    x, y = problem.garment.placement.to_outer(origin)
    placement = Pose2(float(x), float(y), problem.garment.placement.yaw_rad - turn_rad)
    garment = snapped(problem.garment)
    folds = tuple(replace(f, start=moved(f.start), end=moved(f.end)) for f in garment.folds)
    outline = tuple(moved(p) for p in garment.outline)
    return replace(problem, garment=replace(garment, outline=outline, folds=folds, placement=placement))


def mirrored(problem: Problem) -> Problem:
    """Return the problem mirrored at the table's middle: y -> -y on the table, x -> -x in the drawing.

    With the placement p -> R(yaw) p + t the mirror image of the cloth at yaw lies at pi - yaw:
    diag(1, -1) R(yaw) diag(-1, 1) = R(pi - yaw). What was to the left of a fold's line is to its right: the line turns
    round.
    """

    def over(pose: Pose2) -> Pose2:
        return Pose2(pose.x_m, -pose.y_m, -pose.yaw_rad)

    def turned(fold: DrawnFold) -> DrawnFold:
        return replace(fold, start=(-fold.end[0], fold.end[1]), end=(-fold.start[0], fold.start[1]))

    garment, placed = problem.garment, problem.garment.placement
    image = replace(
        garment,
        outline=tuple((-x, y) for x, y in garment.outline),
        folds=tuple(turned(f) for f in garment.folds),
        placement=Pose2(placed.x_m, -placed.y_m, math.pi - placed.yaw_rad),
    )
    stations = tuple((name, over(pose)) for name, pose in problem.scene.stations)
    return replace(problem, garment=image, scene=replace(problem.scene, stations=stations))


def turned(problem: Problem) -> Problem:
    """Return the problem turned by half a turn about the table's middle."""

    def over(pose: Pose2) -> Pose2:
        return Pose2(-pose.x_m, -pose.y_m, pose.yaw_rad + math.pi)

    stations = tuple((name, over(pose)) for name, pose in problem.scene.stations)
    garment = replace(problem.garment, placement=over(problem.garment.placement))
    return replace(problem, garment=garment, scene=replace(problem.scene, stations=stations))
