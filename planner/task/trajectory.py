"""The trajectory of a plan: keyframes of every joint, the base and the cloth, each with its velocity.

Between two keyframes everything moves on a cubic, so that velocities are continuous. Plans from before velocities were
kept have none: there everything goes straight from keyframe to keyframe. The trajectory describes the motion
completely: 3D view, exports, simulation and checks read nothing else.
"""

import math
from bisect import bisect_right
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Annotated, Any

import numpy as np
from pydantic import PlainSerializer, PlainValidator, WithJsonSchema

from planner.geometry.keyframes import acceleration_at, rate_at, value_at
from planner.geometry.pose import Approach, FloatArray, Point3, Pose2, wrapped_angle
from planner.geometry.table import TableTop
from planner.json_form import STRICT


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
        start: the garment's placement at the start of the phase (garment frame in table frame).
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
    """A stretch of time in which everything moves evenly; a primitive is cut into phases.

    The base goes straight from one pose to another or turns in place, each hand is free or follows points at an even
    pace in one orientation, and the cloth is carried along, folded a part of the way, or lies still. Playback turns
    phases into cloth surfaces without knowing which primitive they came from.

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


@dataclass(frozen=True)
class Segment:
    """A phase with its times.

    Attributes:
        step: the index of the plan's step to which it belongs.
        start_s: the time of its start (s).
        phase: the motion of base, hands and cloth.
        times_s: the time since its start, rising from 0 to its duration (s).
        fractions: the fraction of the phase that is done at each of these times, 0 to 1.
        rates: its change for the cloth at each (1/s); empty: it goes straight from time to time.
        base_rates: its change for the base, alike: cloth and base keep their own velocities from phase to phase.
    """

    step: int
    start_s: float
    phase: Phase
    times_s: tuple[float, ...]
    fractions: tuple[float, ...]
    rates: tuple[float, ...] = ()
    base_rates: tuple[float, ...] = ()

    @property
    def duration_s(self) -> float:
        """Its duration (s)."""
        return self.times_s[-1]

    def fraction_at(self, t_s: float) -> float:
        """Return the fraction of the phase that is done at a time of the plan (s): what its cloth does."""
        return float(value_at(self.times_s, self.fractions, self.rates, t_s - self.start_s))

    def base_at(self, t_s: float) -> Pose2:
        """Return the base's pose at a time of the plan (s), table frame."""
        fraction = float(value_at(self.times_s, self.fractions, self.base_rates, t_s - self.start_s))
        return self.phase.base[0].between(self.phase.base[1], fraction)

    def base_velocity_at(self, t_s: float) -> FloatArray:
        """Return the base's velocity at a time of the plan: x, y (m/s) and yaw (rad/s), table frame, shape (3,)."""
        return float(rate_at(self.times_s, self.fractions, self.base_rates, t_s - self.start_s)) * self._base_way

    def base_acceleration_at(self, t_s: float) -> FloatArray:
        """Return the base's acceleration at a time of the plan: x, y (m/s2), yaw (rad/s2), table frame, shape (3,)."""
        found = acceleration_at(self.times_s, self.fractions, self.base_rates, t_s - self.start_s)
        return float(found) * self._base_way

    @property
    def _base_way(self) -> FloatArray:
        start, end = self.phase.base
        return np.array([end.x_m - start.x_m, end.y_m - start.y_m, wrapped_angle(end.yaw_rad - start.yaw_rad)])

    def placement_at(self, t_s: float) -> Pose2:
        """Return the garment's placement at a time of the plan (s)."""
        cloth = self.phase.cloth
        return cloth.start.between(cloth.end, self.fraction_at(t_s))


