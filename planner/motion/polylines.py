"""Lines of tools, point after point. Compiled: a search measures and steps along thousands of short ones."""

import math

import numpy as np

from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import LENGTH_M
from planner.kernels import kernel


@kernel
def lengths_along(points: FloatArray) -> FloatArray:
    """Return the length of a polyline up to each of its points (m), shape (n, 3) -> (n,)."""
    gone = np.zeros(len(points))
    for i in range(1, len(points)):
        dx, dy, dz = points[i, 0] - points[i - 1, 0], points[i, 1] - points[i - 1, 1], points[i, 2] - points[i - 1, 2]
        gone[i] = gone[i - 1] + math.sqrt(dx * dx + dy * dy + dz * dz)
    return gone


@kernel
def lengths_on_table(bases: FloatArray, tools: FloatArray) -> FloatArray:
    """Return the way of a tool over the table up to each of some moments (m), shape (n,).

    Args:
        bases: the base's pose at each, shape (n, 3), or (1, 3) for all: x (m), y (m), yaw (rad), table frame.
        tools: the tool in the base frame, shape (n, 3), m.
    """
    places = np.empty_like(tools)
    for i in range(len(tools)):
        x, y, yaw = bases[min(i, len(bases) - 1)]
        cos, sin = math.cos(yaw), math.sin(yaw)
        places[i, 0] = x + cos * tools[i, 0] - sin * tools[i, 1]
        places[i, 1] = y + sin * tools[i, 0] + cos * tools[i, 1]
        places[i, 2] = tools[i, 2]
    return lengths_along(places)


@kernel
def stepped(corners: FloatArray, step_m: float) -> FloatArray:
    """Return the points of a polyline, at most one step (m) apart, shape (n, 3), m; at least two."""
    counts = np.zeros(len(corners) - 1, dtype=np.int64)
    for part in range(len(counts)):
        way = corners[part + 1] - corners[part]
        counts[part] = max(math.ceil((math.sqrt((way * way).sum()) - LENGTH_M) / step_m), 0)
    total = counts.sum()
    points, at = np.empty((max(total, 1) + 1, 3)), 0
    points[0] = corners[0]
    for part in range(len(counts)):
        share = 1.0 / counts[part] if counts[part] else 0.0
        for i in range(1, counts[part] + 1):
            at += 1
            along = 1.0 if i == counts[part] else i * share
            for axis in range(3):
                start = corners[part, axis]
                points[at, axis] = start + along * (corners[part + 1, axis] - start)
    if total == 0:
        points[1] = corners[0]
    return points


@kernel
def resampled(points: FloatArray, steps: int) -> FloatArray:
    """Return a polyline's points in `steps` steps, shape (steps + 1, 3); `steps` must be no fewer than it has."""
    last = len(points) - 1
    found = np.empty((steps + 1, 3))
    for i in range(steps + 1):
        at = float(last) if i == steps else i * (last / steps)
        before = min(int(at), last)
        for axis in range(3):
            start = points[before, axis]
            found[i, axis] = start if before == last else (points[before + 1, axis] - start) * (at - before) + start
    return found
