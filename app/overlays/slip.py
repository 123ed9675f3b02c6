"""Computes how far the cloth may hang over each edge of the table before it slips, and how it hangs now.

Cloth over one edge holds as long as the hanging area is at most friction times the lying area, layers counted; the
hanging share of the whole may then be friction / (1 + friction). So for each edge there is a line across the cloth,
parallel to the edge, with that share beyond it. The area beyond a line is a sum over the layers' edges: for an edge
from (t, h) to (t', h'), t along the line and h beyond it, add the integral of max(h, 0) dt.
"""

from dataclasses import dataclass

import numpy as np
from pydantic import BaseModel

from app.overlays.moment import Moment
from planner.cloth.cloth_state import ClothState
from planner.cloth.g_state import EDGE_NAMES, is_held
from planner.geometry.pose import FloatArray, Point2
from planner.geometry.segment import Segment
from planner.geometry.tolerance import GRID_M


@dataclass(frozen=True, slots=True, eq=False)
class CutCloth:
    """The edges of a stack's layers, for cutting by lines.

    Attributes:
        starts: the start of each edge of each layer, shape (n, 2), m; layers run counter-clockwise.
        ends: the end of each edge, shape (n, 2), m.
    """

    starts: FloatArray
    ends: FloatArray

    @staticmethod
    def of(cloth: ClothState) -> "CutCloth":
        """Return the edges of all layers of a stack."""
        rings = [layer.ring for layer in cloth.layers]
        return CutCloth(np.concatenate(rings), np.concatenate([np.roll(ring, -1, axis=0) for ring in rings]))

    def area_beyond(self, line: Segment, shift_m: float = 0.0) -> float:
        """Return the area to the right of a line shifted to its right, layers counted (m^2)."""
        h0, h1 = (-line.left_distances(points) - shift_m for points in (self.starts, self.ends))
        t0, t1 = (line.positions(points) for points in (self.starts, self.ends))
        upper = np.maximum(h0, 0.0) + np.maximum(h1, 0.0)
        rise = np.abs(h1 - h0)
        crossing = (h0 > 0.0) != (h1 > 0.0)
        share = np.where(crossing, np.maximum(h0, h1) / np.where(crossing, rise, 1.0), 1.0)
        return abs(float(np.sum(0.5 * upper * share * (t1 - t0))))

    def reach_beyond(self, line: Segment) -> tuple[float, float]:
        """Return the least and the largest distance of the cloth to the right of a line (m)."""
        beyond = -line.left_distances(self.starts)
        return float(beyond.min()), float(beyond.max())

    def span_along(self, line: Segment) -> tuple[float, float]:
        """Return the positions along a line at which the cloth begins and ends (m)."""
        along = line.positions(self.starts)
        return float(along.min()), float(along.max())


class LimitAnswer(BaseModel):
    """The line to which the cloth may hang over an edge of the table (m)."""

    edge: str
    line: tuple[Point2, Point2]
    at_m: float
    now_m: float


class SlipAnswer(BaseModel):
    """The cloth that hangs over the table's edges, and how much may (m^2, layers counted)."""

    friction: float
    pull_m2: float
    lying_m2: float
    hanging_m2: dict[str, float]
    holds: bool
    limits: list[LimitAnswer]


def slip_overlay(moment: Moment) -> SlipAnswer:
    """Return how far the cloth may hang over each edge and the area hanging now, garment frame."""
    cloth, friction = CutCloth.of(moment.cloth), moment.scene.friction
    edges = dict(zip(EDGE_NAMES, moment.table.edges, strict=True))
    hanging = {name: cloth.area_beyond(edge) for name, edge in edges.items()}
    lying = max(moment.cloth.area - sum(hanging.values()), 0.0)
    outwards = np.array([-np.array(edge.left) for edge in edges.values()])
    pull = float(np.hypot(*(np.array(list(hanging.values())) @ outwards)))
    return SlipAnswer(
        friction=friction,
        pull_m2=pull,
        lying_m2=lying,
        hanging_m2=hanging,
        holds=is_held(pull, lying, friction),
        limits=[_limit(cloth, name, edge, friction) for name, edge in edges.items()],
    )


def limit_m(cloth: CutCloth, edge: Segment, friction: float) -> float:
    """Return the distance, to the right of an edge, of the line beyond which the cloth may hang over (m)."""
    low, high = cloth.reach_beyond(edge)
    whole = cloth.area_beyond(edge, low)
    share = friction / (1.0 + friction)
    while high - low > GRID_M:
        middle = (low + high) / 2.0
        if cloth.area_beyond(edge, middle) > share * whole:
            low = middle
        else:
            high = middle
    return high


def _limit(cloth: CutCloth, name: str, edge: Segment, friction: float) -> LimitAnswer:
    at_m = limit_m(cloth, edge, friction)
    outermost = cloth.reach_beyond(edge)[1]
    out = -np.array(edge.left) * at_m
    start, end = (edge.at(along) + out for along in cloth.span_along(edge))
    return LimitAnswer(edge=name, line=(tuple(start), tuple(end)), at_m=outermost - at_m, now_m=max(outermost, 0.0))
