"""Random planning tasks: some made to break the planner, some as people draw them."""

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from random import Random

import numpy as np

from planner.cloth.cloth_state import ClothState
from planner.cloth.fold_kinds import FOLD_KINDS
from planner.cloth.garment import DrawnFold, Garment
from planner.cloth.outline import require_simple_outline
from planner.errors import FieldError
from planner.folds.fold import snapped_line
from planner.folds.fold_cloth import fold_cloth
from planner.geometry.pose import Point2, Pose2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.split import split_along
from planner.geometry.table import Table
from planner.task.scene import DEFAULT_STATIONS, Scene
from tests.builders import fold, garment, rectangle_points, spread, star
from tests.laws.outlines import Outline
from tests.laws.scenes import Problem

_TRIES = 4


def plain_task(rng: Random) -> Problem:
    """Return a garment and folds as people draw them, flat on a table before the robot."""
    outline = rng.choice((_rectangle, _rectangle, _shirt, _trapezium))(rng)
    drawn = _folded(rng, outline, rng.randint(1, 3), _straight_line)
    middle = np.array(outline).min(axis=0) / 2 + np.array(outline).max(axis=0) / 2
    yaw = rng.choice((0.0, math.pi / 2, math.pi, -math.pi / 2, -math.pi / 2, rng.uniform(-math.pi, math.pi)))
    placement = lying(middle, rng.uniform(-0.65, -0.2), rng.choice((0.0, rng.uniform(-0.2, 0.2))), yaw)
    scene = Scene(
        friction=rng.choice((1.0, 1.0, rng.uniform(0.1, 1.0))),
        approach_cone_rad=rng.choice((math.radians(75.0), math.radians(75.0), math.pi, rng.uniform(0.5, math.pi))),
        back_off_max_m=rng.choice((0.8, 0.8, 0.4)),
    )
    return Problem(replace(drawn, placement=placement), scene, "front", rng.choice((0.03, 0.03, 0.0)))


def rough_task(rng: Random) -> Problem:
    """Return spikes, combs, many corners, folds anywhere, over the edge, in odd scenes; folds may be illegal."""
    outline = rng.choice((_rectangle, _shirt, _trapezium, _comb, _needle, _round, _spiky, _hairline))(rng)
    drawn = _folded(rng, outline, rng.randint(0, 5), rng.choice((_straight_line, _any_line, _corner_line)))
    if rng.random() < 0.1:
        start_at, end_at = ((rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0)) for _ in range(2))
        drawn = replace(drawn, folds=(*drawn.folds, fold(start_at, end_at)))
    middle = np.array(outline).mean(axis=0)
    yaw = rng.choice((rng.randrange(-2, 3) * math.pi / 2, rng.uniform(-math.pi, math.pi)))
    scene = _odd_scene(rng) if rng.random() < 0.5 else Scene()
    half_m, wide_m = scene.table.depth_m / 2, scene.table.width_m / 2
    placement = lying(middle, rng.uniform(-1.1, 0.6) * half_m, rng.uniform(-1.1, 1.1) * wide_m, yaw)
    start, _ = rng.choice(scene.stations)
    comfort_m = rng.choice((0.03, 0.0, 0.1, rng.uniform(0.0, 0.1)))
    return Problem(replace(drawn, placement=placement), scene, start, comfort_m)


def lying(middle: np.ndarray, x_m: float, y_m: float, yaw_rad: float) -> Pose2:
    """Return the placement that puts a point of the drawing at a place of the table."""
    cos, sin = math.cos(yaw_rad), math.sin(yaw_rad)
    x, y = float(middle[0]), float(middle[1])
    return Pose2(x_m - cos * x + sin * y, y_m - sin * x - cos * y, yaw_rad)


def _odd_scene(rng: Random) -> Scene:
    def one(*values: float) -> float:
        return rng.choice(values)

    count = rng.randint(1, len(DEFAULT_STATIONS))
    stations = rng.sample(sorted(DEFAULT_STATIONS.items()), count)
    if rng.random() < 0.3:
        pose = Pose2(rng.uniform(-2.0, 2.0), rng.uniform(-2.0, 2.0), rng.uniform(-math.pi, math.pi))
        stations.append(("anywhere", pose))
    return Scene(
        table=Table(one(1.6, 0.1, 0.4, 3.0, 10.0), one(0.98, 0.1, 0.3, 2.0), one(0.79, 0.79, 0.1, 0.6, 1.2)),
        stations=tuple(stations),
        torso_m=rng.choice((0.29, 0.29, rng.uniform(0.02, 0.3))),
        friction=one(1.0, 0.0, 1e-6, 0.2, 10.0),
        support_angle_rad=one(math.radians(5.0), 0.0, math.radians(60.0), math.radians(85.0)),
        approach_cone_rad=one(math.radians(75.0), 0.0, 0.5, math.pi),
        back_off_max_m=one(0.8, 0.0, 0.04, 0.3, 1.5),
        arm_motion_s=one(3.0, 1e-3, 0.5, 1e3),
        base_speed_m_s=one(0.25, 1e-3, 1e3),
        base_turn_rad_s=one(0.5, 1e-3, 1e3),
    )


def _rectangle(rng: Random) -> Outline:
    return rectangle_points(rng.randint(2, 14) * 0.05, rng.randint(2, 14) * 0.05)


def _shirt(rng: Random) -> Outline:
    wide, long, sleeve, cuff = rng.uniform(0.15, 0.35), rng.uniform(0.3, 0.6), rng.uniform(0.08, 0.2), 0.15
    right = [(wide / 2, 0.0), (wide / 2, long - cuff), (wide / 2 + sleeve, long - cuff), (wide / 2 + sleeve, long)]
    return tuple(right) + tuple((-x, y) for x, y in reversed(right))


