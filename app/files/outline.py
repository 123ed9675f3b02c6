"""Finds the outline of a garment among the curves of a drawing: the largest closed one."""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from app.files.curve import POINTS_MAX as CURVE_POINTS_MAX
from app.files.curve import Curve
from app.files.import_errors import broken
from app.files.seam_allowance import Allowance, Line, seam_line
from planner.cloth.outline import AREA_MIN_M2, EDGE_MIN_M, POINTS_MAX
from planner.geometry.pose import FloatArray

TOLERANCE_M = 0.5e-3
"""Largest deviation of the straight edges from the curve that they replace, unless they are too many (m)."""

_PAIRED_MAX = 8
"""Closed lines, the largest first, among which a cut line and its seam line are looked for."""

_JOIN_M = 0.2e-3
"""Distance below which the ends of two lines are joined (m)."""


@dataclass(frozen=True, slots=True, eq=False)
class FoundOutline:
    """An outline found in a drawing.

    Attributes:
        points: its corners (m), shape (n, 2), the first not repeated.
        tolerance_m: their largest deviation from the curves (m).
        is_bent: whether any of the curves is more than straight segments.
        is_simplified: whether corners of the drawing are left out.
        others: the lowest and highest coordinates of each other closed curve (m), shape (n, 2, 2).
        allowance: what was told of a cut line and a seam line; None where the drawing has no such two.
    """

    points: FloatArray
    tolerance_m: float
    is_bent: bool
    is_simplified: bool
    others: FloatArray
    allowance: Allowance | None = None

    def is_about(self, line: FloatArray) -> bool:
        """Return whether a line, shape (n, 2), may belong to this outline: not to another, and not far away."""
        middle = (line[0] + line[-1]) / 2.0
        low, high = self.points.min(axis=0), self.points.max(axis=0)
        if np.all((middle >= low) & (middle <= high)):
            return True
        is_others = np.all((middle >= self.others[:, 0]) & (middle <= self.others[:, 1]), axis=1).any()
        away = middle - np.clip(middle, low, high)
        return not is_others and float(np.hypot(*away)) <= float(np.hypot(*(high - low)))


@dataclass(frozen=True, slots=True, eq=False)
class _Line:
    """A flattened curve, or several joined at their ends.

    Attributes:
        points: its points (m), shape (n, 2).
        is_bent: whether any of the curves is more than straight segments.
    """

    points: FloatArray
    is_bent: bool

    @property
    def is_closed(self) -> bool:
        """Whether the line ends where it begins, within the length of the shortest edge of an outline."""
        return float(np.hypot(*(self.points[0] - self.points[-1]))) <= EDGE_MIN_M

    @property
    def reversed(self) -> "_Line":
        """The line in the opposite direction."""
        return _Line(self.points[::-1], self.is_bent)


def find_outline(curves: Iterable[Curve], unit_m: float, wanted: Line = "seam") -> FoundOutline:
    """Return the largest closed curve, after joining lines at their ends, with at most 400 corners.

    Args:
        curves: the curves.
        unit_m: the length of their unit (m).
        wanted: which line to take where a seam line runs along inside the largest one.

    Raises:
        ImportedFileError: there is no closed curve.
    """
    lines: list[_Line] = []
    count = 0
    for curve in curves:
        lines.append(_Line(curve.flattened(TOLERANCE_M / unit_m) * unit_m, curve.is_bent))
        count += len(lines[-1].points)
        if count > 2 * CURVE_POINTS_MAX:
            raise broken(f"its curves need more than {2 * CURVE_POINTS_MAX} points")
    rings = _rings(lines)
    if not rings:
        raise broken("there is no closed line in it that could be the outline of a garment")
    seam = seam_line([_cornered(ring)[0] for ring in rings[:_PAIRED_MAX]])
    taken = seam[0] if seam is not None and wanted == "seam" else 0
    left = [ring for number, ring in enumerate(rings) if number and (seam is None or number != seam[0])]
    others = [(ring.points.min(axis=0), ring.points.max(axis=0)) for ring in left]
    ring = rings[taken]
    points, spacing_m, tolerance_m = _cornered(ring)
    return FoundOutline(
        points,
        TOLERANCE_M + spacing_m + tolerance_m,
        ring.is_bent,
        len(points) < len(ring.points) - 1,
        np.array(others).reshape(-1, 2, 2),
        None if seam is None else Allowance(wanted, seam[1]),
    )


