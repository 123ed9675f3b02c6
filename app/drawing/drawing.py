"""What somebody draws: an outline, folds whose ends are tied to the cloth, where it lies, and in which scene.

A drawing may be wrong: an outline that crosses itself, a fold that ends off the cloth. It is a value like any other
then, and what is wrong with it is found by solving it (`app.drawing.solve`). Corners and folds have names that
stay the same while the drawing changes, so that a tie means the same corner when others come and go.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeAlias

from planner.geometry.pose import Point2, Pose2
from planner.task.scene import Scene


@dataclass(frozen=True, slots=True)
class Corner:
    """A corner of the outline.

    Attributes:
        id: its name in this drawing.
        point: where it is, article frame (m).
    """

    id: str
    point: Point2


@dataclass(frozen=True, slots=True)
class CornerTie:
    """Tied to a corner of the outline."""

    corner: str


@dataclass(frozen=True, slots=True)
class EdgeTie:
    """Tied to the outline from one corner on to another, at a fraction of the way.

    They are neighbours, until somebody puts a corner between them.
    """

    start: str
    end: str
    fraction: float


@dataclass(frozen=True, slots=True)
class CreaseTie:
    """Tied to the line of an earlier fold.

    Attributes:
        fold: the earlier fold.
        fraction: from its start.
        carried: the folds before that one which had moved the layer that is meant.
    """

    fold: str
    fraction: float
    carried: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class ChordTie:
    """Not tied to anything: the end is where the fold's line meets the boundary, nearest to its point."""


Tie: TypeAlias = CornerTie | EdgeTie | CreaseTie | ChordTie


@dataclass(frozen=True, slots=True)
class End:
    """An end of a fold.

    Attributes:
        point: where it is, article frame, cloth as it is when the fold's turn comes (m).
        tie: what it is tied to; None for an end just drawn, or one that nothing can be found for.
    """

    point: Point2
    tie: Tie | None = None


@dataclass(frozen=True, slots=True)
class Crease:
    """A fold as it is drawn; what lies to the left of start -> end moves.

    Attributes:
        id: its name in this drawing.
        name: what the user calls it.
        kind: "blue" or "red".
        start: the first end.
        end: the second end.
        grip_radius_m: how far round itself one grip holds the cloth (m); None: as the article's.
        twin: the fold that mirrors this one, if they are linked.
    """

    id: str
    name: str
    kind: str
    start: End
    end: End
    grip_radius_m: float | None = None
    twin: str | None = None

    @property
    def is_red(self) -> bool:
        """Whether it folds only the layers that the fold before it moved."""
        return self.kind == "red"

    @property
    def ends(self) -> tuple[End, End]:
        """Both ends, the first first."""
        return (self.start, self.end)


@dataclass(frozen=True, slots=True)
class Drawing:
    """A garment as it is drawn, and the circumstances under which it is to be folded.

    Attributes:
        name: the garment's name, also its file's.
        title: what people call it.
        outline: the corners; any number, in any places.
        areal_density_kg_m2: the cloth's mass per area.
        grip_radius_m: how far round itself one grip holds the cloth, unless a fold says otherwise (m).
        folds: the folds in the user's order.
        placement: the article frame in the table frame.
        scene: table, stations and costs.
        start_station: where the robot stands at the start; need not be one of the scene's.
        comfort_radius_m: how much slack every reach has (m).
    """

    name: str
    title: str
    outline: tuple[Corner, ...]
    areal_density_kg_m2: float
    grip_radius_m: float
    folds: tuple[Crease, ...]
    placement: Pose2
    scene: Scene
    start_station: str
    comfort_radius_m: float

    @property
    def points(self) -> tuple[Point2, ...]:
        """The outline's corners as points (m)."""
        return tuple(corner.point for corner in self.outline)


def fresh_ids(prefix: str, taken: Iterable[str | None], count: int) -> list[str]:
    """So many names that are not taken yet: a letter and the smallest numbers."""
    used = set(taken)
    found: list[str] = []
    number = 0
    while len(found) < count:
        if (name := f"{prefix}{number}") not in used:
            found.append(name)
        number += 1
    return found
