"""Find where a line crosses a region: the stops at which it meets the boundary, and the chord nearest to a segment.

A fold's line must begin and end on the boundary and run inside. When an end it was drawn to is no longer on the
boundary, the line is kept and the end slides along it to the nearest stop from which the line still runs through cloth.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import shapely

from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.tolerance import LENGTH_M

_FAR_M = 100.0
"""Length by which a segment is extended to cross any region (m)."""


@dataclass(frozen=True, slots=True)
class _Run:
    """A stretch of a line without a gap: its stops, and for each pair of neighbours whether cloth is on both sides."""

    stops: tuple[float, ...]
    is_inside: tuple[bool, ...]

    def overlap(self, length_m: float) -> float:
        """Return how much of the interval from 0 to a length it covers (m); if negative, its distance from it."""
        return min(self.stops[-1], length_m) - max(self.stops[0], 0.0)

    def nearest(self, length_m: float) -> tuple[float, float] | None:
        """Return the stops nearest to 0 and a length with cloth between them (m); None if it follows the boundary."""
        pairs = [
            (low, high)
            for i, low in enumerate(self.stops)
            for j, high in enumerate(self.stops)
            if any(self.is_inside[i:j])
        ]
        return min(pairs, key=lambda pair: (abs(pair[0]) + abs(pair[1] - length_m), pair), default=None)


def nearest_chord(region: Region, guide: Segment) -> Segment | None:
    """Return the chord of a region on the line through a segment whose ends are nearest to the segment's.

    Args:
        region: the region that the line crosses.
        guide: gives the line, the direction, and where the ends should be.

    Returns:
        A segment in the guide's direction with its ends on the boundary and cloth beside part of it, without a gap.
            Where
        the line has several such stretches, the one that covers most of the guide. None if the line misses the region.
    """
    runs = [run for run in _runs(region, guide) if any(run.is_inside)]
    if not runs:
        return None
    stops = max(runs, key=lambda run: run.overlap(guide.length)).nearest(guide.length)
    return None if stops is None else Segment(guide.at(stops[0]), guide.at(stops[1]))


def chords(region: Region, line: Segment) -> tuple[Segment, ...]:
    """Return all chords of a region on the line through a segment, in its direction, none along the boundary.

    Where the line touches the boundary from inside, one chord ends and the next begins.
    """
    found = []
    for run in _runs(region, line):
        for (low, high), is_inside in zip(pairwise(run.stops), run.is_inside, strict=True):
            if is_inside:
                found.append(Segment(line.at(low), line.at(high)))
    return tuple(found)


def _runs(region: Region, line: Segment) -> list[_Run]:
    stops = _stops(region, line)
    runs: list[_Run] = []
    open_stops: list[float] = []
    inside: list[bool] = []
    for low, high in pairwise(stops):
        middle = line.at((low + high) / 2)
        is_inside = region.contains(middle, LENGTH_M)
        if is_inside or region.boundary_distance(middle) <= LENGTH_M:
            open_stops = open_stops or [low]
            open_stops.append(high)
            inside.append(is_inside)
        elif open_stops:
            runs.append(_Run(tuple(open_stops), tuple(inside)))
            open_stops, inside = [], []
    if open_stops:
        runs.append(_Run(tuple(open_stops), tuple(inside)))
    return runs


def _stops(region: Region, line: Segment) -> list[float]:
    """Return where the line meets the boundary, from the segment's start along it (m), ascending."""
    whole = shapely.LineString([line.at(-_FAR_M), line.at(line.length + _FAR_M)])
    boundary = region.shape.boundary
    crossed = np.asarray(shapely.get_coordinates(shapely.intersection(whole, boundary)))
    vertices = np.asarray(shapely.get_coordinates(boundary))
    near = vertices[np.abs(line.left_distances(vertices)) <= LENGTH_M]
    stops: list[float] = []
    for position in np.sort(line.positions(np.vstack([near, crossed]))):
        if not stops or position - stops[-1] > LENGTH_M:
            stops.append(float(position))
    return stops
