"""The port to a world in which a plan is performed: simulated, recorded, or a laboratory's own robot."""

from collections.abc import Callable, Container, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from app.rehearsal.camera.camera import Camera
from app.rehearsal.camera.posture import Posture
from app.step_kinds import step_kind
from planner.geometry.pose import FloatArray, Point3, Pose2


@dataclass(frozen=True)
class GripMotion:
    """The motion of one hand while it holds cloth.

    Attributes:
        arm: the arm's name.
        times_s: the times of the points since the step's start, rising (s).
        points: the tool's path, table frame (m); between two points it moves evenly on a straight line.
        closes: whether the fingers close on the cloth at the first point; if not, they hold it already.
        opens: whether they open at the last point; if not, they hold on for the next step.
        turned_rad: how far the hand has rolled over with the cloth at each point (rad); empty: it does not roll.
        heading_rad: the direction in which its fingers point, horizontal, table frame, while one is under the cloth and
            one over it (rad); None where they are side by side, or nobody has said.
        layers: how many layers from the top down they take where they close, at a free edge of these; None: all.
        goes_on_m: how far the open hand goes on in that direction before it is drawn back (m).
    """

    arm: str
    times_s: tuple[float, ...]
    points: tuple[Point3, ...]
    closes: bool = True
    opens: bool = True
    turned_rad: tuple[float, ...] = ()
    heading_rad: float | None = None
    layers: int | None = None
    goes_on_m: float = 0.0

    def at(self, t_s: float) -> FloatArray:
        """Return the tool's position at a time since the step's start (s), shape (3,), m."""
        times, *axes = self._track
        return np.array([np.interp(t_s, times, axis) for axis in axes])

    def turned_at(self, t_s: float) -> float:
        """Return how far the hand has rolled over with the cloth at a time since the step's start (rad)."""
        return float(np.interp(t_s, self.times_s, self.turned_rad)) if self.turned_rad else 0.0

    def along(self, points: FloatArray) -> "GripMotion":
        """Return the same motion along other points, shape (n, 3), m."""
        return replace(self, points=tuple((x, y, z) for x, y, z in points.tolist()))

    @cached_property
    def _track(self) -> FloatArray:
        """The times and the points' coordinates, each a row: a simulation asks at every time step."""
        return np.ascontiguousarray(np.column_stack([self.times_s, self.points]).T)


def way_done(points: FloatArray) -> FloatArray:
    """Return the fraction of a path that is done at each of its points, shape (n, 3) -> (n,)."""
    lengths = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    return np.asarray(lengths / max(float(lengths[-1]), 1e-9))


WITHDRAW, REACH = "withdraw", "reach"
"""The kinds of motions in which no hand holds cloth, for a look: arms get out of the camera's way, or hands are held
where they are to close."""

LAY = "lay"
"""The kind of a motion in which hands lay down again, in its place, what a step has laid down beside it."""


@dataclass(frozen=True, slots=True)
class StepMotion:
    """The motions of all hands that hold cloth in one step of a plan.

    Attributes:
        step: the index of the plan's step.
        kind: the step's kind (`STEP_KINDS`); `WITHDRAW` and `REACH` for a look, `LAY` for a repair.
        duration_s: the step's duration (s).
        grips: the hands that hold cloth in it.
        needs_all: whether it ends at once, hands open and nothing moved, where one of them finds no cloth; if not, the
            others go on.
        base: where the base stands after it has driven in the step; None if it does not drive to another station.
        ends: where the robot stands after the step, and how; None where nobody has said.
    """

    step: int
    kind: str
    duration_s: float
    grips: tuple[GripMotion, ...] = ()
    needs_all: bool = False
    base: Pose2 | None = None
    ends: Posture | None = None

    def with_grips(self, moved: Callable[[GripMotion], GripMotion], arms: Container[str] | None = None) -> "StepMotion":
        """Return the same step with other motions of the hands of these arms; None: of all."""
        grips = (moved(grip) if arms is None or grip.arm in arms else grip for grip in self.grips)
        return replace(self, grips=tuple(grips))

    @property
    def is_drag(self) -> bool:
        """Whether the garment as a whole is moved over the table."""
        return step_kind(self.kind).moves == "cloth"

    @property
    def is_fold(self) -> bool:
        """Whether a part of the garment is turned over."""
        return step_kind(self.kind).moves == "part"

    @property
    def is_pulled(self) -> bool:
        """Whether the garment follows the base as it drives."""
        return step_kind(self.kind).is_pulled


@dataclass(frozen=True, slots=True)
class Performed:
    """The robot's report on a step.

    Attributes:
        has_cloth: for each hand that closed or held on, whether there was cloth between its fingers; a gripper tells by
            its opening.
    """

    has_cloth: Mapping[str, bool] = field(default_factory=dict)

    @property
    def missing(self) -> frozenset[str]:
        """The hands that should hold cloth and do not."""
        return frozenset(arm for arm, has in self.has_cloth.items() if not has)


@dataclass(frozen=True, slots=True, eq=False)
class Observation:
    """The sensor data of one moment.

    Attributes:
        image: red, green and blue, shape (height, width, 3); None where the world has no camera.
        camera: the camera that took the image, where the robot believes it to be.
        outline: points on the cloth's outline seen from above, table frame, shape (n, 2), m, of a world that finds the
            cloth in its pictures itself; None where only an image tells.
    """

    image: NDArray[np.uint8] | None = None
    camera: Camera | None = None
    outline: FloatArray | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Truth:
    """The true position of every piece of the cloth; only for judging.

    Attributes:
        pattern: points of the cloth in the pattern's frame, shape (n, 2), m.
        positions: where they are, table frame, shape (n, 3), m.
        triangles: the triangles between them, shape (m, 3).
        held: how many of them each hand holds.
    """

    pattern: FloatArray
    positions: FloatArray
    triangles: NDArray[np.int64]
    held: Mapping[str, int] = field(default_factory=dict)


class World(Protocol):
    """A table with cloth on it, and a robot beside it."""

    def observe(self) -> Observation:
        """Return what is seen now."""

    def perform(self, motion: StepMotion) -> Performed:
        """Perform one step, and return what the robot says it did."""

    def truth(self) -> Truth | None:
        """Return where the cloth really is, for judging alone; None where nobody knows."""
