"""Play a plan: return its sample at any time, from the plan alone.

It needs no robot and no search, so a plan read from a file plays like one just made.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

from planner.errors import RequestError, UnsolvedPlanError
from planner.geometry.pose import Pose2
from planner.geometry.table import TableTop
from planner.geometry.tolerance import TIME_S
from planner.motion.cloth_surface import ClothMoment, ClothSurface, ClothSurfaces
from planner.task.plan import Plan
from planner.task.trajectory import Trajectory

RATE_HZ = (1.0, 200.0)
"""The lowest and the highest rate at which a plan is sampled (Hz)."""

_SINK_S = 0.4
"""The time over which cloth released beyond an edge is shown sinking (s); the model lets it hang at once."""


@dataclass(frozen=True, slots=True)
class Sample:
    """The state of robot and cloth at one time.

    Attributes:
        t_s: the time (s).
        primitive: index of the current primitive.
        base: the base in the table frame.
        torso_m: the lift (m).
        joints: every actuated joint by its URDF name (rad, m for prismatic ones).
        velocities: every actuated joint's velocity just after that time (rad/s, m/s for prismatic ones).
        grippers_m: each gripper's opening by the arm's name (m).
        placement: the garment frame in the table frame.
        cloth: the cloth.
        top: the table top over which the cloth does not hang, open where it is held out beyond an edge.
    """

    t_s: float
    primitive: int
    base: Pose2
    torso_m: float
    joints: dict[str, float]
    velocities: dict[str, float]
    grippers_m: dict[str, float]
    placement: Pose2
    cloth: ClothSurface
    top: TableTop

    def to_dict(self) -> dict[str, Any]:
        """Return the sample as JSON, without the cloth."""
        return {
            "t_s": self.t_s,
            "primitive": self.primitive,
            "base": self.base.to_dict(),
            "torso_m": self.torso_m,
            "joints": self.joints,
            "velocities": self.velocities,
            "grippers_m": self.grippers_m,
        }


@dataclass(frozen=True)
class Timeline:
    """A solved plan from 0 to its end.

    Attributes:
        plan: the plan.
        trajectory: its trajectory.
    """

    plan: Plan
    trajectory: Trajectory
    _surfaces: ClothSurfaces = field(repr=False, compare=False)

    @staticmethod
    def of(plan: Plan) -> "Timeline":
        """Return the timeline of a plan.

        Raises:
            UnsolvedPlanError: the plan has no trajectory.
        """
        if plan.trajectory is None:
            raise UnsolvedPlanError(plan.status)
        return Timeline(plan, plan.trajectory, ClothSurfaces(plan.sequence))

    @property
    def duration_s(self) -> float:
        """The plan's cost (s)."""
        return self.trajectory.duration_s

    def at(self, t_s: float) -> Sample:
        """Return the sample at a time (s); times before the start or after the end give the first or last sample."""
        path = self.trajectory
        t = min(max(t_s, 0.0), self.duration_s)
        segment = path.segment_at(t)
        return Sample(
            t,
            segment.step,
            segment.base_at(t),
            path.torso_m,
            path.joints_at(t),
            path.velocities_at(t),
            {track.arm: track.opening_at(t) for track in path.grippers},
            segment.placement_at(t),
            self._surfaces.at(self.cloth_at(t)),
            segment.phase.cloth.top,
        )

    def cloth_at(self, t_s: float) -> ClothMoment:
        """Return what the shape of the cloth depends on at a time of the plan (s)."""
        number = self.trajectory.index_at(t_s)
        segment = self.trajectory.segments[number]
        return ClothMoment.of(segment.phase.cloth, segment.fraction_at(t_s), self._droop(number, t_s))

    def base_at(self, t_s: float) -> Pose2:
        """Return the base's pose at a time, table frame: as in the sample of that time, but cheaper."""
        t = min(max(t_s, 0.0), self.duration_s)
        return self.trajectory.segment_at(t).base_at(t)

    def _droop(self, number: int, t_s: float) -> float:
        """Return how far cloth that was held out in the segment before has sunk: 1 when it hangs."""
        segments = self.trajectory.segments
        if number == 0 or segments[number - 1].phase.cloth.top == segments[number].phase.cloth.top:
            return 1.0
        return min((t_s - segments[number].start_s) / _SINK_S, 1.0)

    def samples(self, rate_hz: float) -> Iterator[Sample]:
        """Yield samples at an even rate from 0 to the end; the last one is exactly at the end.

        Raises:
            RequestError: the rate is not between 1 and 200 Hz.
        """
        if not RATE_HZ[0] <= rate_hz <= RATE_HZ[1]:
            raise RequestError("rate_hz", f"{rate_hz} is not between {RATE_HZ[0]:g} and {RATE_HZ[1]:g}")
        count = 0
        while count / rate_hz < self.duration_s - TIME_S:
            yield self.at(count / rate_hz)
            count += 1
        yield self.at(self.duration_s)
