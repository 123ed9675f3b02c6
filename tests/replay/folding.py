"""The folds of a garment for the checker: layers as bare polygons, the Fold-DAG by its definition."""

import math
from dataclasses import dataclass
from typing import Any

import shapely
from shapely import LineString, Point, Polygon
from shapely.geometry.base import BaseGeometry

from tests.replay.flat import SLIVER_M2, Line, cut_along, mirrored, polygons, together, without_hairs


@dataclass(frozen=True)
class Sheet:
    """A layer of the folded garment, in the garment frame."""

    shape: BaseGeometry
    is_front_up: bool


@dataclass(frozen=True)
class Stack:
    """Layers from bottom to top; the topmost `moved` came there with the last fold."""

    sheets: tuple[Sheet, ...]
    moved: int = 0

    @property
    def shapes(self) -> list[BaseGeometry]:
        return [sheet.shape for sheet in self.sheets]

    def active(self, is_red: bool) -> tuple[Sheet, ...]:
        return self.sheets[len(self.sheets) - self.moved :] if is_red else self.sheets

    def moving_part(self, line: Line, is_red: bool) -> BaseGeometry:
        """Return the part of the silhouette that a fold over this line moves."""
        return cut_along(together(sheet.shape for sheet in self.active(is_red)), line)

    def folded(self, line: Line, is_red: bool) -> "Stack":
        moving = self.moving_part(line, is_red)
        active = self.active(is_red)
        stays = list(self.sheets[: len(self.sheets) - len(active)])
        moves = []
        for sheet in active:
            remains, comes = sheet.shape.difference(moving), sheet.shape.intersection(moving)
            stays += [Sheet(p, sheet.is_front_up) for p in polygons(without_hairs(remains))]
            moves += [Sheet(p, sheet.is_front_up) for p in polygons(without_hairs(comes))]
        landed = [Sheet(mirrored(line, s.shape), not s.is_front_up) for s in reversed(moves)]
        return Stack((*stays, *landed), len(landed))


class Folds:
    """A garment's folds, made legal in the user's order."""

    def __init__(self, garment: dict[str, Any]) -> None:
        self.start = Stack((Sheet(Polygon(garment["outline"]), True),))
        self.is_red = [fold["kind"] == "red" for fold in garment["folds"]]
        self.names = [fold["name"] for fold in garment["folds"]]
        self.radii = [fold["grip_radius_m"] for fold in garment["folds"]]
        self.lines: list[Line] = []
        self.parts: list[BaseGeometry] = []
        stack = self.start
        for fold, is_red in zip(garment["folds"], self.is_red, strict=True):
            silhouette = together(sheet.shape for sheet in stack.active(is_red))
            line = (_snapped(fold["start"], silhouette), _snapped(fold["end"], silhouette))
            assert LineString(line).difference(silhouette.buffer(2e-5)).length < 1e-4, (
                f"{fold['name']}: the line leaves the silhouette"
            )
            moving = stack.moving_part(line, is_red)
            self.lines.append(line)
            self.parts.append(together([moving, mirrored(line, moving)]))
            stack = stack.folded(line, is_red)
        self.final = stack

    def __len__(self) -> int:
        return len(self.lines)

    def before(self) -> dict[int, set[int]]:
        """Return for each fold all the folds that must precede it."""
        earlier: dict[int, set[int]] = {}
        for b in range(len(self)):
            direct = {a for a in range(b) if self.parts[a].intersection(self.parts[b]).area > SLIVER_M2}
            direct |= {b - 1} if self.is_red[b] else set()
            earlier[b] = direct.union(*(earlier[a] for a in direct))
        return earlier

    def edges(self) -> list[list[int]]:
        """Return the transitive reduction of that order, as pairs."""
        earlier = self.before()
        return sorted(
            [a, b]
            for b, before in earlier.items()
            for a in before
            if not any(a in earlier[between] for between in before)
        )


def _snapped(point: list[float], silhouette: BaseGeometry) -> tuple[float, float]:
    foot = shapely.shortest_line(Point(point), silhouette.boundary).coords[1]
    assert math.dist(foot, point) <= 0.005 + 1e-9, f"{point} is more than 5 mm from the silhouette"
    return foot[0], foot[1]


def require_same_stack(found: Stack, wanted: list[dict[str, Any]]) -> None:
    """Fail unless two stacks have the same layers everywhere in the same order."""
    faces = {layer["face"] for layer in wanted}
    assert faces <= {"front", "back"}, f"the faces are {faces}"
    theirs = [Sheet(Polygon(layer["polygon"]), layer["face"] == "front") for layer in wanted]
    areas = [sum(sheet.shape.area for sheet in sheets) for sheets in (found.sheets, theirs)]
    assert abs(areas[0] - areas[1]) < 1e-4 * areas[0], f"{areas[0]:.5f} m^2 of cloth became {areas[1]:.5f} m^2"
    assert len(found.sheets) == len(theirs), f"{len(found.sheets)} layers, the plan says {len(theirs)}"
    rings = [sheet.shape.boundary for sheet in (*found.sheets, *theirs)]
    for cell in shapely.get_parts(shapely.polygonize([shapely.union_all(rings, grid_size=1e-6)])):
        if cell.area < 10 * SLIVER_M2:
            continue
        spot = shapely.point_on_surface(cell)
        ours, plans = ([s for s in sheets if s.shape.covers(spot)] for sheets in (found.sheets, theirs))
        assert len(ours) == len(plans), f"at {spot} {len(ours)} layers lie, the plan says {len(plans)}"
        for level, (one, other) in enumerate(zip(ours, plans, strict=True)):
            is_same = one.shape.symmetric_difference(other.shape).area < 10 * SLIVER_M2
            assert is_same and one.is_front_up == other.is_front_up, f"layer {level} at {spot} is another one"
