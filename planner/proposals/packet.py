"""A garment folded by some moves: its folds, its stack, and how good a packet it is."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TypeAlias

from planner.cloth.cloth_state import ClothState
from planner.cloth.garment import DrawnFold, Garment
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.isometry import Isometry
from planner.geometry.region import Region
from planner.geometry.tolerance import AREA_M2
from planner.proposals.moves import PARTS, Move, carried_out, line_across, rounded, turned_over
from planner.proposals.robot_check import RobotCheck, Stand
from planner.proposals.target import TOLERANCE_M, Sides

FOLD_EFFORT, LAYER_EFFORT, _TURN_EFFORT = 0.15, 0.03, 1.0
"""The efforts of a fold, of a layer of the stack and of turning it over, added to those of the moves."""

_ALIKE = {"roll": "thirds", "side": "thirds", "sides": "thirds", "flap": "flaps"}
"""Kinds of moves that count as variants of another one."""

_SAME_M = 0.005
"""Sides that differ by less are one size (m)."""


Way: TypeAlias = tuple[tuple[str, int], ...]
"""Moves by their kinds and axes."""


@dataclass(frozen=True)
class Packet:
    """A garment folded.

    Attributes:
        cloth: the stack.
        folds: all folds, those that stood at the beginning first.
        moves: the moves by which it was folded from there, each by its kind and axis.
        effort: the summed efforts of the moves, and of the robot where one is queried.
        is_turned: whether it was turned over, before them or after them.
        stand: where robot and cloth are after the folds that a robot was queried about; None before it was.
        queried: the number of those folds.
        doubts: the number of those that the robot probably cannot do.
        is_sketch: whether it was found without the robot, so that a variant may suit that better.
    """

    cloth: ClothState
    folds: tuple[DrawnFold, ...]
    moves: Way = field(default=())
    effort: float = 0.0
    is_turned: bool = False
    stand: Stand | None = None
    queried: int = 0
    doubts: int = 0
    is_sketch: bool = False

    @staticmethod
    def of(garment: Garment) -> "Packet":
        """Return the garment as its folds leave it; raises `FoldError` if one is not legal."""
        return Packet(FoldSequence.of(garment).final, garment.folds, queried=len(garment.folds))

    @cached_property
    def size_m(self) -> Sides:
        """The sides of the smallest rectangle along the garment frame's axes that holds the silhouette (m)."""
        x0, y0, x1, y1 = self.cloth.silhouette.bounds
        return (x1 - x0, y1 - y0)

    @property
    def box_m2(self) -> float:
        """The area of that rectangle (m^2)."""
        return self.size_m[0] * self.size_m[1]

    @property
    def hollow(self) -> float:
        """The share of that rectangle that no cloth covers."""
        return 1.0 - self.cloth.silhouette.area / self.box_m2

    @cached_property
    def taste(self) -> float:
        """How far it is from what people like: few, natural moves, few layers, a full rectangle; less is better."""
        return self.effort + FOLD_EFFORT * len(self.folds) + LAYER_EFFORT * len(self.cloth.layers) + self.hollow

    @cached_property
    def shape(self) -> tuple[int, ...]:
        """Equal for packets that look alike: sides, covered area, layers."""
        return (*grid_of(self.size_m), round(self.cloth.silhouette.area / _SAME_M), len(self.cloth.layers))

    @property
    def way(self) -> Way:
        """Equal for variants: packets whose moves differ in their order, their side, or in where exactly they fold."""
        return _way(self.moves)

    def way_with(self, move: Move) -> Way:
        """Return the way of this packet after one more move."""
        return _way((*self.moves, (move.kind, move.axis)))

    @cached_property
    def face(self) -> str:
        """The face of the cloth that is seen most from above: "front" or "back"."""
        seen_m2 = {"front": 0.0, "back": 0.0}
        above = Region.empty()
        for layer in reversed(self.cloth.layers):
            seen_m2[layer.face] += layer.region.difference(above).area
            above = Region.union([above, layer.region])
        return "back" if seen_m2["back"] > seen_m2["front"] + AREA_M2 else "front"

    @property
    def layers(self) -> int:
        """The most layers that lie on one another at one place."""
        stacked: list[Region] = []  # covered by at least one layer, by two, ...
        for layer in self.cloth.layers:
            doubled = [below.intersection(layer.region) for below in stacked]
            stacked = [
                Region.union([one, other]) for one, other in zip(stacked, [layer.region, *doubled], strict=False)
            ] + [doubled[-1] if doubled else layer.region]
            stacked = [region for region in stacked if not region.is_sliver]
        return len(stacked)

    def after(self, move: Move, grip_radius_m: float) -> "Packet | None":
        """Return the packet after one more move; None if it is not legal, or unfolds cloth beyond its place."""
        done = carried_out(self.cloth, move, grip_radius_m)
        if done is None:
            return None
        moves, effort = (*self.moves, (move.kind, move.axis)), self.effort + move.effort
        after = replace(self, cloth=done[0], folds=(*self.folds, *done[1]), moves=moves, effort=effort)
        is_in_place = all(side <= most + TOLERANCE_M for side, most in zip(after.size_m, move.size_m, strict=True))
        return after if is_in_place else None

    @property
    def is_checked(self) -> bool:
        """Whether a robot was queried about all folds."""
        return self.queried == len(self.folds)

    def checked(self, robot: RobotCheck) -> "Packet":
        """Return the packet with what the folds that a robot was not queried about mean to it."""
        found = robot.of(self.folds, self.queried, self.stand or robot.start)
        effort, doubts = self.effort + found.effort, self.doubts + found.doubts
        return replace(self, effort=effort, stand=found.stand, queried=len(self.folds), doubts=doubts)

    def images(self, outline: Region) -> Iterator[tuple[DrawnFold, ...]]:
        """Yield its folds mirrored, for each axis on which an outline lies symmetric; it was folded from that outline.

        They make the same packet, mirrored.
        """
        x0, y0, x1, y1 = outline.bounds
        for axis, middle in ((0, (x0 + x1) / 2), (1, (y0 + y1) / 2)):
            over = Isometry.reflection(line_across(axis, middle))
            if outline.difference(outline.moved(over)).area <= AREA_M2:
                yield tuple(_image(fold, axis, over) for fold in self.folds)

    def turned(self, grip_radius_m: float) -> "Iterator[Packet]":
        """Yield the packet turned over each of its sides that serves."""
        for cloth, fold in turned_over(self.cloth, grip_radius_m):
            effort = self.effort + _TURN_EFFORT
            yield replace(self, cloth=cloth, folds=(*self.folds, fold), effort=effort, is_turned=True)


def _image(fold: DrawnFold, axis: int, over: Isometry) -> DrawnFold:
    """Return a fold mirrored across an axis, with the image of what moves to the left of its line again."""
    other = dict(zip(PARTS[axis], reversed(PARTS[axis]), strict=True))
    name = " ".join(other.get(word, word) for word in fold.name.split())
    start, end = rounded(over.apply_point(fold.end)), rounded(over.apply_point(fold.start))
    return replace(fold, name=name, start=start, end=end)


def grid_of(size_m: Sides) -> tuple[int, ...]:
    """Return sides as numbers that are equal for rectangles of one size, either way round."""
    return tuple(sorted(round(side / _SAME_M) for side in size_m))


def _way(moves: Way) -> Way:
    return tuple(sorted((_ALIKE.get(kind, kind), axis) for kind, axis in moves))
