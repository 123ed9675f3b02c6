"""The state of the world between two primitives: the cloth, the base, and what is held.

Any g-state (paper, section 4) may be the start of a task. Between the steps of a plan it records the plan's progress,
so that planning can continue from there.
"""

from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

from planner.geometry.given import PlanePoint
from planner.geometry.pose import Point2, Point3, Pose2
from planner.json_form import STRICT, JsonForm

GripKind: TypeAlias = Literal["edge", "top"]
"""How fingers hold cloth: one under it and one over it, or both from above, closing along the table."""


@dataclass(frozen=True, slots=True)
class Grip:
    """The path of one arm's tool frame, table frame (m).

    Attributes:
        arm: the arm's name.
        pick: the point where the arm takes the cloth, or holds it from the start.
        apex: the highest point of a fold's path; None in a drag.
        place: the end of the path.
        kind: how the fingers hold the cloth; None in plans of versions that did not say it.
    """

    arm: str
    pick: Point3
    apex: Point3 | None
    place: Point3
    kind: GripKind | None = None

    def to_dict(self) -> dict[str, Any]:
        """Return the grip as JSON."""
        apex = None if self.apex is None else list(self.apex)
        written = {"arm": self.arm, "pick": list(self.pick), "apex": apex, "place": list(self.place)}
        return written if self.kind is None else {**written, "kind": self.kind}


@dataclass(frozen=True, slots=True)
class Holding:
    """The grip of one arm in a step, and the vertices it holds.

    Attributes:
        arm: the arm's name.
        point: the grip's position, garment frame as the cloth lies before the step (m).
        vertices: the vertices that this grip holds of those that must be held, same frame (m).
    """

    arm: str
    point: Point2
    vertices: tuple[Point2, ...]


@dataclass(frozen=True, slots=True)
class BaseStop:
    """The base's place in the table frame.

    Attributes:
        station: the station's name; None if it stands at none.
        back_off_m: how far it has backed off from the station, along its own -x (m).
        x_m: the base's x (m).
        y_m: its y (m).
        yaw_rad: its heading (rad).
    """

    station: str | None
    back_off_m: float
    x_m: float
    y_m: float
    yaw_rad: float

    @staticmethod
    def at(station: str | None, station_pose: Pose2, back_off_m: float = 0.0) -> "BaseStop":
        """Return the place of a base that stands back from a station's pose."""
        pose = station_pose.ahead(-back_off_m)
        return BaseStop(station, back_off_m, pose.x_m, pose.y_m, pose.yaw_rad)

    @property
    def pose(self) -> Pose2:
        """The base's pose in the table frame."""
        return Pose2(self.x_m, self.y_m, self.yaw_rad)

    def to_dict(self) -> dict[str, Any]:
        """Return the place as JSON."""
        return {name: getattr(self, name) for name in self.__slots__}


@dataclass(frozen=True, slots=True)
class HeldPoint:
    """A point of the cloth that one arm holds.

    Attributes:
        arm: the arm's name.
        point: the point, garment frame (m).
    """

    arm: str
    point: PlanePoint


@dataclass(frozen=True, slots=True)
class WorldState:
    """Cloth, base and hands at one moment.

    Attributes:
        folds_done: the indices of the folds done, in the order in which they were made.
        placement: the garment frame in the table frame.
        base: the base's place.
        held: the points that are held, arm by arm; empty when all hands are free.
        dragged_m: the length of the drag after which the cloth is still held (m); 0 if nothing is held, or if it is
            held after a fold, for the red fold that follows.
    """

    __pydantic_config__ = STRICT

    folds_done: tuple[int, ...]
    placement: Pose2
    base: BaseStop
    held: tuple[HeldPoint, ...] = ()
    dragged_m: float = 0.0

    def to_dict(self) -> dict[str, Any]:
        """Return the state as JSON."""
        written: dict[str, Any] = WORLD_STATES.write(self)
        return written

    @property
    def done(self) -> int:
        """The folds done, as a bit mask."""
        return sum(1 << fold for fold in set(self.folds_done))


WORLD_STATES = JsonForm(WorldState)
"""Reads and writes states of the world."""
