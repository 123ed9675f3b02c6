"""The test for a g-state (paper, section 4): cloth that stays as it is when left alone on the table.

All computations are in the garment frame: moving the table's rectangle there is one cheap operation, moving a
stack of layers to the table is not.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from planner.cloth.cloth_state import ClothState
from planner.cloth.must_hold import must_hold
from planner.geometry.pose import FloatArray, Point2, Pose2
from planner.geometry.region import Region
from planner.geometry.segment import Segment
from planner.geometry.table import Table
from planner.geometry.tolerance import AREA_M2, LENGTH_M
from planner.message import Message
from planner.words.catalogue import worded

_UNRESTS_KEPT = 2048
"""Answers that are remembered: stacks at a placement."""


@dataclass(frozen=True, slots=True)
class StabilityViolation:
    """The reason why cloth would not stay as it is.

    Attributes:
        code: "not_a_g_state" or "slips".
        says: what would move, with the numbers.
        severity: the distance from rest: how far the cloth would have to be moved (m), 1 if that is unknown; for cloth
            that slips, how much the friction coefficient falls short.
        point: where it would move, garment frame (m); None if that is no single place.
        needed_friction: for cloth that slips, the friction coefficient that would hold it.
    """

    code: str
    says: Message
    severity: float = 1.0
    point: Point2 | None = None
    needed_friction: float | None = None

    @property
    def message(self) -> str:
        """The sentence that names the cloth that would move."""
        return self.says.text


@dataclass(frozen=True, eq=False)
class TableInGarment:
    """The table top seen from the garment frame.

    Attributes:
        table: the table.
        corners: its corners, counter-clockwise, shape (4, 2), m.
    """

    table: Table
    corners: FloatArray

    @staticmethod
    def seen_from(placement: Pose2, table: Table) -> "TableInGarment":
        """Return the table top as seen from a garment with this placement."""
        return TableInGarment(table, placement.to_inner(np.array(table.corners)))

    @cached_property
    def region(self) -> Region:
        """The rectangle."""
        return Region.polygon(self.corners)

    @cached_property
    def edges(self) -> tuple[Segment, ...]:
        """The four edges counter-clockwise; the outside is to the right of each."""
        points: list[Point2] = [(x, y) for x, y in self.corners.tolist()]
        return tuple(Segment(points[i], points[(i + 1) % 4]) for i in range(4))

    def contains(self, region: Region) -> bool:
        """Return whether a region lies on the table altogether, to the tolerance."""
        return bool(np.all(self.inside(region.coordinates) >= -LENGTH_M))

    def inside(self, points: FloatArray) -> FloatArray:
        """Return how far inside each edge's line points are, shape (n, 2) -> (n, 4), m; negative beyond it."""
        return np.asarray(points @ self._inwards - self._reach)

    @cached_property
    def _inwards(self) -> FloatArray:
        return np.array([edge.left for edge in self.edges]).T

    @cached_property
    def _reach(self) -> FloatArray:
        return np.array([np.dot(edge.left, edge.start) for edge in self.edges])


EDGE_NAMES = ("right", "far", "left", "near")
"""The table's edges, in the order of `TableInGarment.edges`, as seen from the station `front`."""


def stability_violation(
    cloth: ClothState, top: TableInGarment, friction: float, support_angle_rad: float
) -> StabilityViolation | None:
    """Return why the cloth, left alone, would move; None if it is in a g-state.

    Args:
        cloth: the stack.
        top: the table top.
        friction: coefficient of static friction between cloth and table.
        support_angle_rad: see `must_hold` (rad).
    """
    if top.contains(cloth.silhouette):
        return None
    beyond = cloth.silhouette.difference(top.region)
    if cloth.silhouette.area - beyond.area < AREA_M2:
        off = min(cloth.silhouette.distance_to(edge) for edge in top.edges)
        return StabilityViolation("not_a_g_state", worded("beside_table", {"off_m": float(off)}), off)
    covered = _covered_corner(cloth, beyond, top)
    if covered is not None:
        return covered
    hanging = list(_hanging_parts(cloth, beyond, top))
    return _loose_part(hanging, top, support_angle_rad) or _slip(cloth, hanging, top, friction)


@lru_cache(_UNRESTS_KEPT)
def stability_violation_at(
    cloth: ClothState, placement: Pose2, table: Table, friction: float, support_angle_rad: float
) -> StabilityViolation | None:
    """Return `stability_violation` of a stack with a placement; cached, as garments that begin alike share stacks."""
    return stability_violation(cloth, TableInGarment.seen_from(placement, table), friction, support_angle_rad)


@dataclass(frozen=True, slots=True)
class _Hanging:
    """A part of a layer beyond the table: the layer's index, the part, the index of the edge it hangs from."""

    layer: int
    part: Region
    edge: int


def _hanging_parts(cloth: ClothState, beyond: Region, top: TableInGarment) -> Iterator[_Hanging]:
    """Return the hanging parts of each layer; `beyond` is the part of the silhouette beyond the table."""
    for number, layer in enumerate(cloth.layers):
        if not top.contains(layer.region):
            off = beyond if len(cloth.layers) == 1 else layer.region.difference(top.region)
            for part in off.pieces:
                yield _Hanging(number, part, int(top.inside(part.coordinates).max(axis=0).argmin()))


