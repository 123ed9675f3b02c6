"""A fold as it is performed in a plan: reach the grips, lift them over the fold line, lay them down."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from planner.geometry.isometry import Isometry
from planner.geometry.pose import Approach, FloatArray, Point3, Pose2
from planner.geometry.tolerance import ANGLE_RAD
from planner.primitives.base_legs import legs
from planner.primitives.fold_variants import fold_spread, fold_variants
from planner.primitives.fold_way import FoldWay
from planner.primitives.grip import Grip
from planner.primitives.phase import ClothMotion, Hand, Phase
from planner.primitives.state import Held, State
from planner.primitives.work import Work

_DENSE_SWEEP = 0.02


@dataclass(frozen=True)
class FoldStep:
    """One fold as it is performed.

    Attributes:
        work: the problem.
        way: grips, arms and paths.
        before: the state it starts in.
        after: the state it leads to.
        first_stand: back-off from which the path is begun.
        driven: how many steps of the back-off grid the base drives from there on.
    """

    work: Work
    way: FoldWay
    before: State
    after: State
    first_stand: int
    driven: int
    kind: str = "fold"

    @property
    def duration_s(self) -> float:
        """The arm motions and all the base's legs (s)."""
        steps = self.driven + abs(self.before.back_off - self.first_stand)
        motions = 2 if self.before.held else 3
        return motions * self.work.scene.arm_motion_s + self.work.drive_s(steps)

    @property
    def grips(self) -> tuple[Grip, ...]:
        """Each hand's pick, apex and place, from the leftmost arm to the rightmost."""
        picks, apexes, places = (self._tools(sweep) for sweep in (0.0, 1.0, 2.0))
        names = self.work.reach.arm_names
        found = [
            (arm, Grip(names[arm], _point(picks[i]), _point(apexes[i]), _point(places[i])))
            for i, arm in enumerate(self.way.trial.arms)
        ]
        return tuple(grip for _, grip in sorted(found, key=lambda pair: pair[0]))

    @property
    def details(self) -> dict[str, Any]:
        """Which fold, and whether the hands keep hold for a red fold that follows."""
        return {"fold": self.way.trial.fold, "holds": bool(self.after.held)}

    @property
    def summary(self) -> str:
        """The fold's name."""
        return self.work.sequence.folds[self.way.trial.fold].name

    def phases(self) -> tuple[Phase, ...]:
        """Drive, reach, and follow the path with the base's legs in between."""
        return self._phases

    @cached_property
    def _phases(self) -> tuple[Phase, ...]:
        begin = () if self.before.held else self._begin()
        return (*begin, *self._follow())

    def _begin(self) -> tuple[Phase, ...]:
        still = self._cloth(0.0, 0.0)
        start, stand = self._base(self.before.back_off), self._base(self.first_stand)
        drive = self.work.drive_s(abs(self.before.back_off - self.first_stand))
        free: tuple[Hand | None, ...] = (None,) * len(self.work.reach.arm_names)
        reach = self._hands([0.0], is_closed=False, is_reaching=True)
        return (
            Phase(drive, (start, stand), free, still),
            Phase(self.work.scene.arm_motion_s, (stand, stand), reach, still),
        )

    def variants(self) -> Iterator["FoldStep"]:
        """This, then every other way between the same states, the quickest first."""
        yield self
        fold, end = self.way.trial.fold, self.after.back_off
        for variant in fold_variants(self.work, self.before, fold, end):
            driven = variant.steps - abs(variant.first - self.before.back_off)
            yield replace(self, way=variant.way, first_stand=variant.first, driven=driven)

    @cached_property
    def situation(self) -> tuple[object, ...]:
        """What it has in common with the same motions of the hands while the base stands elsewhere.

        Which other folds are done does not matter, as long as the hands do the same.
        """
        trial = self.way.trial
        return (self.kind, trial.fold, self.before.hold, self.before.station, self.before.place, trial.hands)

    def begun_in(self, state: State) -> "FoldStep":
        """The same from another state of the same situation."""
        steps = self.driven + abs(self.first_stand - state.back_off)
        return fold_step(self.work, self.way, state, self.first_stand, self.after.back_off, steps)

    def elsewhere(self, count: int) -> Iterator["FoldStep"]:
        """So many other ways to do the same fold in the same state, the base starting and ending anywhere."""
        for variant in fold_spread(self.work, self.before, self.way.trial.fold, count):
            yield fold_step(self.work, variant.way, self.before, variant.first, variant.end, variant.steps)

    @cached_property
    def _stands(self) -> tuple[int, ...]:
        """Where the base stands when the hands leave each waypoint."""
        return legs(self._strip, self.first_stand, self.after.back_off, self.work.back_offs)

    def _follow(self) -> Iterator[Phase]:
        """Stretches of even motion, broken where the base drives and at the apex."""
        at, sweep = self.first_stand, 0.0
        for waypoint, stand in zip(self.way.trial.sweeps, self._stands, strict=True):
            is_apex = abs(waypoint - 1.0) <= ANGLE_RAD
            if stand != at or is_apex:
                yield from self._stretch(sweep, float(waypoint), at)
                sweep = float(waypoint)
            if stand != at:
                yield self._leg(sweep, at, stand)
                at = stand
        yield from self._stretch(sweep, 2.0, at)

    def _stretch(self, start: float, end: float, stand: int) -> Iterator[Phase]:
        if end <= start:
            return
        count = max(2, round((end - start) / _DENSE_SWEEP) + 1)
        hands = self._hands(list(np.linspace(start, end, count)), is_closed=True)
        base = self._base(stand)
        duration = (end - start) * self.work.scene.arm_motion_s
        yield Phase(duration, (base, base), hands, self._cloth(start, end), motion=0 if start < 1.0 else 1)

    def _leg(self, sweep: float, start: int, end: int) -> Phase:
        hands = self._hands([sweep], is_closed=True)
        base = (self._base(start), self._base(end))
        return Phase(self.work.drive_s(abs(end - start)), base, hands, self._cloth(sweep, sweep))

    @property
    def _strip(self) -> NDArray[np.uint32]:
        return self.way.strip(self.work, self.before.station)

    def _approach(self, grip: int) -> Approach:
        return self.work.reach.approaches[self.way.approaches[grip]]

    def _hands(self, sweeps: list[float], *, is_closed: bool, is_reaching: bool = False) -> tuple[Hand | None, ...]:
        hands: list[Hand | None] = [None] * len(self.work.reach.arm_names)
        paths = self.way.trial.path.tool_paths(self.way.trial.points, np.array(sweeps))
        for number, arm in enumerate(self.way.trial.arms):
            points = tuple(_point(p) for p in paths[number])
            rolls = self._rolls(number, np.array(sweeps))
            hands[arm] = Hand(self._approach(number), points, is_closed, is_reaching, rolls)
        return tuple(hands)

    def _rolls(self, number: int, sweeps: FloatArray) -> tuple[float, ...]:
        """How far a hand has rolled (rad): with the cloth by half a turn if it points along the fold line, else not.

        In between would be nearer to how the cloth turns, but fingers come down flat on the table.
        """
        path, approach = self.way.trial.path, self._approach(number)
        begin = 1.0 - float(path.line.left_distances(self.way.trial.points[number : number + 1])[0]) / path.depth_m
        turned = math.pi * np.clip((sweeps - begin) / (2.0 - 2.0 * begin), 0.0, 1.0)
        heading = approach.heading_rad + self._base(self.first_stand).yaw_rad
        along = float(np.dot(path.line.direction, (math.cos(heading), math.sin(heading))))
        return tuple(float(roll) for roll in turned * round(along * math.cos(approach.pitch_rad)))

    def _tools(self, sweep: float) -> FloatArray:
        return self.way.trial.path.tool_points(self.way.trial.points, sweep)

    def _base(self, back_off: int) -> Pose2:
        return self.work.base_pose(self.before.station, back_off)

    def _cloth(self, start: float, end: float) -> ClothMotion:
        placement = self.work.placed(self.before.offset)
        top = self.way.trial.path.top_at(start)
        return ClothMotion(self.before.done, placement, placement, top, self.way.trial.fold, (start, end))


def fold_step(work: Work, way: FoldWay, state: State, first: int, end: int, steps: int) -> FoldStep:
    """A fold done in a state, its path begun at one back-off and ended at another in so many steps of driving in all.

    Before a red fold the hands hold on.
    """
    fold = way.trial.fold
    held: tuple[Held, ...] = ()
    if work.sequence.dag.follows_at_once(fold):
        over = Isometry.reflection(work.sequence.folds[fold].line)
        held = tuple(
            Held(arm, over.apply_point(grip)) for arm, grip in sorted(zip(way.trial.arms, way.trial.cover, strict=True))
        )
    after = State(state.done | 1 << fold, state.offset, state.station, end, held)
    return FoldStep(work, way, state, after, first, steps - abs(first - state.back_off))


def _point(row: FloatArray) -> Point3:
    return (float(row[0]), float(row[1]), float(row[2]))
