"""Time a transfer: the time of every waypoint, and the rests in which fingers open.

Fingers close and open while everything rests, and cloth is released only once it lies. A rest is part of the arm motion
before it, which becomes that much quicker; if there is none before it, as in a drag, the rest is part of the reach. All
rests between two steps too, so that each can be performed alone.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.geometry.tolerance import LENGTH_M
from planner.motion.pacing import needed_s, paced_s
from planner.motion.path_timing import UNBOUNDED, PathTiming, timed
from planner.motion.timed_phase import TimedPhase
from planner.motion.waypoints import Waypoints
from planner.primitives.drive_time import DriveTime
from planner.robots.card import JointLayout
from planner.task.trajectory import Phase

Carrying = Sequence[tuple[int, Phase]]
"""The phases of a transfer in which cloth is held, each with its primitive's number."""

_BASE, _CLOTH = slice(-4, -1), -1
"""The columns of what moves: before them come the joints."""


@dataclass(frozen=True, slots=True)
class TransferLimits:
    """The speeds and accelerations that a transfer keeps.

    Attributes:
        speeds: the top speeds of the joints, then of the base ahead, aside and turning, shape (joints + 3,).
        accelerations: their top accelerations, alike.
        rest_s: the time that fingers take to open (s).
    """

    speeds: FloatArray
    accelerations: FloatArray
    rest_s: float

    @staticmethod
    def of(layout: JointLayout, time: DriveTime, rest_s: float) -> "TransferLimits":
        """Return the limits of arms and of a base, and the time that fingers take (s)."""
        base = (time.speed_m_s, time.speed_m_s, time.turn_rad_s)
        hard = (time.acceleration_m_s2, time.acceleration_m_s2, time.turn_acceleration_rad_s2)
        return TransferLimits(np.append(layout.speeds_rad_s, base), np.append(layout.accelerations, hard), rest_s)


@dataclass(frozen=True, slots=True, eq=False)
class TransferTiming:
    """The timing of a transfer.

    Attributes:
        times_s: times since the first grip, rising (s), shape (n,).
        waypoints: the waypoint at each time, shape (n,); one after which a hand lets go appears twice, with a rest in
            between.
        velocities: the joints' velocities at each time, shape (n, joints), rad/s.
        timed_phases: the timed phases; their primitives are counted within the transfer.
        borrowed_s: the rests that are part of the reach before (s).
    """

    times_s: FloatArray
    waypoints: NDArray[np.int64]
    velocities: FloatArray
    timed_phases: tuple[TimedPhase, ...]
    borrowed_s: float

    @staticmethod
    def of(carrying: Carrying, waypoints: Waypoints, joints: FloatArray, limits: TransferLimits) -> "TransferTiming":
        """Return the evenest timing of the least duration.

        Args:
            carrying: the phases.
            waypoints: their waypoints.
            joints: the arms' joints at each waypoint, shape (waypoints, joints), rad.
            limits: what the motion keeps.
        """
        is_last = np.asarray(waypoints.is_last_held.any(axis=0))
        rests, borrowed_s = _rests(carrying, waypoints, is_last, limits.rest_s)
        way = np.column_stack([joints, _base_way(waypoints.bases), _cloth_way(carrying, waypoints)])
        steps = np.append(0.0, _paced(carrying, waypoints, needed_s(way[:, :_CLOTH], limits.speeds), rests))
        primitives = np.array([primitive for primitive, _ in carrying])[waypoints.phases]
        is_rest = is_last | np.append(primitives[1:] != primitives[:-1], True)
        is_rest[0] = True
        planned_s = np.bincount(primitives, steps).astype(float)
        most = np.append(limits.speeds, UNBOUNDED), np.append(limits.accelerations, UNBOUNDED)
        path = timed(np.cumsum(steps), way, is_rest, primitives, planned_s, most)
        rows = np.repeat(np.arange(len(waypoints)), 1 + is_last)
        is_second = np.append(False, rows[1:] == rows[:-1])
        gaps = np.diff(path.times_s, prepend=0.0)[rows]
        times = np.cumsum(np.where(is_second, limits.rest_s, gaps))
        timed_phases = tuple(_cues(carrying, waypoints, rows, times, path))
        return TransferTiming(times, rows, path.velocities[rows, : joints.shape[1]], timed_phases, borrowed_s)

    def first_s(self, waypoint: int) -> float:
        """Return when a waypoint is reached (s)."""
        return float(self.times_s[np.searchsorted(self.waypoints, waypoint)])


