"""How far cloth may hang over each edge of the table before it slips, and how it stands now.

Cloth that hangs over one edge alone holds as long as what hangs is at most friction times what lies, layers counted:
its share of the whole may be friction / (1 + friction). So for each edge there is a line across the cloth, parallel to
the edge, beyond which that share lies. Areas beyond a line are sums over the layers' edges: of an edge from (t, h) to
(t', h'), t along the line and h beyond it, the part beyond adds the integral of max(h, 0) dt.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from app.overlays.moment import Moment
from planner.cloth.cloth_state import ClothState
from planner.cloth.g_state import EDGE_NAMES, is_held
from planner.geometry.pose import FloatArray
from planner.geometry.segment import Segment
from planner.geometry.tolerance import GRID_M


@dataclass(frozen=True, slots=True, eq=False)
class CutCloth:
    """The layers of a stack as edges, to be cut by lines.

    Attributes:
        starts: where each edge of each layer begins, shape (n, 2), m; layers run counter-clockwise.
        ends: where it ends.
    """

    starts: FloatArray
    ends: FloatArray

    @staticmethod
    def of(cloth: ClothState) -> "CutCloth":
        """All layers of a stack."""
        rings = [layer.ring for layer in cloth.layers]
        return CutCloth(np.concatenate(rings), np.concatenate([np.roll(ring, -1, axis=0) for ring in rings]))

    def area_beyond(self, line: Segment, shift_m: float = 0.0) -> float:
        """The area to the right of a line that is moved to its right so far, layers counted (m^2)."""
        h0, h1 = (-line.left_distances(points) - shift_m for points in (self.starts, self.ends))
        t0, t1 = (line.positions(points) for points in (self.starts, self.ends))
        upper = np.maximum(h0, 0.0) + np.maximum(h1, 0.0)
        rise = np.abs(h1 - h0)
        crossing = (h0 > 0.0) != (h1 > 0.0)
        share = np.where(crossing, np.maximum(h0, h1) / np.where(crossing, rise, 1.0), 1.0)
        return abs(float(np.sum(0.5 * upper * share * (t1 - t0))))

    def reach_beyond(self, line: Segment) -> tuple[float, float]:
        """How far the cloth lies to the right of a line, least and most (m)."""
        beyond = -line.left_distances(self.starts)
        return float(beyond.min()), float(beyond.max())

    def span_along(self, line: Segment) -> tuple[float, float]:
        """Where along a line the cloth begins and ends (m)."""
        along = line.positions(self.starts)
        return float(along.min()), float(along.max())


def slip_overlay(moment: Moment) -> dict[str, Any]:
    """How far the cloth may hang over each edge, and what hangs now, as JSON, article frame."""
    cloth, friction = CutCloth.of(moment.cloth), moment.scene.friction
    edges = dict(zip(EDGE_NAMES, moment.table.edges, strict=True))
    hanging = {name: cloth.area_beyond(edge) for name, edge in edges.items()}
    lying = max(moment.cloth.area - sum(hanging.values()), 0.0)
    outwards = np.array([-np.array(edge.left) for edge in edges.values()])
    pull = float(np.hypot(*(np.array(list(hanging.values())) @ outwards)))
    return {
        "friction": friction,
        "pull_m2": pull,
        "lying_m2": lying,
        "hanging_m2": hanging,
        "holds": is_held(pull, lying, friction),
        "limits": [_limit(cloth, name, edge, friction) for name, edge in edges.items()],
    }


def limit_m(cloth: CutCloth, edge: Segment, friction: float) -> float:
    """How far to the right of an edge the line lies beyond which the cloth may hang over it (m)."""
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


def _limit(cloth: CutCloth, name: str, edge: Segment, friction: float) -> dict[str, Any]:
    at_m = limit_m(cloth, edge, friction)
    outermost = cloth.reach_beyond(edge)[1]
    out = -np.array(edge.left) * at_m
    line = [[float(value) for value in np.array(edge.at(along)) + out] for along in cloth.span_along(edge)]
    return {"edge": name, "line": line, "at_m": outermost - at_m, "now_m": max(outermost, 0.0)}
