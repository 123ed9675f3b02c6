"""Random simple polygons of 3 to 40 corners: star-shaped, wild, with square teeth, nearly flat."""

import math
from collections.abc import Sequence
from itertools import pairwise

from hypothesis import assume
from hypothesis import strategies as st

from planner.cloth.outline import require_simple_outline
from planner.errors import GarmentError
from planner.geometry.pose import Point2

STEPS_M = (0.05, 0.01, 0.001)
"""Grids of corners (m), which breed collinear edges and corners on lines, exactly or within a millimetre."""

MOST_CORNERS = 40
_TURNS = 400

Outline = tuple[Point2, ...]


@st.composite
def outlines(draw: st.DrawFn, most: int = MOST_CORNERS, largest_m: float = 1.0) -> Outline:
    """Return a garment's outline of 3 to `most` corners, at most `largest_m` wide, in either orientation."""
    kind = draw(st.sampled_from((_star, _wild, _teeth, _flat)))
    size, step = draw(st.sampled_from((0.25, 0.5, 1.0))) * largest_m, draw(st.sampled_from(STEPS_M))
    ring = draw(kind(step, min(draw(st.integers(3, most)), round(size / step) + 3), size))
    if draw(st.booleans()):
        ring = draw(_shaken(ring))
    assume(_is_outline(ring))
    return ring if draw(st.booleans()) else ring[::-1]


@st.composite
def _star(draw: st.DrawFn, step: float, corners: int, size: float) -> Outline:
    """Return corners in the order of their directions from one point."""
    radii = draw(st.lists(st.floats(0.15, 0.5), min_size=corners, max_size=corners))
    shares = draw(st.lists(st.floats(0.1, 1.0), min_size=corners, max_size=corners))
    angle, ring = 0.0, []
    for radius, share in zip(radii, shares, strict=True):
        angle += math.tau * share / sum(shares)
        ring.append((size * radius * math.cos(angle), size * radius * math.sin(angle)))
    return _on_grid(ring, step)


@st.composite
def _wild(draw: st.DrawFn, step: float, corners: int, size: float) -> Outline:
    """Return corners anywhere, joined in an order in which no edges cross."""
    points = draw(_places(corners, round(size / step), round(size / step)))
    return _on_grid(_untangled([(x * step, y * step) for x, y in points]), step)


@st.composite
def _teeth(draw: st.DrawFn, step: float, corners: int, size: float) -> Outline:
    """Return columns of many heights on one base, square-cornered: collinear legs, sleeves and slots."""
    most = round(size / step)
    columns = min(max(1, corners // 2 - 1), most)
    xs = sorted(draw(st.lists(st.integers(0, most), min_size=columns + 1, max_size=columns + 1, unique=True)))
    heights = draw(st.lists(st.integers(1, most), min_size=columns, max_size=columns))
    top = [p for (a, b), h in zip(pairwise(xs), heights, strict=True) for p in ((a, h), (b, h))]
    ring = [(xs[-1], 0), (xs[0], 0), *top]
    kept = [p for i, p in enumerate(ring) if p != ring[i - 1]]
    return _on_grid([(x * step, y * step) for x, y in kept], step)


@st.composite
def _flat(draw: st.DrawFn, step: float, corners: int, size: float) -> Outline:
    """Return a sliver of a garment, a few millimetres high."""
    columns, most = max(2, corners // 2), round(size / step)
    xs = sorted(draw(st.lists(st.integers(0, most), min_size=columns, max_size=columns, unique=True)))
    lows = draw(st.lists(st.integers(0, 2), min_size=columns, max_size=columns))
    highs = draw(st.lists(st.integers(3, 6), min_size=columns, max_size=columns))
    under = [(x * step, 1e-3 * y) for x, y in zip(xs, lows, strict=True)]
    over = [(x * step, 1e-3 * y) for x, y in zip(xs, highs, strict=True)]
    return tuple(under + over[::-1])


@st.composite
def _shaken(draw: st.DrawFn, ring: Outline) -> Outline:
    """Return the corners, each moved by up to half a millimetre off its grid."""
    offs = st.lists(st.integers(-500, 500), min_size=len(ring), max_size=len(ring))
    return tuple((x + 1e-6 * a, y + 1e-6 * b) for (x, y), a, b in zip(ring, draw(offs), draw(offs), strict=True))


def _places(count: int, wide: int, high: int) -> st.SearchStrategy[list[tuple[int, int]]]:
    count = max(3, min(count, (wide + 1) * (high + 1) // 4))
    place = st.tuples(st.integers(0, wide), st.integers(0, high))
    return st.lists(place, min_size=count, max_size=count, unique=True)


def _on_grid(ring: Sequence[Point2], step: float) -> Outline:
    return tuple((round(x / step) * step, round(y / step) * step) for x, y in ring)


def _untangled(points: list[Point2]) -> list[Point2]:
    """Return the points in an order in which no edges cross, by exchanging the ends of edges that do."""
    ring = list(points)
    for _ in range(_TURNS):
        crossing = _first_crossing(ring)
        if crossing is None:
            break
        i, j = crossing
        ring[i + 1 : j + 1] = reversed(ring[i + 1 : j + 1])
    return ring


def _first_crossing(ring: list[Point2]) -> tuple[int, int] | None:
    count = len(ring)
    for i in range(count - 2):
        for j in range(i + 2, count - (i == 0)):
            if _cross(ring[i], ring[i + 1], ring[j], ring[(j + 1) % count]):
                return i, j
    return None


def _cross(a: Point2, b: Point2, c: Point2, d: Point2) -> bool:
    return _side(a, b, c) * _side(a, b, d) < 0.0 and _side(c, d, a) * _side(c, d, b) < 0.0


def _side(a: Point2, b: Point2, c: Point2) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _is_outline(ring: Outline) -> bool:
    try:
        require_simple_outline(ring)
    except GarmentError:
        return False
    return True
