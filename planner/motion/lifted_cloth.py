"""How cloth looks that a fold has lifted: bent where it leaves the table, and slack between the points that are held.

The plan's cloth stands straight above the baseline of its fold (`FoldPath`), with a sharp corner there. Cloth bends
instead: it leaves the table a little earlier, on a circle, and leans back to the hands above the baseline, so that each
thread from the table to the hands keeps its length. Between two points that are held it hangs through; the length that
it needs more is in a belly away from the fold line. Hands, plan and rehearsal know nothing of this.
"""

import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from planner.geometry.pose import FloatArray
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M
from planner.geometry.triangles import Parts, fanned, striped

_RADIUS_M = 0.025
"""The radius of the bend (m): about the bending length of cotton, that of a strip which bends down by its weight."""

_SHARP_M = 0.001
"""The radius below which cloth is drawn with a corner (m): it has hardly been lifted, or stands above the fold line."""

_EARLIER = 0.65
"""The most by which cloth leaves the table before its baseline, in radii of the bend: that of cloth as low as it."""

_SLACK = 0.02
"""How far cloth hangs through between two points that are held, as a share of their distance."""

_TAUT_M = 0.06
"""The distance of held points up to which cloth between them is drawn taut (m): one hand takes both."""

_BELLY_MAX = 0.15
"""The most that a belly sticks out, as a share of the length from the bend to the hands."""

_ROOM_M = 0.05
"""The distance from the table's edges from which on cloth hangs through as far as it does anywhere (m)."""

_BEND_CUTS, _ROWS, _COLUMNS = 4, 4, 4
"""Into how many flat strips the bend and a belly are cut, and how many of them there are between two held points."""

_HALVINGS = 30


