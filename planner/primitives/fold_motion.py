"""The motion of a fold: the hands follow the path of the cloth, and the base drives along meanwhile.

What the base drives takes the time that the cost model says, as if the hands rested meanwhile. But they need not rest:
both move at once, each the slower for it, so that the base has time to speed up and to slow down.

The base drives as evenly as reach allows. Legs of least travel (`base_legs`) are stairs: the hands rest while the base
drives from one standoff to the next, and it stands while they go on. A base that drives them so stops at every stair.
From one waypoint to the next it may as well stand anywhere between two standoffs that both are within reach at both
waypoints. These intervals are gates; the string pulled tight through them is the line with the flattest slopes, and its
travel is the least, as that of the stairs is: a tight string makes no detour.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import Approach, FloatArray, Point3, Pose2
from planner.geometry.tolerance import ANGLE_RAD, LENGTH_M, nearest_whole
from planner.primitives.base_legs import legs, stands_beside
from planner.primitives.context import Context
from planner.primitives.fold_way import FoldWay
from planner.primitives.state import State
from planner.task.trajectory import ClothMotion, Hand, Phase

_BESIDE = 1e-9
"""How far gates at the same sweep lie apart, so that a line that drives there has a slope."""


class Corner(NamedTuple):
    """A corner of a line, or one of its ends: a sweep of the path, and the standoff there in steps of the grid."""

    sweep: float
    stand: float


class _Gate(NamedTuple):
    """The lowest and the highest standoff at which a line may pass a sweep."""

    sweep: float
    low: float
    high: float

    def slopes(self, corner: Corner) -> tuple[float, float]:
        """Return the slopes of the lines from a corner to its ends."""
        away = max(self.sweep - corner.sweep, _BESIDE)
        return (self.low - corner.stand) / away, (self.high - corner.stand) / away


def drive_line(
    strip: NDArray[np.uint32], sweeps: Sequence[float], start: int, end: int, count: int
) -> tuple[Corner, ...]:
    """Return the corners of the evenest line of least travel, its ends included.

    Args:
        strip: bit masks of the standoffs within reach, shape (waypoints,); two or more.
        sweeps: the waypoints' sweeps, rising.
        start: the standoff at the first waypoint.
        end: the standoff at the last.
        count: the number of standoffs.

    Returns:
        Between two corners sweep and standoff change evenly; at equal sweeps the base drives while the hands rest.
    """
    masks, stands = strip.tolist(), legs(strip, start, end, count)
    rooms = [stands_beside(mask & after, stand) for (mask, after), stand in zip(pairwise(masks), stands, strict=False)]
    gates = [_Gate(sweeps[0], start, start)]
    for sweep, room, after in zip(sweeps, [None, *rooms], [*rooms, None], strict=True):
        gates += _gates(sweep, [(one[0], one[-1]) for one in (room, after) if one is not None])
    gates.append(_Gate(sweeps[-1], end, end))
    return _pulled_tight(gates)


def _gates(sweep: float, rooms: list[tuple[int, int]]) -> list[_Gate]:
    """Return the gate common to the rooms before and after a waypoint, or both, if the base must drive there."""
    low, high = max(low for low, _ in rooms), min(high for _, high in rooms)
    return [_Gate(sweep, low, high)] if low <= high else [_Gate(sweep, *room) for room in rooms]


def _pulled_tight(gates: Sequence[_Gate]) -> tuple[Corner, ...]:
    """Return the corners of the string from the first gate to the last, both of them points."""
    corners = [Corner(gates[0].sweep, gates[0].low)]
    at = 0
    while at < len(gates) - 1:
        at, corner = _next_bend(gates, at, corners[-1])
        corners.append(corner)
    return tuple(_without_idle(corners))


def _next_bend(gates: Sequence[_Gate], at: int, corner: Corner) -> tuple[int, Corner]:
    """Return the gate at which the string bends next after a corner in gate `at`, and the corner there."""
    least, most = -math.inf, math.inf
    lowest = highest = at
    for number in range(at + 1, len(gates)):
        low, high = gates[number].slopes(corner)
        if low > most:
            return highest, Corner(gates[highest].sweep, gates[highest].high)
        if high < least:
            return lowest, Corner(gates[lowest].sweep, gates[lowest].low)
        if low >= least:
            least, lowest = low, number
        if high <= most:
            most, highest = high, number
    return len(gates) - 1, Corner(gates[-1].sweep, gates[-1].low)


def _without_idle(corners: Sequence[Corner]) -> list[Corner]:
    """Return corners without those at which nothing has happened since the one before."""
    kept = [corners[0]]
    for corner in corners[1:]:
        if corner.sweep - kept[-1].sweep > ANGLE_RAD or abs(corner.stand - kept[-1].stand) > ANGLE_RAD:
            kept.append(corner)
    return kept


_DENSE_SWEEP = 0.02
"""The sweep between neighbouring points of a path; a whole fold is a sweep from 0 to 2."""


@dataclass(frozen=True, slots=True)
class _Piece:
    """A part of the path during which sweep and standoff change evenly.

    Attributes:
        sweeps: the sweep at the start and at the end.
        stands: the standoff at the start and at the end, in steps of the grid.
    """

    sweeps: tuple[float, float]
    stands: tuple[float, float]

    @property
    def waypoints(self) -> FloatArray:
        """The sweeps at which its points lie."""
        start, end = self.sweeps
        return np.linspace(start, end, max(2, nearest_whole((end - start) / _DENSE_SWEEP) + 1) if end > start else 1)


@dataclass(frozen=True)
class FoldMotion:
    """The motion that performs a fold.

    Attributes:
        context: the planning context.
        way: grips, arms and paths.
        before: the state it starts in.
        first_stand: the standoff from which the path is begun.
        end: the standoff at its end.
        driven: how many steps of the grid of standoffs the base drives once the path is begun.
    """

    context: Context
    way: FoldWay
    before: State
    first_stand: int
    end: int
    driven: int

    def phases(self) -> tuple[Phase, ...]:
        """Return the phases: drive, reach, follow the path with the base's legs in between."""
        pieces = tuple(self._pieces())
        waypoints = [np.zeros(1), *(piece.waypoints for piece in pieces)]
        places = tuple(accumulate(len(sweeps) for sweeps in waypoints))[:-1]
        hands = [self._cut(number, np.concatenate(waypoints), places) for number in range(len(self.way.trial.arms))]
        begin = () if self.before.held else self._begin([of_hand[0] for of_hand in hands])
        follow = (self._phase(piece, [parts[i] for parts in hands]) for i, piece in enumerate(pieces, start=1))
        return (*begin, *follow)

    def extremes(self) -> tuple[Phase, ...]:
        """Return one phase straight from the picks to the places; only its start and end are true to the motion."""
        numbers = range(len(self.way.trial.arms))
        ends = [self._cut(number, np.array([0.0, 2.0]), ())[0] for number in numbers]
        bases = (self._base(self.first_stand), self._base(self.end))
        return (Phase(0.0, bases, self._hands(ends), self._cloth(0.0, 2.0)),)

    def _begin(self, points: "list[_Points]") -> tuple[Phase, ...]:
        still = self._cloth(0.0, 0.0)
        start, stand = self._base(self.before.standoff), self._base(self.first_stand)
        drive = self.context.drive_s(abs(self.before.standoff - self.first_stand))
        free: tuple[Hand | None, ...] = (None,) * len(self.context.reach.arm_names)
        return (
            Phase(drive, (start, stand), free, still),
            Phase(self.context.scene.arm_motion_s, (stand, stand), self._hands(points, is_reaching=True), still),
        )

    def _pieces(self) -> Iterator[_Piece]:
        """Yield the pieces of even motion, split at the apex and where the base begins to drive otherwise."""
        for start, end in pairwise(self._corners()):
            if start.sweep < 1.0 - ANGLE_RAD and end.sweep > 1.0 + ANGLE_RAD:
                share = (1.0 - start.sweep) / (end.sweep - start.sweep)
                apex = Corner(1.0, start.stand + share * (end.stand - start.stand))
                yield from (_Piece(*zip(a, b, strict=True)) for a, b in ((start, apex), (apex, end)))
            else:
                yield _Piece(*zip(start, end, strict=True))

    def _corners(self) -> tuple[Corner, ...]:
        """Return the corners of the line along which the base drives."""
        if self.driven == 0:
            return (Corner(0.0, self.first_stand), Corner(2.0, self.first_stand))
        strip = self.way.strip(self.context, self.before.station)
        # Hands nearer to the line than the rest of the cloth wait for it, and wait again once they lie.
        waiting = np.concatenate([strip[:1], strip, strip[-1:]])
        sweeps = [0.0, *self.way.trial.sweeps.tolist(), 2.0]
        return drive_line(waiting, sweeps, self.first_stand, self.end, self.context.standoffs)

    def _phase(self, piece: _Piece, points: "list[_Points]") -> Phase:
        (start, end), (stand, next_stand) = piece.sweeps, piece.stands
        base, hands, cloth = (self._base(stand), self._base(next_stand)), self._hands(points), self._cloth(start, end)
        driving_s = self.context.drive_s(abs(next_stand - stand))
        if end == start:
            return Phase(driving_s, base, hands, cloth)
        duration_s = (end - start) * self.context.scene.arm_motion_s + driving_s
        return Phase(duration_s, base, hands, cloth, motion=0 if start < 1.0 - ANGLE_RAD else 1)

    def _hands(self, points: "list[_Points]", *, is_reaching: bool = False) -> tuple[Hand | None, ...]:
        hands: list[Hand | None] = [None] * len(self.context.reach.arm_names)
        for number, (arm, part) in enumerate(zip(self.way.trial.arms, points, strict=True)):
            hands[arm] = Hand(self._approach(number), part.points, not is_reaching, is_reaching, part.rolls_rad)
        return tuple(hands)

    def _cut(self, number: int, sweeps: FloatArray, places: tuple[int, ...]) -> "list[_Points]":
        """Return a hand's points and rolls at rising sweeps, cut into parts."""
        trial = self.way.trial
        path = trial.path.tool_paths(trial.points[number : number + 1], sweeps)[0]
        points = tuple([(x, y, z) for x, y, z in path.tolist()])
        rolls = tuple(self._rolls(number, sweeps).tolist())
        ends = (0, *places, len(points))
        return [_Points(points[start:end], rolls[start:end]) for start, end in pairwise(ends)]

    def _rolls(self, number: int, sweeps: FloatArray) -> FloatArray:
        """Return the roll of a hand at each sweep (rad).

        A hand that points along the fold line rolls with the cloth by half a turn; one that points across it does not
        roll. A roll in between would follow the cloth more closely, but fingers come down flat on the table. A hand on
        the extension of the fold line stays where it is.
        """
        path, approach = self.way.trial.path, self._approach(number)
        distance = float(path.line.left_distances(self.way.trial.points[number : number + 1])[0])
        if distance <= LENGTH_M:
            return np.zeros(len(sweeps))
        begin = 1.0 - distance / path.depth_m
        turned = math.pi * np.clip((sweeps - begin) / (2.0 - 2.0 * begin), 0.0, 1.0)
        heading = approach.heading_rad + self._base(self.first_stand).yaw_rad
        along = float(np.dot(path.line.direction, (math.cos(heading), math.sin(heading))))
        return np.asarray(turned * nearest_whole(along * math.cos(approach.pitch_rad)))

    def _approach(self, grip: int) -> Approach:
        return self.context.reach.approaches[self.way.approaches[grip]]

    def _base(self, standoff: float) -> Pose2:
        return self.context.base_pose(self.before.station, standoff)

    def _cloth(self, start: float, end: float) -> ClothMotion:
        placement = self.context.placed(self.before.offset)
        top = self.way.trial.path.top_at(start)
        return ClothMotion(self.before.done, placement, placement, top, self.way.trial.fold, (start, end))


@dataclass(frozen=True, slots=True)
class _Points:
    """A hand's share of a phase.

    Attributes:
        points: its tool's points, table frame (m).
        rolls_rad: the roll at each point (rad).
    """

    points: tuple[Point3, ...]
    rolls_rad: tuple[float, ...]
