"""Finds the outline of a garment among the curves of a drawing: closed, and the largest."""

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from app.files.curve import POINTS_MAX as CURVE_POINTS_MAX
from app.files.curve import Curve
from app.files.import_errors import broken
from planner.cloth.outline import AREA_MIN_M2, EDGE_MIN_M, POINTS_MAX
from planner.geometry.pose import FloatArray

TOLERANCE_M = 0.5e-3
"""So far a curve may deviate from the straight edges that take its place (m), if they are few enough."""

_JOIN_M = 0.2e-3
"""Ends of lines nearer than this are joined (m)."""


@dataclass(frozen=True, slots=True, eq=False)
class FoundOutline:
    """The outline.

    Attributes:
        points: its corners (m), shape (n, 2), the first not repeated.
        tolerance_m: how far they deviate from the curves at most (m).
        others: the other closed curves, each by its lowest and highest coordinates (m), shape (n, 2, 2).
    """

    points: FloatArray
    tolerance_m: float
    others: FloatArray

    def is_about(self, line: FloatArray) -> bool:
        """Whether a line, shape (n, 2), may be meant for this outline: not beside another, nor far away."""
        middle = (line[0] + line[-1]) / 2.0
        low, high = self.points.min(axis=0), self.points.max(axis=0)
        if np.all((middle >= low) & (middle <= high)):
            return True
        is_others = np.all((middle >= self.others[:, 0]) & (middle <= self.others[:, 1]), axis=1).any()
        away = middle - np.clip(middle, low, high)
        return not is_others and float(np.hypot(*away)) <= float(np.hypot(*(high - low)))


def find_outline(curves: Iterable[Curve], unit_m: float) -> FoundOutline:
    """The largest closed curve, lines that meet at their ends joined before, by at most 400 corners.

    Args:
        curves: the curves.
        unit_m: how long a unit of theirs is (m).

    Raises:
        ImportedFileError: none is closed.
    """
    lines, count = [], 0
    for curve in curves:
        lines.append(curve.flattened(TOLERANCE_M / unit_m) * unit_m)
        count += len(lines[-1])
        if count > 2 * CURVE_POINTS_MAX:
            raise broken(f"its curves need more than {2 * CURVE_POINTS_MAX} points")
    rings = _rings(lines)
    if not rings:
        raise broken("there is no closed line in it that could be the outline of a garment")
    others = [(ring.min(axis=0), ring.max(axis=0)) for ring in rings[1:]]
    whole = points = _spaced(rings[0])
    spacing_m = EDGE_MIN_M if len(whole) < len(rings[0]) - 1 else 0.0
    tolerance_m = 0.0
    while len(points) > POINTS_MAX:
        tolerance_m = 2.0 * tolerance_m or TOLERANCE_M
        points = _spaced(_simplified(whole, tolerance_m))
    return FoundOutline(points, TOLERANCE_M + spacing_m + tolerance_m, np.array(others).reshape(-1, 2, 2))


def area(ring: FloatArray) -> float:
    """The signed area within a ring of points, shape (n, 2): positive if it runs counter-clockwise."""
    x, y = (ring - ring[0]).T
    return float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2.0


def _rings(lines: Sequence[FloatArray]) -> list[FloatArray]:
    """The closed lines that could be cloth, the largest first."""
    closed = [line for line in lines if len(line) > 3 and _is_closed(line)]
    loose = [line for line in lines if len(line) > 1 and not _is_closed(line)]
    closed.extend(line for line in _joined(loose) if _is_closed(line))
    return sorted((ring for ring in closed if abs(area(ring)) >= AREA_MIN_M2), key=lambda ring: -abs(area(ring)))


def _is_closed(line: FloatArray) -> bool:
    """Whether a line ends where it begins, to the length of the shortest edge of an outline."""
    return float(np.hypot(*(line[0] - line[-1]))) <= EDGE_MIN_M


def _joined(lines: Sequence[FloatArray]) -> list[FloatArray]:
    """Lines put together where exactly two of them meet."""
    meeting: dict[tuple[int, int], list[int]] = defaultdict(list)
    for number, line in enumerate(lines):
        for end in (line[0], line[-1]):
            meeting[_place(end)].append(number)
    left = set(range(len(lines)))
    found = []
    for number in range(len(lines)):
        if number in left:
            left.remove(number)
            forwards = _continued(lines[number], lines, meeting, left)
            found.append(_continued(forwards[::-1], lines, meeting, left))
    return found


def _continued(
    line: FloatArray, lines: Sequence[FloatArray], meeting: dict[tuple[int, int], list[int]], left: set[int]
) -> FloatArray:
    """A line with all that follows it, as long as it is clear what does; that is taken from what is left."""
    parts = [line]
    while len(there := meeting[_place(parts[-1][-1])]) == 2:
        following = next((number for number in there if number in left), None)
        if following is None:
            break
        left.remove(following)
        more = lines[following]
        parts.append(more[1:] if _place(more[0]) == _place(parts[-1][-1]) else more[-2::-1])
    return np.concatenate(parts)


def _place(point: FloatArray) -> tuple[int, int]:
    return (round(float(point[0]) / _JOIN_M), round(float(point[1]) / _JOIN_M))


def _spaced(line: FloatArray) -> FloatArray:
    """A closed line without its repeated end, and without points that make edges shorter than those of an outline."""
    kept = [line[0]]
    for point in line[1:]:
        if np.hypot(*(point - kept[-1])) >= EDGE_MIN_M:
            kept.append(point)
    while len(kept) > 1 and np.hypot(*(kept[-1] - kept[0])) < EDGE_MIN_M:
        kept.pop()
    return np.array(kept)


def _simplified(ring: FloatArray, tolerance_m: float) -> FloatArray:
    """A ring with fewer corners that deviates from it by no more than a tolerance (Douglas and Peucker)."""
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
    """How far points are from the segment between the first and the last."""
    chord, from_first = line[-1] - line[0], line - line[0]
    length2 = float(chord @ chord)
    along = np.clip(from_first @ chord / length2, 0.0, 1.0) if length2 > 0.0 else np.zeros(len(line))
    return np.asarray(np.hypot(*(from_first - along[:, None] * chord).T))
