"""The g-fold: reach the grips, lift them over the fold line, lay them down (paper, sections 6 and 7)."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from planner.geometry.isometry import Isometry
from planner.geometry.pose import Approach, FloatArray, Point3, Pose2
from planner.geometry.tolerance import ANGLE_RAD
from planner.primitives.base_legs import IMPOSSIBLE, legs
from planner.primitives.fold_way import FoldWay, FoldWays
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
    """

    work: Work
    way: FoldWay
    before: State
    after: State
    first_stand: int
    kind: str = "fold"

    @property
    def duration_s(self) -> float:
        """The arm motions and all the base's legs (s)."""
        steps = int(self.way.steps[self.first_stand, self.after.back_off])
        steps += abs(self.before.back_off - self.first_stand)
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

    def _follow(self) -> Iterator[Phase]:
        """Stretches of even motion, broken where the base drives and at the apex."""
        stands = legs(self._strip, self.first_stand, self.after.back_off, self.work.back_offs)
        at, sweep = self.first_stand, 0.0
        for waypoint, stand in zip(self.way.trial.sweeps, stands, strict=True):
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
        yield Phase(duration, (base, base), hands, self._cloth(start, end))

    def _leg(self, sweep: float, start: int, end: int) -> Phase:
        hands = self._hands([sweep], is_closed=True)
        base = (self._base(start), self._base(end))
        return Phase(self.work.drive_s(abs(end - start)), base, hands, self._cloth(sweep, sweep))

    @cached_property
    def _combination(self) -> int:
        return int(self.way.choice[self.first_stand, self.after.back_off])

    @property
    def _strip(self) -> NDArray[np.uint32]:
        return np.asarray(self.way.strips.masks[self._combination])

    def _approach(self, grip: int) -> Approach:
        return self.work.reach.approaches[int(self.way.strips.approaches[self._combination, grip])]

    def _hands(self, sweeps: list[float], *, is_closed: bool, is_reaching: bool = False) -> tuple[Hand | None, ...]:
        hands: list[Hand | None] = [None] * len(self.work.reach.arm_names)
        paths = self.way.trial.path.tool_paths(self.way.trial.points, np.array(sweeps))
        for number, arm in enumerate(self.way.trial.arms):
            points = tuple(_point(p) for p in paths[number])
            hands[arm] = Hand(self._approach(number), points, is_closed, is_reaching)
        return tuple(hands)

    def _tools(self, sweep: float) -> FloatArray:
        return self.way.trial.path.tool_points(self.way.trial.points, sweep)

    def _base(self, back_off: int) -> Pose2:
        return self.work.base_pose(self.before.station, back_off)

    def _cloth(self, start: float, end: float) -> ClothMotion:
        placement = self.work.placed(self.before.offset)
        top = self.way.trial.path.top_at(start)
        return ClothMotion(self.before.done, placement, placement, top, self.way.trial.fold, (start, end))


class GFold:
    """Performs any fold that the Fold-DAG makes available."""

    def __init__(self, work: Work) -> None:
        self._work = work
        self._ways = FoldWays(work)

    def successors(self, state: State) -> Iterable[FoldStep]:
        """One step for each available fold and each end back-off that no other beats."""
        for fold in self._work.sequence.dag.available(state.done):
            if state.is_dragged and self._work.sequence.folds[fold].is_red:
                continue
            if self._work.sequence.dag.follows_at_once(fold):
                for way in self._ways.to_every_end(state, fold):
                    yield from self._holding(state, way)
                continue
            ways = self._ways.to_unbeaten_ends(state, fold)
            if ways:
                yield from self._letting_go(state, ways)

    def _letting_go(self, state: State, ways: tuple[FoldWay, ...]) -> Iterator[FoldStep]:
        found = [(way, *way.ends(state)) for way in ways]
        totals = np.array([steps for _, steps, _ in found])
        best, which = totals.min(axis=0), totals.argmin(axis=0)
        for end in unbeaten(best):
            way, _, firsts = found[which[end]]
            yield self._step(state, way, int(firsts[end]), end, ())

    def _holding(self, state: State, way: FoldWay) -> Iterator[FoldStep]:
        steps, firsts = way.ends(state)
        line = self._work.sequence.folds[way.trial.fold].line
        over = Isometry.reflection(line)
        held = tuple(
            Held(arm, over.apply_point(grip)) for arm, grip in sorted(zip(way.trial.arms, way.trial.cover, strict=True))
        )
        for end in np.flatnonzero(steps < IMPOSSIBLE):
            yield self._step(state, way, int(firsts[end]), int(end), held)

    def _step(self, state: State, way: FoldWay, first: int, end: int, held: tuple[Held, ...]) -> FoldStep:
        after = State(state.done | 1 << way.trial.fold, state.offset, state.station, end, held)
        return FoldStep(self._work, way, state, after, first)


def unbeaten(steps: FloatArray) -> list[int]:
    """The end back-offs that cannot be had as cheaply by driving on from another end."""
    ends = np.flatnonzero(steps < IMPOSSIBLE)
    by_cost = sorted(ends, key=lambda e: (steps[e], e))
    kept: list[int] = []
    for end in by_cost:
        if all(steps[end] < steps[other] + abs(end - other) for other in kept):
            kept.append(int(end))
    return sorted(kept)


def _point(row: FloatArray) -> Point3:
    return (float(row[0]), float(row[1]), float(row[2]))