@dataclass(frozen=True)
class ArmTrack:
    """Keyframes of all arms' joints.

    Attributes:
        names: the joints' URDF names, arm by arm.
        times_s: the times of the keyframes, rising (s).
        positions: the joints at each (rad; m for prismatic ones), one row for each keyframe.
        velocities: their velocities, alike (rad/s, m/s); empty: they go straight from keyframe to keyframe.
    """

    names: tuple[str, ...]
    times_s: tuple[float, ...]
    positions: tuple[tuple[float, ...], ...]
    velocities: tuple[tuple[float, ...], ...] = ()

    def at(self, t_s: float) -> FloatArray:
        """Return the joints at a time (s), shape (joints,)."""
        return np.asarray(value_at(self.times_s, self.rows, self.rates, t_s))

    def velocities_at(self, t_s: float) -> FloatArray:
        """Return the joints' velocities just after a time, at the end just before it, shape (joints,), rad/s."""
        return np.asarray(rate_at(self.times_s, self.rows, self.rates, t_s))

    def accelerations_at(self, t_s: float) -> FloatArray:
        """Return the joints' accelerations just after a time, at the end just before it, shape (joints,), rad/s2."""
        return np.asarray(acceleration_at(self.times_s, self.rows, self.rates, t_s))

    def __getstate__(self) -> dict[str, Any]:
        """Return the fields without the arrays cached from them."""
        return {field.name: getattr(self, field.name) for field in fields(self)}

    @cached_property
    def rows(self) -> FloatArray:
        """The positions as an array, shape (keyframes, joints)."""
        return np.array(self.positions)

    @cached_property
    def rates(self) -> FloatArray:
        """The velocities as an array, shape (keyframes, joints), rad/s; empty without them."""
        return np.array(self.velocities)


@dataclass(frozen=True, slots=True)
class GripperTrack:
    """Keyframes of one gripper.

    Attributes:
        arm: the arm's name.
        joint: the URDF name of the joint that drives the fingers.
        times_s: the times of the keyframes, rising (s).
        openings_m: the distance between the fingers at each (m).
        positions: the joint's position at each (rad).
        opening_rates: the change of the opening at each (m/s); empty: it goes straight from keyframe to keyframe.
        velocities: the joint's velocity at each (rad/s), alike.
    """

    arm: str
    joint: str
    times_s: tuple[float, ...]
    openings_m: tuple[float, ...]
    positions: tuple[float, ...]
    opening_rates: tuple[float, ...] = ()
    velocities: tuple[float, ...] = ()

    def opening_at(self, t_s: float) -> float:
        """Return the opening at a time (m)."""
        return float(value_at(self.times_s, self.openings_m, self.opening_rates, t_s))

    def position_at(self, t_s: float) -> float:
        """Return the joint's position at a time (rad)."""
        return float(value_at(self.times_s, self.positions, self.velocities, t_s))

    def velocity_at(self, t_s: float) -> float:
        """Return the joint's velocity just after a time, at the end just before it (rad/s)."""
        return float(rate_at(self.times_s, self.positions, self.velocities, t_s))

    def acceleration_at(self, t_s: float) -> float:
        """Return the joint's acceleration just after a time, at the end just before it (rad/s2)."""
        return float(acceleration_at(self.times_s, self.positions, self.velocities, t_s))


@dataclass(frozen=True)
class Trajectory:
    """The motion of robot and cloth from 0 to the plan's end.

    Attributes:
        duration_s: the end (s).
        segments: the motions of base and cloth, one after the other.
        arms: the motions of the arms.
        grippers: the motions of the grippers, arm by arm.
        torso_m: the height of the lift throughout (m).
        resting: all other actuated joints by name (rad, m for prismatic ones), which do not move.
    """

    __pydantic_config__ = STRICT

    duration_s: float
    segments: tuple[Segment, ...]
    arms: ArmTrack
    grippers: tuple[GripperTrack, ...]
    torso_m: float
    resting: dict[str, float]

    def joints_at(self, t_s: float) -> dict[str, float]:
        """Return every actuated joint by its URDF name at a time (s)."""
        moving = zip(self.arms.names, self.arms.at(t_s).tolist(), strict=True)
        fingers = {track.joint: track.position_at(t_s) for track in self.grippers}
        return {**self.resting, **dict(moving), **fingers}

    def velocities_at(self, t_s: float) -> dict[str, float]:
        """Return the velocity of every actuated joint by its URDF name at a time (rad/s, m/s)."""
        moving = zip(self.arms.names, self.arms.velocities_at(t_s).tolist(), strict=True)
        fingers = {track.joint: track.velocity_at(t_s) for track in self.grippers}
        return {**dict.fromkeys(self.resting, 0.0), **dict(moving), **fingers}

    def index_at(self, t_s: float) -> int:
        """Return the index of the segment at a time (s)."""
        return max(0, bisect_right(self._starts_s, t_s) - 1)

    def segment_at(self, t_s: float) -> Segment:
        """Return the segment at a time (s)."""
        return self.segments[self.index_at(t_s)]

    def of_step(self, step: int) -> tuple[Segment, ...]:
        """Return the segments of one step of the plan."""
        return tuple(segment for segment in self.segments if segment.step == step)

    @cached_property
    def _starts_s(self) -> tuple[float, ...]:
        return tuple(segment.start_s for segment in self.segments)
