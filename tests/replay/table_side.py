"""The table for the checker: hanging cloth, whether it stays, and how points go over the edge."""

import math
from typing import Any

import numpy as np
import shapely
from shapely import LineString, Point, box
from shapely.geometry.base import BaseGeometry

from tests.replay.flat import NEAR_M, SLIVER_M2, Line, Place, must_hold, polygons, together

Space = tuple[float, float, float]
REST_M = 0.02
"""The height over the table at which a tool holds cloth (m)."""


class TableSide:
    """The table top, in its own frame."""

    def __init__(self, scene: dict[str, Any]) -> None:
        self.half_x, self.half_y = scene["table"]["depth_m"] / 2, scene["table"]["width_m"] / 2
        self.clear_m = scene["edge_clear_m"]
        self.friction, self.support_rad = scene["friction"], scene["support_angle_rad"]
        x, y = self.half_x, self.half_y
        self.top = box(-x, -y, x, y)
        self.corners = [(-x, -y), (x, -y), (x, y), (-x, y)]
        self.edges: list[tuple[Place, Line]] = [
            ((1.0, 0.0), ((x, -y), (x, y))),
            ((-1.0, 0.0), ((-x, -y), (-x, y))),
            ((0.0, 1.0), ((-x, y), (x, y))),
            ((0.0, -1.0), ((-x, -y), (x, -y))),
        ]

    def over_edge(self, place: Place, height_m: float) -> Space:
        """Return the tool's point in space for a point of the unrolled plane and a height: clear of the top's edge."""
        x, y = min(max(place[0], -self.half_x), self.half_x), min(max(place[1], -self.half_y), self.half_y)
        beyond = math.dist(place, (x, y))
        if beyond == 0.0:
            return x, y, height_m
        deep = beyond + height_m - REST_M  # how deep it hangs at rest
        clear = self.clear_m * min(beyond / min(deep, REST_M), 1.0) / beyond if beyond > NEAR_M / 10 else 0.0
        return x + clear * (place[0] - x), y + clear * (place[1] - y), height_m - beyond

    def unrolled(self, tool: Space) -> Place:
        """Return the place in the unrolled plane of cloth that a resting tool holds."""
        depth = REST_M - tool[2]
        assert depth > -NEAR_M, f"a tool at rest is {tool[2]:.4f} m high, not {REST_M} m or below the edge"
        if depth <= NEAR_M:
            return tool[:2]
        normal, line = min(self.edges, key=lambda edge: LineString(edge[1]).distance(Point(tool[:2])))
        gap = LineString(line).distance(Point(tool[:2]))
        assert abs(gap - self.clear_m) <= NEAR_M, f"a tool {depth:.3f} m below its rest is {gap:.4f} m from the edge"
        further = depth - self.clear_m
        return tool[0] + further * normal[0], tool[1] + further * normal[1]

    def hangs_towards(self, silhouette: BaseGeometry, direction: Place) -> bool:
        """Return whether cloth hangs from an edge that faces a direction."""
        x0, y0, x1, y1 = silhouette.bounds
        beyond = {(1.0, 0.0): x1 - self.half_x, (-1.0, 0.0): -x0 - self.half_x}
        beyond |= {(0.0, 1.0): y1 - self.half_y, (0.0, -1.0): -y0 - self.half_y}
        return any(n[0] * direction[0] + n[1] * direction[1] > 1e-9 and out > 1e-5 for n, out in beyond.items())

    def require_rest(self, layers: list[BaseGeometry], when: str) -> None:
        """Fail unless layers of cloth, table frame, left alone, stay as they are."""
        silhouette = together(layers)
        on_table = silhouette.intersection(self.top)
        assert on_table.area > SLIVER_M2, f"{when}: nothing of the cloth lies on the table"
        for corner in self.corners:
            is_inside = silhouette.contains(Point(corner)) and silhouette.boundary.distance(Point(corner)) > 1e-5
            assert not is_inside, f"{when}: the table's corner {corner} is covered"
        for part in polygons(silhouette.difference(self.top)):
            edges = [normal for normal, line in self.edges if _shared(part, line)]
            assert len(edges) == 1, f"{when}: a part hangs from {len(edges)} edges"
        pull, lying = np.zeros(2), 0.0
        for number, layer in enumerate(layers):
            lying += layer.intersection(self.top).area
            for part in polygons(layer.difference(self.top)):
                normal, line = max(self.edges, key=lambda edge: _least_beyond(part, edge))
                up = (-normal[0], -normal[1])
                loose = must_hold(part, up, _shared(part, line), self.support_rad)
                assert not loose, f"{when}: layer {number} hangs with nothing to hold {loose[0]}"
                pull += part.area * np.array(normal)
        assert np.hypot(*pull) <= self.friction * lying * (1 + 1e-4), (
            f"{when}: the cloth slips, {np.hypot(*pull) / lying:.3f} times its lying weight pulls"
        )


def _least_beyond(part: BaseGeometry, edge: tuple[Place, Line]) -> float:
    """Return how far beyond an edge's line the part's innermost point is (m)."""
    (nx, ny), ((x, y), _) = edge
    return float(min((px - x) * nx + (py - y) * ny for px, py in shapely.get_coordinates(part)))


def _shared(part: BaseGeometry, line: Line) -> list[Line]:
    """Return the stretches of a table edge on which a part's boundary lies."""
    common = LineString(line).intersection(part.buffer(2e-5))
    stretches = [s for s in shapely.get_parts(common) if s.length > NEAR_M]
    return [(s.coords[0], s.coords[-1]) for s in stretches]
