"""The motion of a fold: the hands follow the path of the cloth, and the base drives along meanwhile.

What the base drives takes the time that the cost model says, as if the hands rested meanwhile. But they need not rest:
both move at once, each the slower for it, so that the base has time to speed up and to slow down.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import accumulate, pairwise

import numpy as np

from planner.geometry.pose import Approach, FloatArray, Point3, Pose2
from planner.geometry.tolerance import ANGLE_RAD, LENGTH_M, nearest_whole
from planner.primitives.context import Context
from planner.primitives.drive_line import Corner, drive_line
from planner.primitives.fold_way import FoldWay
from planner.primitives.state import State
from planner.task.phase import ClothMotion, Hand, Phase

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
