"""Whether cloth left alone on the table stays as it is: a g-state (paper, section 4).

Everything is asked in the article frame: moving the table's rectangle there is one cheap operation, moving a
stack of layers to the table is not.
"""

import math
from dataclasses import dataclass

import numpy as np

from planner.cloth.cloth_state import ClothState
from planner.cloth.must_hold import must_hold
from planner.geometry.pose import Point2, Pose2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.table import Table
from planner.geometry.tolerance import LENGTH_M


@dataclass(frozen=True, slots=True)
class Unrest:
    """Why cloth would not stay as it is.

    Attributes:
        code: "not_a_g_state" or "slips".
        message: what would move, with the numbers.
        severity: how far from rest it is; only for comparing like with like.
    """

    code: str
    message: str
    severity: float = 1.0


@dataclass(frozen=True, slots=True)
class TableInArticle:
    """The table top seen from the article frame.

    Attributes:
        region: the rectangle.
        edges: its four edges counter-clockwise; outwards is to the right of each.
    """

    region: Region
    edges: tuple[Segment, ...]

    @staticmethod
    def seen_from(placement: Pose2, table: Table) -> "TableInArticle":
        """The table top as an article with this placement sees it."""
        corners = placement.to_inner(np.array(table.corners))
        points: list[Point2] = [(float(x), float(y)) for x, y in corners]
        edges = tuple(Segment(points[i], points[(i + 1) % 4]) for i in range(4))
        return TableInArticle(Region.polygon(points), edges)

    def contains(self, region: Region) -> bool:
        """Whether a region lies on the table altogether, to the tolerance."""
        return all(np.all(e.left_distances(region.coordinates) >= -LENGTH_M) for e in self.edges)


EDGE_NAMES = ("right", "far", "left", "near")
"""The table's edges, in the order of `TableInArticle.edges`, as seen from the station `front`."""


def unrest(
    cloth: ClothState, placement: Pose2, table: Table, friction: float, support_angle_rad: float
) -> Unrest | None:
    """Why the cloth, left alone, would move; None if it is in a g-state.

    Args:
        cloth: the stack.
        placement: the article frame in the table frame.
        table: the table.
        friction: coefficient of static friction between cloth and table.
        support_angle_rad: see `must_hold` (rad).
    """
    top = TableInArticle.seen_from(placement, table)
    if top.contains(cloth.silhouette):
        return None
    if cloth.silhouette.intersection(top.region).is_sliver:
        return Unrest("not_a_g_state", "nothing of the cloth lies on the table")
    return (
        _covered_corner(cloth, top, table) or _loose_part(cloth, top, support_angle_rad) or _slip(cloth, top, friction)
    )


def _covered_corner(cloth: ClothState, top: TableInArticle, table: Table) -> Unrest | None:
    for edge, (x, y) in zip(top.edges, table.corners, strict=True):
        if cloth.silhouette.contains(edge.start, margin_m=LENGTH_M):
            return Unrest("not_a_g_state", f"the cloth covers the table's corner at ({x:.3f}, {y:.3f}) m")
    for part in cloth.silhouette.difference(top.region).pieces:
        hung = [name for name, e in zip(EDGE_NAMES, top.edges, strict=True) if _touches(part, e)]
        if len(hung) != 1:
            where = " and ".join(hung) or "no edge"
            return Unrest("not_a_g_state", f"a part of {part.area:.4f} m^2 hangs from {where} at once")
    return None


def _touches(part: Region, edge: Segment) -> bool:
    """Whether a part beyond the table has a stretch of its boundary on an edge."""
    return bool(_contact(part, edge))


def _contact(part: Region, edge: Segment) -> tuple[Segment, ...]:
    """The stretches of a table edge from which a part beyond it hangs."""
    points = part.coordinates
    on_edge = edge.distances(points) <= LENGTH_M
    both = on_edge[:-1] & on_edge[1:]
    ends = zip(points[:-1][both], points[1:][both], strict=True)
    return tuple(
        Segment((float(a[0]), float(a[1])), (float(b[0]), float(b[1])))
        for a, b in ends
        if np.hypot(*(a - b)) > LENGTH_M
    )


def _loose_part(cloth: ClothState, top: TableInArticle, support_angle_rad: float) -> Unrest | None:
    """The first hanging part of a layer that nothing immobilises (Theorem 1; Figure 4, right)."""
    for number, layer in enumerate(cloth.layers):
        if top.contains(layer.region):
            continue
        for part in layer.region.difference(top.region).pieces:
            edge = min(range(4), key=lambda i: _inward_distance(part, top.edges[i]))
            up = top.edges[edge].left
            loose = must_hold(part, up, _contact(part, top.edges[edge]), support_angle_rad)
            if len(loose):
                return Unrest(
                    "not_a_g_state",
                    f"layer {number} hangs over the {EDGE_NAMES[edge]} edge and nothing holds its corner "
                    f"at ({loose[0][0]:.3f}, {loose[0][1]:.3f}) m of the article",
                )
    return None


def _inward_distance(part: Region, edge: Segment) -> float:
    """How far inside an edge's line the innermost point of a part is (m): negative beyond it."""
    return float(edge.left_distances(part.coordinates).max())


def _slip(cloth: ClothState, top: TableInArticle, friction: float) -> Unrest | None:
    """The friction law: the net pull of all hanging parts against what the weight on the table holds."""
    pull, lying = np.zeros(2), 0.0
    for layer in cloth.layers:
        lying += layer.region.intersection(top.region).area
        for part in layer.region.difference(top.region).pieces:
            edge = min(top.edges, key=lambda e: _inward_distance(part, e))
            pull -= part.area * np.array(edge.left)
    held = friction * lying
    if np.hypot(*pull) <= held * (1.0 + LENGTH_M):
        return None
    share = math.inf if lying == 0.0 else float(np.hypot(*pull)) / lying
    return Unrest(
        "slips",
        f"the hanging parts pull with {share:.2f} times the weight on the table; friction holds {friction:.2f} times",
        share,
    )
