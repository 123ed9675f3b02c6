"""A phase: a stretch of time in which everything moves evenly.

A primitive is cut into phases. In a phase the base goes straight from one pose to another or turns in place, each hand
is free or follows points at an even pace in one orientation, and the cloth is carried along, folded a part of the way,
or lies still. Playback turns phases into cloth surfaces without knowing which primitive they came from.
"""

import math
from dataclasses import dataclass
from typing import Annotated

from pydantic import PlainSerializer, PlainValidator, WithJsonSchema

from planner.geometry.pose import Approach, Point3, Pose2
from planner.geometry.table_top import TableTop


def _read_top(data: object) -> TableTop:
    """Read the lowest and highest x and y of a table top; null stands for infinity."""
    match data:
        case [[x0, y0], [x1, y1]]:
            return TableTop((_or(x0, -math.inf), _or(y0, -math.inf)), (_or(x1, math.inf), _or(y1, math.inf)))
    raise ValueError("should be the lowest and the highest x and y")


def _or(number: object, infinity: float) -> float:
    if number is None:
        return infinity
    if isinstance(number, bool) or not isinstance(number, int | float):
        raise ValueError(f"{number!r} is no number")
    return float(number)


def _write_top(top: TableTop) -> list[list[float | None]]:
    return [[n if math.isfinite(n) else None for n in corner] for corner in (top.low, top.high)]


_CORNER = {"type": "array", "items": {"anyOf": [{"type": "number"}, {"type": "null"}]}, "minItems": 2, "maxItems": 2}
_TOP = {"type": "array", "items": _CORNER, "minItems": 2, "maxItems": 2}

WrittenTop = Annotated[TableTop, PlainValidator(_read_top), PlainSerializer(_write_top), WithJsonSchema(_TOP)]
"""A table top whose JSON has null where it is open."""


@dataclass(frozen=True, slots=True)
class Hand:
    """The motion of one hand in a phase.

    Attributes:
        approach: the tool's orientation in the base frame, held through the phase.
        points: the tool's path in the table frame (m), one or more points, passed at an even pace.
        is_closed: whether the fingers hold cloth.
        is_reaching: the hand travels to the (only) point from wherever it is, by way of points
            above its position and above its goal.
        rolls_rad: the tool's roll about its approach axis at each point since the primitive began; empty: none.
    """

    approach: Approach
    points: tuple[Point3, ...]
    is_closed: bool
    is_reaching: bool = False
    rolls_rad: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class ClothMotion:
    """The motion of the cloth in a phase.

    Attributes:
        done: the folds finished before, as a bit mask.
        start: the article's placement at the start of the phase (article frame in table frame).
        end: the placement at its end; in between it is interpolated.
        fold: the fold in progress, or None.
        sweep: the progress of that fold at the start and the end of the phase: 0 flat, 1 standing over
            the fold line (the apex), 2 laid down.
        top: the table top beyond which cloth hangs; open at an edge over which the cloth is held out.
    """

    done: int
    start: Pose2
    end: Pose2
    top: WrittenTop
    fold: int | None = None
    sweep: tuple[float, float] = (0.0, 0.0)

    @property
    def way(self) -> float:
        """How far it moves: the sweep of a fold, or the distance by which it is carried (m)."""
        if self.fold is not None:
            return self.sweep[1] - self.sweep[0]
        return math.dist((self.start.x_m, self.start.y_m), (self.end.x_m, self.end.y_m))


@dataclass(frozen=True, slots=True)
class Phase:
    """A stretch of time in which everything moves evenly.

    Attributes:
        duration_s: its length (s), not negative.
        base: the base's pose at the start and the end, table frame.
        hands: one entry for each arm from left to right; None: the hand is free and goes home.
        cloth: the motion of the cloth.
        motion: the index of the primitive's arm motion that it is a part of: phases of one arm motion share its time
            as the joints need it; None: the base drives or nothing moves, and the phase keeps its duration.
    """

    duration_s: float
    base: tuple[Pose2, Pose2]
    hands: tuple[Hand | None, ...]
    cloth: ClothMotion
    motion: int | None = None