def _cornered(ring: _Line) -> tuple[FloatArray, float, float]:
    """Return a ring's corners, at most 400, and how much spacing and simplifying them may have moved it (m)."""
    whole = points = _spaced(ring.points)
    spacing_m = EDGE_MIN_M if len(whole) < len(ring.points) - 1 else 0.0
    tolerance_m = 0.0
    while len(points) > POINTS_MAX:
        tolerance_m = 2.0 * tolerance_m or TOLERANCE_M
        points = _spaced(_simplified(whole, tolerance_m))
    return points, spacing_m, tolerance_m


def area(ring: FloatArray) -> float:
    """Return the signed area of a ring of points, shape (n, 2): positive if it is counter-clockwise."""
    x, y = (ring - ring[0]).T
    return float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2.0


def _rings(lines: Sequence[_Line]) -> list[_Line]:
    """Return the closed lines that are large enough to be cloth, the largest first."""
    closed = [line for line in lines if len(line.points) > 3 and line.is_closed]
    loose = [line for line in lines if len(line.points) > 1 and not line.is_closed]
    closed.extend(line for line in _joined(loose) if line.is_closed)
    cloth = (ring for ring in closed if abs(area(ring.points)) >= AREA_MIN_M2)
    return sorted(cloth, key=lambda ring: -abs(area(ring.points)))


def _joined(lines: Sequence[_Line]) -> list[_Line]:
    """Return the lines, joined where exactly two of them meet."""
    meeting: dict[tuple[int, int], list[int]] = defaultdict(list)
    for number, line in enumerate(lines):
        for end in (line.points[0], line.points[-1]):
            meeting[_place(end)].append(number)
    left = set(range(len(lines)))
    found = []
    for number in range(len(lines)):
        if number in left:
            left.remove(number)
            forwards = _continued(lines[number], lines, meeting, left)
            found.append(_continued(forwards.reversed, lines, meeting, left))
    return found


def _continued(line: _Line, lines: Sequence[_Line], meeting: dict[tuple[int, int], list[int]], left: set[int]) -> _Line:
    """Return a line with all lines that follow it unambiguously; remove those from `left`."""
    parts = [line.points]
    is_bent = line.is_bent
    while len(there := meeting[_place(parts[-1][-1])]) == 2:
        following = next((number for number in there if number in left), None)
        if following is None:
            break
        left.remove(following)
        more = lines[following].points
        is_bent = is_bent or lines[following].is_bent
        parts.append(more[1:] if _place(more[0]) == _place(parts[-1][-1]) else more[-2::-1])
    return _Line(np.concatenate(parts), is_bent)


def _place(point: FloatArray) -> tuple[int, int]:
    return (round(float(point[0]) / _JOIN_M), round(float(point[1]) / _JOIN_M))


def _spaced(line: FloatArray) -> FloatArray:
    """Return a closed line without its repeated end, and without points that make edges too short for an outline."""
    kept = [line[0]]
    for point in line[1:]:
        if np.hypot(*(point - kept[-1])) >= EDGE_MIN_M:
            kept.append(point)
    while len(kept) > 1 and np.hypot(*(kept[-1] - kept[0])) < EDGE_MIN_M:
        kept.pop()
    return np.array(kept)


def _simplified(ring: FloatArray, tolerance_m: float) -> FloatArray:
    """Return a ring with fewer corners that deviates by at most a tolerance (Douglas-Peucker)."""
    far = int(np.hypot(*(ring - ring[0]).T).argmax())
    closed = np.concatenate([ring, ring[:1]])
    keep = np.zeros(len(closed), dtype=bool)
    keep[[0, far, len(ring)]] = True
    waiting = [(0, far), (far, len(ring))]
    while waiting:
        first, last = waiting.pop()
        if last - first < 2:
            continue
        off = _off_chord(closed[first : last + 1])
        worst = int(off.argmax())
        if off[worst] > tolerance_m:
            keep[first + worst] = True
            waiting += [(first, first + worst), (first + worst, last)]
    return closed[:-1][keep[:-1]]


def _off_chord(line: FloatArray) -> FloatArray:
    """Return the distances of points from the segment between the first and the last."""
    chord, from_first = line[-1] - line[0], line - line[0]
    length2 = float(chord @ chord)
    along = np.clip(from_first @ chord / length2, 0.0, 1.0) if length2 > 0.0 else np.zeros(len(line))
    return np.asarray(np.hypot(*(from_first - along[:, None] * chord).T))