@dataclass(frozen=True, slots=True)
class LiftedCloth:
    """The shape of lifted cloth at one moment, seen along its fold line.

    Attributes:
        baseline_m: the baseline's distance from the fold line (m).
        side: 1 while the cloth is lifted, -1 while it is laid down on the other side of the fold line.
        radius_m: the radius of the bend (m); 0: the cloth has a corner there.
        lean_rad: by how much the straight part above it leans back to the hands (rad).
        earlier_m: the distance before the baseline at which cloth leaves the table (m).
        slack: how far it hangs through between two held points, as a share of their distance.
        held: the points that are held, in order along the line: where, and how far above the baseline, shape (n, 2), m.
    """

    baseline_m: float
    side: float
    radius_m: float
    lean_rad: float
    earlier_m: float
    slack: float
    held: FloatArray

    @staticmethod
    def of(line: Segment, depth_m: float, sweep: float, held: FloatArray, room_m: float) -> "LiftedCloth":
        """Return the lifted cloth of a fold.

        Args:
            line: the fold line, garment frame.
            depth_m: the largest distance of the moving part from it (m).
            sweep: how far the fold has come (`FoldPath`).
            held: the points that are held, shape (n, 2), m.
            room_m: how far the standing cloth is inside the table's edges (m); 0: it hangs, and is drawn straight.
        """
        height_m = depth_m * min(sweep, 2.0 - sweep)
        baseline_m = depth_m - height_m
        radius_m, lean_rad, earlier_m = _bend(height_m, baseline_m, room_m)
        at = np.column_stack([line.positions(held), line.left_distances(held) - baseline_m])
        side = 1.0 if sweep <= 1.0 else -1.0
        slack = _SLACK * min(room_m / _ROOM_M, 1.0)
        return LiftedCloth(baseline_m, side, radius_m, lean_rad, earlier_m, slack, at[np.argsort(at[:, 0])])

    @property
    def leaves_at_m(self) -> float:
        """The distance from the fold line at which cloth leaves the table (m)."""
        return self.baseline_m - self.earlier_m

    @property
    def _bend_m(self) -> float:
        """The length of cloth in the bend (m)."""
        return self.radius_m * (math.pi / 2.0 + self.lean_rad)

    def cut(self, triangles: FloatArray, line: Segment) -> Parts:
        """Cut lifted triangles, shape (n, 3, 2), m, of a fold over a line where they bend; return all their parts."""
        if self.radius_m == 0.0:
            return triangles, np.arange(len(triangles))
        top = self.leaves_at_m + self._bend_m
        columns = self._columns
        highest = self.leaves_at_m + self.earlier_m + float(self.held[:, 1].max(initial=0.0))
        rows = np.linspace(top, max(highest, top), _ROWS + 1)[1 : -1 if len(columns) else 1]
        bends = np.linspace(self.leaves_at_m, top, _BEND_CUTS + 1)[1:]
        parts, sources = striped(triangles, line, np.concatenate([bends, rows]))
        if not len(columns):
            return parts, sources
        is_straight = line.left_distances(parts).min(axis=1) >= top - LENGTH_M
        above, of_above = striped(parts[is_straight], _across(line), -columns[::-1])
        below, of_below = fanned(parts[~is_straight], line.beside(top), columns)
        sources = np.concatenate([sources[is_straight][of_above], sources[~is_straight][of_below]])
        return np.concatenate([above, below]), sources

    @property
    def _columns(self) -> FloatArray:
        """Where slack cloth is cut across the fold line, in order along it, shape (n,), m."""
        slack = [ends for ends in pairwise(self.held[:, 0].tolist()) if ends[1] - ends[0] > _TAUT_M]
        return np.unique([np.linspace(*ends, _COLUMNS + 1) for ends in slack])

    def offsets(self, places: FloatArray, distances: FloatArray, gaps: FloatArray) -> FloatArray:
        """Return how far lifted cloth is from where the plan has it: to the line's left, and up, shape (n, 2), m.

        Args:
            places: the points' positions along the fold line, shape (n,), m.
            distances: their distances from it before the fold (m).
            gaps: the height of each point's layer in the stack (m).
        """
        along = distances - self.leaves_at_m
        angle, beyond = np.full(len(along), math.pi / 2.0), along - self.earlier_m
        across, up = np.zeros(len(along)), np.zeros(len(along))
        if self.radius_m > 0.0:
            angle = np.clip(along, 0.0, self._bend_m) / self.radius_m
            beyond = np.maximum(along - self._bend_m, 0.0)
            across = (
                self.radius_m * np.sin(angle) - beyond * math.sin(self.lean_rad) - np.clip(along, 0.0, self.earlier_m)
            )
            up = self.radius_m * (1.0 - np.cos(angle)) + beyond * math.cos(self.lean_rad)
            up -= np.maximum(along - self.earlier_m, 0.0)
            belly, sunk = self._slack(places, beyond)
            across, up = across + belly, up - sunk
        across, up = across - gaps * np.sin(angle), up + gaps * np.cos(angle)
        return np.column_stack([self.side * across, up])

    def _slack(self, places: FloatArray, beyond: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return how far points sink and stick out between held ones (m), as one wave that keeps their lengths."""
        belly, sunk = np.zeros(len(places)), np.zeros(len(places))
        for (start, low), (end, high) in pairwise(self.held.tolist()):
            is_here = (places > start) & (places < end)
            if end - start <= _TAUT_M or not is_here.any():
                continue
            share = (places[is_here] - start) / (end - start)
            length = np.maximum(low + share * (high - low) + self.earlier_m - self._bend_m, LENGTH_M)
            most = np.minimum(2.0 / math.pi * np.sqrt(length * self.slack * (end - start)), _BELLY_MAX * length)
            wave = most * 4.0 * share * (1.0 - share)
            part = np.clip(beyond[is_here] / length, 0.0, 1.0)
            belly[is_here] = wave * np.sin(math.pi * part) ** 2
            turn = part - np.sin(4.0 * math.pi * part) / (4.0 * math.pi)
            sunk[is_here] = (math.pi * wave) ** 2 / (4.0 * length) * turn
        return belly, sunk


def _bend(height_m: float, before_m: float, room_m: float) -> tuple[float, float, float]:
    """Return the radius of the bend (m), the lean of the cloth above it (rad), how much earlier it begins (m).

    The length from where cloth leaves the table to the hands is that of a corner, whatever the radius: what a circle
    saves lets the cloth lean.

    Args:
        height_m: the height of the hands above the table (m).
        before_m: the length of cloth that lies before the baseline (m).
        room_m: how far inside the table's edges it stands (m).
    """
    radius = min(_RADIUS_M, height_m / 2.0, before_m / _EARLIER, room_m)
    if radius < _SHARP_M:
        return 0.0, 0.0, 0.0
    low, high = 0.0, math.pi / 4.0
    for _ in range(_HALVINGS):
        lean = 0.5 * (low + high)
        straight = (height_m - radius * (1.0 + math.sin(lean))) / math.cos(lean)
        earlier = radius * math.cos(lean) - straight * math.sin(lean)
        is_long = radius * (math.pi / 2.0 + lean) + straight > height_m + earlier
        low, high = (low, lean) if is_long else (lean, high)
    return radius, lean, earlier


def _across(line: Segment) -> Segment:
    """Return a line from another's start, square to it: what is along the one is to the right of the other."""
    (x, y), (nx, ny) = line.start, line.left
    return Segment((x, y), (x + nx, y + ny))