def _rests(
    carrying: Carrying, waypoints: Waypoints, is_last: BoolArray, rest_s: float
) -> tuple[dict[tuple[int, int | None], float], float]:
    """Return the rests within each arm motion (s), and the rests before which there is no arm motion (s)."""
    rests: dict[tuple[int, int | None], float] = {}
    borrowed_s = 0.0
    for number in waypoints.phases[is_last].tolist():
        of_primitive = [motion for motion in _motions(carrying[: number + 1]) if motion[0] == carrying[number][0]]
        if of_primitive:
            rests[of_primitive[-1]] = rests.get(of_primitive[-1], 0.0) + rest_s
        else:
            borrowed_s += rest_s
    return rests, borrowed_s


def _motions(carrying: Carrying) -> list[tuple[int, int | None]]:
    """Return the arm motions of some phases, each with its primitive's number."""
    return [*dict.fromkeys((primitive, phase.motion) for primitive, phase in carrying if phase.motion is not None)]


def _paced(
    carrying: Carrying, waypoints: Waypoints, least_s: FloatArray, rests: dict[tuple[int, int | None], float]
) -> FloatArray:
    """Return the duration of each step from waypoint to waypoint (s), as speeds alone allow, shape (waypoints - 1,).

    The phases of one arm motion share its time, less its rests; a drive keeps its nominal speed, even in parts.
    """
    phases, nominal = waypoints.phases[1:], waypoints.nominal_s[1:]
    found = np.maximum(least_s, nominal)
    for motion in _motions(carrying):
        of_motion = [i for i, (primitive, phase) in enumerate(carrying) if (primitive, phase.motion) == motion]
        rows = np.flatnonzero(np.isin(phases, of_motion))
        found[rows] = paced_s(nominal[rows], least_s[rows], rests.get(motion, 0.0))
    return found


def _base_way(bases: FloatArray) -> FloatArray:
    """Return how far the base is ahead, aside (m) and turned (rad) from where it begins, shape (waypoints, 3)."""
    x, y, turned = (bases - bases[0]).T
    cos, sin = np.cos(bases[0, 2]), np.sin(bases[0, 2])
    return np.column_stack([cos * x + sin * y, cos * y - sin * x, turned])


def _cloth_way(carrying: Carrying, waypoints: Waypoints) -> FloatArray:
    """Return how far the cloth has moved: sweeps of folds and distances of drags (m), shape (waypoints,)."""
    ways = np.array([phase.cloth.way for _, phase in carrying])
    gone = np.append(0.0, np.cumsum(ways)[:-1])
    return np.asarray(gone[waypoints.phases] + waypoints.fractions * ways[waypoints.phases])


def _cues(
    carrying: Carrying, waypoints: Waypoints, rows: NDArray[np.int64], times: FloatArray, path: PathTiming
) -> Iterator[TimedPhase]:
    start, before, phases, fractions = 0.0, 0, waypoints.phases[rows], waypoints.fractions[rows]
    base, cloth = _base_way(waypoints.bases), _cloth_way(carrying, waypoints)
    for number, (primitive, phase) in enumerate(carrying):
        own = np.flatnonzero((phases == number) & (times > start))
        if len(own) == 0:
            # In a motion slower than its estimate, a phase through which the hands rest takes no time at all.
            yield TimedPhase.even(primitive, phase, 0.0)
            continue
        begin, end, at = rows[before], rows[own[-1]], np.append(rows[before], rows[own])
        yield TimedPhase(
            primitive,
            phase,
            np.append(start, times[own]) - start,
            np.append(0.0, fractions[own]),
            _rates(path.velocities[at, _CLOTH:], cloth[[end]] - cloth[begin]),
            _rates(path.velocities[at, _BASE], base[end] - base[begin]),
        )
        start, before = float(times[own[-1]]), int(own[-1])


def _rates(velocities: FloatArray, way: FloatArray) -> FloatArray:
    """Return the fraction of a way done in a second with velocities along it, shape (n, k) and (k,) -> (n,)."""
    square = float(way @ way)
    return np.asarray(velocities @ way / square) if square > LENGTH_M**2 else np.zeros(len(velocities))