def _trapezium(rng: Random) -> Outline:
    low, high, tall = (rng.uniform(0.1, 0.6) for _ in range(3))
    return ((-low / 2, 0.0), (low / 2, 0.0), (high / 2, tall), (-high / 2, tall))


def _comb(rng: Random) -> Outline:
    teeth, pitch, deep = rng.randint(2, 30), rng.choice((0.02, 0.03, 0.1)), rng.uniform(0.02, 0.4)
    edge = [p for i in range(teeth) for p in ((2 * i, deep), (2 * i + 1, deep), (2 * i + 1, 0.0), (2 * i + 2, 0.0))]
    top = [(pitch * x / 2, y) for x, y in edge[:-1]]
    wide = top[-1][0]
    return ((wide, -0.1), *reversed(top), (0.0, -0.1))


def _needle(rng: Random) -> Outline:
    long, thin = rng.uniform(0.2, 2.0), rng.choice((2e-3, 5e-3, 0.02))
    return ((0.0, 0.0), (long, rng.uniform(0.0, thin)), (rng.uniform(0.0, long), thin))


def _round(rng: Random) -> Outline:
    corners, radius = rng.choice((12, 40, 150, 400)), rng.uniform(0.06, 0.5)
    return tuple(
        (radius * math.cos(i * math.tau / corners), radius * math.sin(i * math.tau / corners)) for i in range(corners)
    )


def _spiky(rng: Random) -> Outline:
    return star(rng, rng.randint(3, 60))


def _hairline(rng: Random) -> Outline:
    """Return a rectangle with a slit, or a step, a hair wide."""
    hair, wide, tall = rng.choice((1e-5, 3e-5, 1e-4, 1e-3)), rng.uniform(0.2, 0.8), rng.uniform(0.2, 0.8)
    if rng.random() < 0.5:
        return (
            (0.0, 0.0),
            (wide, 0.0),
            (wide, tall),
            (wide / 2 + hair, tall),
            (wide / 2, 0.05),
            (wide / 2, tall),
            (0.0, tall),
        )
    return ((0.0, 0.0), (wide, 0.0), (wide, tall), (wide / 2, tall), (wide / 2, tall - hair), (0.0, tall - hair))


Line = Callable[[Random, Region], Segment]


def _folded(rng: Random, outline: Outline, wanted: int, line_of: Line) -> Garment:
    """Return a garment of up to some folds, each legal when its turn comes; raises `GarmentError` for a bad outline."""
    require_simple_outline(outline)
    cloth, folds, lines = spread(outline), list[DrawnFold](), list[Segment]()
    for _ in range(_TRIES * wanted):
        if len(folds) == wanted:
            break
        kind = "red" if folds and rng.random() < 0.2 else "blue"
        silhouette = FOLD_KINDS[kind].silhouette(cloth)
        drawn = smaller_part_over(silhouette, line_of(rng, silhouette), kind)
        after = None if drawn is None else after_fold(cloth, drawn, lines)
        if drawn is not None and after is not None:
            line, cloth = after
            folds.append(drawn)
            lines.append(line)
    return garment(outline, *folds)


def smaller_part_over(silhouette: Region, line: Segment, kind: str) -> DrawnFold | None:
    """Return a fold of the smaller part along the longest stretch of a whole line within the cloth."""
    stretches = silhouette.overlaps_with(Segment(line.at(-10.0), line.at(10.0)))
    longest = max(stretches, key=lambda ends: math.dist(*ends), default=None)
    if longest is None or math.dist(*longest) < 0.01:
        return None
    ends = silhouette.nearest_boundary_points(np.array(longest)).tolist()
    start, end = tuple(ends[0]), tuple(ends[1])
    parts = split_along(silhouette, Segment(start, end))
    if parts is not None and parts[0].area > parts[1].area + 1e-9:
        start, end = end, start
    return fold(start, end, kind)


def after_fold(cloth: ClothState, drawn: DrawnFold, lines: Sequence[Segment]) -> tuple[Segment, ClothState] | None:
    try:
        line = snapped_line(drawn, FOLD_KINDS[drawn.kind].silhouette(cloth))
        return line, fold_cloth(cloth, line, drawn.kind, lines[-1] if drawn.is_red else None).cloth
    except FieldError:
        return None


def _straight_line(rng: Random, silhouette: Region) -> Segment:
    """Return a line across or along, at a third, a half or anywhere."""
    x0, y0, x1, y1 = silhouette.bounds
    share = rng.choice((0.5, 0.5, 1 / 3, 0.25, 0.75, rng.uniform(0.1, 0.9)))
    if rng.random() < 0.5:
        return Segment((x0 + share * (x1 - x0), 0.0), (x0 + share * (x1 - x0), 1.0))
    return Segment((0.0, y0 + share * (y1 - y0)), (1.0, y0 + share * (y1 - y0)))


def _any_line(rng: Random, silhouette: Region) -> Segment:
    x0, y0, x1, y1 = silhouette.bounds
    through: Point2 = (rng.uniform(x0, x1), rng.uniform(y0, y1))
    turn = rng.uniform(0.0, math.tau)
    return Segment(through, (through[0] + math.cos(turn), through[1] + math.sin(turn)))


def _corner_line(rng: Random, silhouette: Region) -> Segment:
    """Return a line through a corner, to another or in any direction."""
    corners = [(float(x), float(y)) for x, y in silhouette.ring]
    one, other = rng.choice(corners), rng.choice(corners)
    if math.dist(one, other) < 1e-3:
        other = (one[0] + rng.uniform(-1.0, 1.0), one[1] + 1.0)
    return Segment(one, other)