def _covered_corner(cloth: ClothState, beyond: Region, top: TableInGarment) -> StabilityViolation | None:
    for edge, (x, y) in zip(top.edges, top.table.corners, strict=True):
        if cloth.silhouette.contains(edge.start, margin_m=LENGTH_M):
            depth = cloth.silhouette.boundary_distance(edge.start)
            says = worded("corner_covered", {"corner": [x, y], "depth_m": float(depth)})
            return StabilityViolation("not_a_g_state", says, depth, edge.start)
    for part in beyond.pieces:
        near = np.count_nonzero(np.abs(top.inside(part.coordinates)) <= LENGTH_M, axis=0)
        edges = zip(EDGE_NAMES, top.edges, near, strict=True)
        hung = [name for name, edge, points in edges if points >= 2 and _touches(part, edge)]
        if len(hung) != 1:
            says = worded("hangs_from_several", {"area_m2": part.area, "edges": hung})
            return StabilityViolation("not_a_g_state", says)
    return None


def _touches(part: Region, edge: Segment) -> bool:
    """Return whether a part beyond the table has a stretch of its boundary on an edge."""
    return bool(_contact(part, edge))


def _contact(part: Region, edge: Segment) -> tuple[Segment, ...]:
    """Return the stretches of a table edge from which a part beyond it hangs."""
    points = part.coordinates
    on_edge = edge.distances(points) <= LENGTH_M
    both = on_edge[:-1] & on_edge[1:]
    ends = zip(points[:-1][both], points[1:][both], strict=True)
    return tuple(
        Segment((float(a[0]), float(a[1])), (float(b[0]), float(b[1])))
        for a, b in ends
        if np.hypot(*(a - b)) > LENGTH_M
    )


def _loose_part(hanging: list[_Hanging], top: TableInGarment, support_angle_rad: float) -> StabilityViolation | None:
    """Return the first hanging part of a layer that nothing immobilises (Theorem 1; Figure 4, right)."""
    for hung in hanging:
        edge = top.edges[hung.edge]
        loose = must_hold(hung.part, edge.left, _contact(hung.part, edge), support_angle_rad)
        if len(loose):
            depths = -edge.left_distances(loose)
            lowest, (x, y) = float(depths.max()), loose[int(depths.argmax())]
            name, at = EDGE_NAMES[hung.edge], (float(x), float(y))
            values = {"layer": hung.layer, "edge": name, "at": list(at), "beyond_m": lowest}
            return StabilityViolation("not_a_g_state", worded("hangs_loose", values), lowest, at)
    return None


def needed_friction(cloth: ClothState, top: TableInGarment) -> float:
    """Return the least friction coefficient at which the cloth does not slip; 0 where nothing pulls at it."""
    if top.contains(cloth.silhouette):
        return 0.0
    hanging = _hanging_areas(list(_hanging_parts(cloth, cloth.silhouette.difference(top.region), top)), top)
    pull, lying = _pull(hanging, top), _lying(cloth, hanging)
    return 0.0 if is_held(pull, lying, 0.0) else pull / max(lying, AREA_M2)


def is_held(pull_m2: float, lying_m2: float, friction: float) -> bool:
    """Return whether friction on the cloth that lies (m^2, layers counted) holds a pull (m^2) against it.

    A pull below the weight of a sliver of cloth counts as none: sums of areas that balance differ by rounding, which
    friction need not hold.
    """
    return pull_m2 <= max(friction * lying_m2 * (1.0 + LENGTH_M), AREA_M2)


def _slip(cloth: ClothState, parts: list[_Hanging], top: TableInGarment, friction: float) -> StabilityViolation | None:
    """Return why the cloth slips: its net pull over the edges exceeds the friction of the cloth that lies."""
    hanging = _hanging_areas(parts, top)
    pull, lying = _pull(hanging, top), _lying(cloth, hanging)
    if is_held(pull, lying, friction):
        return None
    needed = pull / max(lying, AREA_M2)
    over = {name: area for area, name in zip(hanging, EDGE_NAMES, strict=True) if area > 0.0}
    values = {"hanging_m2": over, "lying_m2": lying, "friction": friction, "needed_friction": needed}
    return StabilityViolation("slips", worded("slips", values), needed - friction, needed_friction=needed)


def _hanging_areas(parts: list[_Hanging], top: TableInGarment) -> list[float]:
    """Return the area that hangs over each edge, layers counted (m^2)."""
    return [sum(hung.part.area for hung in parts if hung.edge == edge) for edge in range(len(top.edges))]


def _pull(hanging: list[float], top: TableInGarment) -> float:
    """Return the net pull of the cloth that hangs over the edges (m^2)."""
    return float(np.hypot(*(np.array(hanging) @ np.array([edge.left for edge in top.edges]))))


def _lying(cloth: ClothState, hanging: list[float]) -> float:
    """Return the area that lies on the table, layers counted (m^2)."""
    return max(sum(layer.region.area for layer in cloth.layers) - sum(hanging), 0.0)
