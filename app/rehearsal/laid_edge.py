"""The edge that a fold has laid down at each hand: where it should be, and how far short of that it is seen.

The edge of one layer that the fold lays on that of what it lies on should be there, wherever the stack lies. It is seen
more exactly than the stack, which is fitted to the edges of all layers. Of more layers the edges seen are their own.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from app.rehearsal.judge import GAP_M
from app.rehearsal.step_seen import StepSeen
from app.rehearsal.vision.seen_stack import SeenStack
from planner.cloth.cloth_state import ClothState
from planner.cloth.layer import Layer
from planner.geometry.isometry import Isometry
from planner.geometry.pose import FloatArray, Point2, point2
from planner.geometry.tolerance import LENGTH_M

_INSIDE_M, _OUTSIDE_M = 0.09, 0.03
"""How far inside and outside of its place an edge is looked for (m)."""

_BESIDE_M = np.linspace(-0.1, 0.1, 21)
"""Where an edge is looked for to the sides of a hand (m): the hand itself hides the cloth."""

_STEP_M = 0.002
_IN_HAND_M = 0.011
"""The largest distance from a hand to a layer that it holds (m)."""

_ON_EDGE_M = 0.002
"""The largest distance between edges that should lie on one another (m)."""

_LEAST_RAYS = 3


@dataclass(frozen=True, slots=True, eq=False)
class LaidEdge:
    """The edge at one hand, and rays that cross it along the hand's way; table frame.

    Attributes:
        arm: the arm's name.
        place: where the fold should have laid down what the hand held (m).
        way: the direction in which it came there, of length 1, shape (2,).
        starts: where rays start, on the part that was folded over, shape (n, 2), m.
        ends: where they end, beyond its edge, shape (n, 2), m.
        lengths_m: how far it is along each of them to where the edge should be, shape (n,), m.
        layers: how many layers the hand held.
        height_m: the height of the stack there (m).
        is_on_edge: whether it should lie on another edge, which is seen.
    """

    arm: str
    place: Point2
    way: FloatArray
    starts: FloatArray
    ends: FloatArray
    lengths_m: FloatArray
    layers: int
    height_m: float
    is_on_edge: bool

    def short_m(self, seen_m: FloatArray) -> float | None:
        """Return how far short of its place the edge is (m), seen along the rays, (n,), m; None if too few see it."""
        short = (self.lengths_m - seen_m)[np.isfinite(seen_m)]
        return float(np.median(short)) if len(short) >= _LEAST_RAYS else None


def laid_edges(seen: StepSeen, after: SeenStack | None = None) -> Iterator[LaidEdge]:
    """Yield the edges that a step's fold lays down, as the cloth lies; none for a step without a fold.

    The part that comes to lie on top is of one layer where rays cross it: other edges are not taken for this one.

    Args:
        seen: the step, and where the stack lies.
        after: how the stack was seen after it; None where it was not.
    """
    step, sequence = seen.step, seen.sequence
    if step.fold is None:
        return
    line, folded = sequence.folds[step.fold].line, sequence.folded(step.before.done, step.fold)
    lies = step.before.placement
    to_table = seen.carried.after(Isometry.rotation(lies.yaw_rad, lies.x_m, lies.y_m))
    over, layers = Isometry.reflection(line), folded.cloth.layers
    way, across = -np.array(line.left), np.array(line.direction)
    along_m = np.arange(-_INSIDE_M, _OUTSIDE_M, _STEP_M)
    for one in step.holdings:
        place = np.array(over.apply_point(one.point))
        points = place + _BESIDE_M[:, None, None] * across + along_m[None, :, None] * way
        on_top = _on_top(layers, points)
        is_part = (on_top == on_top[:, :1]) & (on_top[:, :1] >= len(layers) - folded.cloth.moved)
        ends = np.argmin(is_part, axis=1)
        rays = np.flatnonzero(is_part[:, 0] & ~is_part.all(axis=1))
        held = np.array([one.point])
        in_hand = sum(bool(layer.region.distances_to(held)[0] <= _IN_HAND_M) for layer in folded.layers)
        beyond_m, is_on_edge = 0.0, in_hand == 1 and _is_on_edge(folded.cloth, place, way)
        if after is None or after.is_edge_hidden(place[None]):
            is_on_edge = False
        elif is_on_edge:
            beyond_m = float((after.beside(place[None]) + after.edge_beside(place[None]))[0] @ way)
        yield LaidEdge(
            one.arm,
            to_table.apply_point(point2(place + beyond_m * way)),
            np.array(seen.to_table(point2(way))),
            to_table.apply(points[rays, 0]),
            to_table.apply(points[rays, -1]),
            _STEP_M * (ends[rays] - 0.5) + beyond_m,
            in_hand,
            GAP_M * sum(bool(layer.region.distances_to(place[None])[0] <= LENGTH_M) for layer in layers),
            is_on_edge,
        )


def _is_on_edge(stack: ClothState, place: FloatArray, way: FloatArray) -> bool:
    """Return whether the moved part's edge at a place lies on an edge of the part below it, along a direction."""
    below = stack.layers[: len(stack.layers) - stack.moved]
    is_below = any(layer.region.distances_to(place[None])[0] <= _ON_EDGE_M for layer in below)
    beyond = place + 2.0 * _ON_EDGE_M * way
    return is_below and bool(stack.silhouette.distances_to(beyond[None])[0] > _ON_EDGE_M)


def _on_top(layers: Sequence[Layer], points: FloatArray) -> FloatArray:
    """Return the number of the topmost layer at points, shape (n, m, 2) -> (n, m); -1 where there is none."""
    flat, found = points.reshape(-1, 2), np.full(points.shape[0] * points.shape[1], -1)
    for number, layer in enumerate(layers):
        found[layer.region.distances_to(flat) <= LENGTH_M] = number
    return found.reshape(points.shape[:2])
