"""Find how wide grips must hold so that the hands suffice.

If two discs cover points in convex position, each disc can be given a sequence of neighbours, since the line halfway
between the centres separates them. The points to hold are corners of a convex hull. So it is enough to try all ways to
cut their ring into two sequences, with the best grip for each. For three grips and more such cuts are enough to hold
all, though a grip between two others might do with a little less.
"""

import math

import numpy as np

from planner.cloth.grip_candidates import grip_candidates
from planner.cloth.grips import Cover
from planner.geometry.pose import FloatArray, Point2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.smallest_circle import pair_centres
from planner.geometry.tolerance import LENGTH_M
from planner.primitives.context import Context
from planner.task.reason import Code

GRIP_CODES = (Code.TOO_MANY_GRIPS, Code.GRIPS_TOO_CLOSE, Code.RED_NEEDS_HOLD)
"""Codes of obstacles to how the hands hold the cloth."""

# Beyond that only grips at the vertices are tried. The planner tries all of these too, so it can plan with the radius
# found.
_ALL_MAX, _PAIRS_MAX = 32, 64
"""Vertices up to which all candidate grips are tried, and up to which those between two vertices are tried."""


def needed_radius(piece: Region, baseline: Segment, vertices: FloatArray, grips: int) -> float:
    """Return a grip radius with which the grips hold all vertices (m): the least, or slightly more for many of them.

    Args:
        piece: the cloth whose boundary is gripped.
        baseline: the part of its boundary that stays in place, where no grip goes.
        vertices: what must be held, shape (n, 2), m, at least one.
        grips: the number of hands.
    """
    candidates = _candidates(piece, baseline, vertices)
    middle = vertices.mean(axis=0)
    ring = vertices[np.argsort(np.arctan2(*(vertices - middle).T[::-1]), kind="stable")]
    distances = np.hypot(*(candidates[:, None] - ring[None]).transpose(2, 0, 1))
    if grips == 1:
        return float(distances.max(axis=1).min())
    return _in_runs(distances, grips)


def radius_for(context: Context, fold: int, grips: int) -> float:
    """Return a grip radius with which so many grips hold all that a fold needs (m), as `needed_radius` does."""
    arms, drawn = len(context.reach.arm_names), context.sequence.folds[fold]
    vertices = np.array(context.sequence.covers(fold, context.scene.support_angle_rad, arms).vertices)
    return needed_radius(context.sequence.moving(fold), drawn.line, vertices, grips) if len(vertices) else 0.0


def held_radius(held: Cover, vertices: FloatArray) -> float:
    """Return the grip radius with which grips in place hold all vertices (m); infinite without a grip."""
    if not held:
        return math.inf
    return float(np.hypot(*(np.array(held)[:, None] - vertices[None]).transpose(2, 0, 1)).min(axis=0).max())


def farthest_from(held: Cover, vertices: FloatArray) -> Point2:
    """Return the vertex furthest from the grip nearest to it; the first vertex without a grip."""
    index = 0
    if held:
        gaps = np.hypot(*(np.array(held)[:, None] - vertices[None]).transpose(2, 0, 1)).min(axis=0)
        index = int(gaps.argmax())
    return (float(vertices[index, 0]), float(vertices[index, 1]))


def _candidates(piece: Region, baseline: Segment, vertices: FloatArray) -> FloatArray:
    if len(vertices) <= _ALL_MAX:
        return grip_candidates(piece, vertices, (baseline,))
    if len(vertices) > _PAIRS_MAX:
        return vertices
    found = np.vstack([vertices, piece.nearest_boundary_points(pair_centres(vertices))])
    return np.asarray(found[baseline.distances(found) > LENGTH_M])


def _in_runs(distances: FloatArray, grips: int) -> float:
    """Return the least radius for some grips, each holding neighbours on the ring of vertices.

    Args:
        distances: from candidates to the ring of vertices, shape (m, n), m.
        grips: the number of grips, two or more.
    """
    count = distances.shape[1]
    alone = np.empty((count, count))
    """The least radius for one sequence that begins at the first index and has one more vertex than the second."""
    for start in range(count):
        run = np.maximum.accumulate(np.roll(distances, -start, axis=1), axis=1)
        alone[start] = run.min(axis=0)
    least, starts = alone, np.arange(count)
    for _ in range(grips - 2):
        more = least.copy()
        for length in range(1, count):
            rest = least[(starts + length) % count, : count - length]
            more[:, length:] = np.minimum(more[:, length:], np.maximum(alone[:, length - 1, None], rest))
        least = more
    rests = (least[(starts + length) % count, count - length - 1] for length in range(1, count))
    all_round = [np.maximum(alone[:, length], rest).min() for length, rest in enumerate(rests)]
    return float(min([alone[0, -1], *all_round]))
