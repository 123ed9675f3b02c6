"""Random garments with legal folds: anywhere, from corner to corner, along edges and creases, or nearly so."""

import math

import numpy as np
from hypothesis import strategies as st

from planner.cloth.cloth_state import ClothState
from planner.cloth.fold_kinds import FOLD_KINDS
from planner.cloth.garment import DrawnFold, Garment
from planner.errors import FieldError
from planner.folds.fold import snapped_line
from planner.folds.fold_cloth import fold_cloth
from planner.geometry.pose import Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.split import split_along
from tests.builders import fold, garment, spread
from tests.laws.outlines import MOST_CORNERS, Outline, outlines

OFFS = (0.0, 0.0, 1e-6, 1e-5, 3e-5, 1e-4, 1e-3, 1e-2)
"""Offsets (m) and slopes (rad) of a line beside an edge, a corner or a crease: none, or hardly any."""


@st.composite
def drawings(draw: st.DrawFn, most_folds: int = 6, most_corners: int = MOST_CORNERS, least_folds: int = 1) -> Garment:
    """Return a garment of at most some number of folds, each legal when its turn comes."""
    return draw(folded(draw(outlines(most_corners)), most_folds, least_folds))


@st.composite
def folded(draw: st.DrawFn, outline: Outline, most_folds: int, least_folds: int = 1) -> Garment:
    """Return a garment of this outline with random legal folds."""
    cloth, folds, lines = spread(outline), list[DrawnFold](), list[Segment]()
    for _ in range(draw(st.integers(least_folds, most_folds))):
        kind = "red" if folds and draw(st.integers(0, 3)) == 0 else "blue"
        drawn = draw(_folds(FOLD_KINDS[kind].silhouette(cloth), lines, kind))
        after = None if drawn is None else _after(cloth, drawn, lines)
        if drawn is not None and after is not None:
            line, cloth = after
            folds.append(drawn)
            lines.append(line)
    return garment(outline, *folds)


def _after(cloth: ClothState, drawn: DrawnFold, lines: list[Segment]) -> tuple[Segment, ClothState] | None:
    """Return the line as snapped and the cloth afterwards; None if the fold is not legal."""
    try:
        line = snapped_line(drawn, FOLD_KINDS[drawn.kind].silhouette(cloth))
        crease = lines[-1] if drawn.is_red else None
        return line, fold_cloth(cloth, line, drawn.kind, crease).cloth
    except FieldError:
        return None


@st.composite
def _folds(draw: st.DrawFn, silhouette: Region, lines: list[Segment], kind: str) -> DrawnFold | None:
    """Return a fold along a chord of the silhouette, with ends drawn as roughly as by hand."""
    chord = _chord(silhouette, draw(_through(silhouette, lines)))
    if chord is None:
        return None
    start, end = chord
    if _moves_most(silhouette, Segment(start, end)) != (draw(st.integers(0, 4)) == 0):
        start, end = end, start
    if draw(st.integers(0, 3)) == 0:
        start, end = (_rounded(p) for p in (start, end))
    return fold(start, end, kind) if math.dist(start, end) > 0.006 else None


@st.composite
def _through(draw: st.DrawFn, silhouette: Region, lines: list[Segment]) -> Segment:
    """Return a segment through some point of the silhouette: the chord's line, and an offset from the point."""
    corners = [_point(p) for p in silhouette.ring]
    some = st.sampled_from(corners)
    kind = draw(st.sampled_from(("anywhere", "corners", "beside an edge", "beside a crease")))
    if kind == "corners":
        start, end = draw(some), draw(some)
    elif kind == "beside an edge":
        index = draw(st.integers(0, len(corners) - 1))
        start, end = corners[index - 1], corners[index]
    elif kind == "beside a crease" and lines:
        crease = draw(st.sampled_from(lines))
        start, end = crease.start, crease.end
    else:
        start = end = draw(_inner_points(silhouette))
    if math.dist(start, end) < 1e-4:
        turn = draw(st.one_of(st.floats(0.0, math.tau), st.sampled_from([i * math.pi / 4 for i in range(8)])))
        end = (start[0] + math.cos(turn), start[1] + math.sin(turn))
    base, off, tilt = Segment(start, end), draw(st.sampled_from(OFFS)), draw(st.sampled_from(OFFS))
    nx, ny = base.left
    ax, ay = base.at(base.length / 2 if kind != "anywhere" else 0.0)
    heading = math.atan2(base.direction[1], base.direction[0]) + tilt
    middle = (ax + off * nx, ay + off * ny)
    return Segment(middle, (middle[0] + math.cos(heading), middle[1] + math.sin(heading)))


@st.composite
def _inner_points(draw: st.DrawFn, silhouette: Region) -> Point2:
    triangles = silhouette.triangles
    a, b, c = triangles[draw(st.integers(0, len(triangles) - 1))]
    u, v = draw(st.floats(0.01, 0.98)), draw(st.floats(0.01, 0.98))
    return _point(a + u * (b - a) + (1.0 - u) * v * (c - a))


def _chord(silhouette: Region, through: Segment) -> tuple[Point2, Point2] | None:
    """Return the stretch of a whole line within the silhouette that comes nearest to the segment's start."""
    stretches = silhouette.overlaps_with(Segment(through.at(-10.0), through.at(10.0)))
    place = np.array([through.start])
    long = [s for s in stretches if math.dist(*s) > 1e-3]
    if not long:
        return None
    nearest = min(long, key=lambda s: float(Segment(*s).distances(place)[0]))
    start, end = silhouette.nearest_boundary_points(np.array(nearest))
    return _point(start), _point(end)


def _moves_most(silhouette: Region, line: Segment) -> bool:
    """Return whether the larger part lies to the left of a line: people rather turn the smaller one."""
    parts = split_along(silhouette, line)
    return parts is not None and parts[0].area > parts[1].area


def _rounded(point: Point2) -> Point2:
    """Round to the millimetre, as in a file that someone typed."""
    return (round(point[0], 3), round(point[1], 3))


def _point(row: np.ndarray) -> Point2:
    return (float(row[0]), float(row[1]))
