"""The g-drag: the base backs off with the arms still and the cloth comes along (paper, section 6)."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property, partial
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from planner.folds.fold_path import REST_HEIGHT_M
from planner.geometry.driving import IMPOSSIBLE
from planner.geometry.pose import Approach, FloatArray, Point2, Point3, Pose2
from planner.geometry.table_top import TableTop
from planner.geometry.tolerance import LENGTH_M
from planner.primitives.base_legs import unbeaten
from planner.primitives.drag_grips import (
    DRAGS_PER_M,
    drag_covers,
    dragged,
    hangs_ahead,
    longest_drag,
    towards_robot,
)
from planner.primitives.fold_trial import held_covers
from planner.primitives.grasping import (
    GRIPS_APART_M,
    approaches_from_outside,
    assignments,
    nearest_pair_m,
)
from planner.primitives.grip import Grip
from planner.primitives.phase import ClothMotion, Hand, Phase
from planner.primitives.primitive import InTime, Later
from planner.primitives.state import Held, State
from planner.primitives.work import BACK_OFF_STEP_M, BACK_OFFS_PER_M, Work

_STEPS_PER_DRAG = BACK_OFFS_PER_M // DRAGS_PER_M


@dataclass(frozen=True, eq=False)
class DragWay:
    """One choice of arms for the grips of a drag.

    Attributes:
        arms: the arm that holds each grip.
        grips: what is held, article frame (m).
        picks: the same as tool points in the table frame, shape (grips, 3), m.
        approaches: for each back-off each arm's approach, shape (back-offs, grips); -1 where out of reach.
    """

    arms: tuple[int, ...]
    grips: tuple[Point2, ...]
    picks: FloatArray
    approaches: NDArray[np.int64]

    @cached_property
    def hands(self) -> tuple[object, ...]:
        """What tells it from other ways: arms, picks and approaches."""
        return (self.arms, np.round(self.picks / LENGTH_M).tobytes(), self.approaches.tobytes())

    @cached_property
    def stands(self) -> list[int]:
        """The back-offs from which all grips are in reach."""
        return [int(b) for b in np.flatnonzero((self.approaches >= 0).all(axis=1))]


@dataclass(frozen=True)
class DragStep:
    """One drag as it is performed.

    Attributes:
        work: the problem.
        way: grips and arms.
        before: the state it starts in.
        after: the state it leads to.
        first_stand: back-off at which the grips are reached.
        approaches: each grip's approach, where that is not the one preferred.
    """

    work: Work
    way: DragWay
    before: State
    after: State
    first_stand: int
    approaches: tuple[int, ...] | None = None
    kind: str = "drag"

    @property
    def distance_m(self) -> float:
        """How far the article goes (m)."""
        return (self.after.back_off - self.first_stand) / BACK_OFFS_PER_M

    @property
    def duration_s(self) -> float:
        """The drive, the reach and the drag (s)."""
        steps = abs(self.before.back_off - self.first_stand) + self.after.back_off - self.first_stand
        return self.work.scene.arm_motion_s + self.work.drive_s(steps)

    @property
    def grips(self) -> tuple[Grip, ...]:
        """Each hand's pick and place, from the leftmost arm to the rightmost."""
        names = self.work.reach.arm_names
        ends = self._ends()
        found = [
            (arm, Grip(names[arm], _point(self.way.picks[i]), None, _point(ends[i])))
            for i, arm in enumerate(self.way.arms)
        ]
        return tuple(grip for _, grip in sorted(found, key=lambda pair: pair[0]))

    @property
    def details(self) -> dict[str, Any]:
        """How far, and whether the hands keep hold afterwards."""
        return {"distance_m": self.distance_m, "holds": bool(self.after.held)}

    @property
    def summary(self) -> str:
        """How far."""
        return f"{self.distance_m:.1f} m" + (", hold on" if self.after.held else "")

    def phases(self) -> tuple[Phase, ...]:
        """Drive, reach, back off with the cloth."""
        return self._phases

    @cached_property
    def _phases(self) -> tuple[Phase, ...]:
        work = self.work
        begin, stand, end = (
            work.base_pose(self.before.station, b)
            for b in (self.before.back_off, self.first_stand, self.after.back_off)
        )
        start, goal = work.placed(self.before.offset), work.placed(self.after.offset)
        top = TableTop.of(work.scene.table)
        still = ClothMotion(self.before.done, start, start, top)
        carried = ClothMotion(self.before.done, start, goal, top.open_towards(self._ends()[:, :2]))
        free: tuple[Hand | None, ...] = (None,) * len(work.reach.arm_names)
        drive = work.drive_s(abs(self.before.back_off - self.first_stand))
        drag = work.drive_s(self.after.back_off - self.first_stand)
        return (
            Phase(drive, (begin, stand), free, still),
            Phase(work.scene.arm_motion_s, (stand, stand), self._hands(is_reaching=True), still),
            Phase(drag, (stand, end), self._hands(is_reaching=False), carried),
        )

    def variants(self) -> Iterator["DragStep"]:
        """The same in every other choice of approaches; the best ones first."""
        yield self
        work, way = self.work, self.way
        turn = work.placed(self.before.offset).yaw_rad - work.station_pose(self.before.station).yaw_rad
        chosen = tuple(int(approach) for approach in way.approaches[self.first_stand])
        able = []
        for grip, arm, pick in zip(way.grips, way.arms, way.picks, strict=True):
            allowed = approaches_from_outside(work, self.before.done, turn, grip)
            point = work.in_base(self.before.station, pick[None])
            masks = work.reach.back_offs(arm, point, allowed, work.back_offs, BACK_OFF_STEP_M)
            able.append([int(a) for a in allowed[(masks[:, 0] >> np.uint32(self.first_stand) & 1) > 0]])
        for choice in sorted(product(*(enumerate(a) for a in able)), key=lambda c: sum(rank for rank, _ in c)):
            approaches = tuple(approach for _, approach in choice)
            if approaches != chosen:
                yield replace(self, approaches=approaches)

    @cached_property
    def situation(self) -> tuple[object, ...]:
        """What it has in common with the same motions of the hands while the base stands elsewhere."""
        length = self.after.back_off - self.first_stand
        return (self.kind, length, bool(self.after.held), self.before.station, self.before.place, self.way.hands)

    def begun_in(self, state: State) -> "DragStep":
        """The same from another state of the same situation."""
        return replace(self, before=state, after=replace(self.after, done=state.done))

    def elsewhere(self, count: int) -> Iterator["DragStep"]:
        """So many other ways to drag the same grips as far from the same state, the base starting elsewhere."""
        stands = [stand for stand in self.way.stands if stand != self.first_stand]
        length = self.after.back_off - self.first_stand
        for stand in stands[:: max(1, len(stands) // count)]:
            if stand + length < self.work.back_offs:
                yield replace(
                    self,
                    after=replace(self.after, back_off=stand + length),
                    first_stand=stand,
                    approaches=None,
                )

    def _hands(self, *, is_reaching: bool) -> tuple[Hand | None, ...]:
        hands: list[Hand | None] = [None] * len(self.work.reach.arm_names)
        ends = self._ends()
        for i, arm in enumerate(self.way.arms):
            pick, place = _point(self.way.picks[i]), _point(ends[i])
            points = (pick,) if is_reaching else (pick, place)
            hands[arm] = Hand(self._approach(i), points, not is_reaching, is_reaching)
        return tuple(hands)

    def _approach(self, grip: int) -> Approach:
        chosen = self.way.approaches[self.first_stand] if self.approaches is None else self.approaches
        return self.work.reach.approaches[int(chosen[grip])]

    def _ends(self) -> FloatArray:
        dx = self.after.offset[0] - self.before.offset[0]
        dy = self.after.offset[1] - self.before.offset[1]
        return np.asarray(self.way.picks + np.array([dx, dy, 0.0]))


class GDrag:
    """Drags the article towards the robot, in steps of 10 cm."""

    def __init__(self, work: Work) -> None:
        self._work = work
        self._found: dict[tuple[object, ...], tuple[DragWay, ...]] = {}
        self._useful: dict[tuple[object, ...], bool] = {}
        self._longest = longest_drag(work)

    def successors(self, state: State) -> Iterable[DragStep]:
        """Drags of every distance, letting go afterwards or, where a fold can use the grips, holding on."""
        if state.held:
            return InTime(())
        held = State(state.done, state.offset, state.station, 0, is_dragged=True)
        return InTime((*self._later(state, 1, state), *self._later(state, 1, held)))

    def by(self, state: State, count: int) -> Iterator[DragStep]:
        """Drags of one distance, so many steps of the grid."""
        ways = () if state.held else self._ways(state)
        offset = dragged(self._work, state.offset, state.station, count)
        if ways and self._work.unrest(state.done, offset) is None:
            yield from self._letting_go(state, ways, count, offset)
            for way in ways:
                yield from self._holding(state, way, count, offset)

    def _later(self, state: State, count: int, towards: State) -> Iterator[Later[DragStep]]:
        """Drags of at least so many steps of the grid, in their time; the hands hold on if they do `towards`."""
        if count <= self._longest:
            duration = self._work.scene.arm_motion_s + self._work.drive_s(count * _STEPS_PER_DRAG)
            yield Later(duration, towards, partial(self._steps, state, count, towards))

    def _steps(self, state: State, count: int, towards: State) -> Iterator[DragStep | Later[DragStep]]:
        """Drags by so many steps of the grid, and in their time by more."""
        ways = self._ways(state)
        if not ways:
            return
        offset = dragged(self._work, state.offset, state.station, count)
        if self._work.unrest(state.done, offset) is None:
            if towards.is_dragged:
                for way in ways:
                    yield from self._holding(state, way, count, offset)
            else:
                yield from self._letting_go(state, ways, count, offset)
        yield from self._later(state, count + 1, towards)

    def _serves(self, done: int, fold: int, held: tuple[Held, ...]) -> bool:
        """Whether a fold can be done with grips held from a drag."""
        key = (done, fold, tuple(h.key for h in held))
        if key not in self._useful:
            self._useful[key] = bool(held_covers(self._work, done, fold, held))
        return self._useful[key]

    def _ways(self, state: State) -> tuple[DragWay, ...]:
        _, x, y, station, *_ = state.key
        key = (state.done, x, y, station)
        if key not in self._found:
            self._found[key] = tuple(w for w in self._search(state) if w.stands)
        return self._found[key]

    def _search(self, state: State) -> Iterator[DragWay]:
        work = self._work
        placement = work.placed(state.offset)
        towards = towards_robot(work, state.station)
        if hangs_ahead(work, state.done, state.offset, towards):
            return
        for cover in drag_covers(work, state.done, state.offset, towards).covers:
            points = placement.to_outer(np.array(cover).reshape(-1, 2))
            if cover and nearest_pair_m(points) >= GRIPS_APART_M - LENGTH_M:
                for arms in assignments(work, state.station, points):
                    yield self._way(state, cover, arms, points, placement)

    def _way(
        self, state: State, cover: tuple[Point2, ...], arms: tuple[int, ...], points: FloatArray, placement: Pose2
    ) -> DragWay:
        work = self._work
        picks = np.column_stack([points, np.full(len(points), REST_HEIGHT_M)])
        turn = placement.yaw_rad - work.station_pose(state.station).yaw_rad
        chosen = np.full((work.back_offs, len(cover)), -1, dtype=np.int64)
        for i, (grip, arm) in enumerate(zip(cover, arms, strict=True)):
            allowed = approaches_from_outside(work, state.done, turn, grip)
            point = work.in_base(state.station, picks[i : i + 1])
            masks = work.reach.back_offs(arm, point, allowed, work.back_offs, BACK_OFF_STEP_M)
            for index, mask in reversed(list(zip(allowed, masks[:, 0], strict=True))):
                stands = [b for b in range(work.back_offs) if int(mask) >> b & 1]
                chosen[stands, i] = index
        return DragWay(arms, cover, picks, chosen)

    def _letting_go(self, state: State, ways: tuple[DragWay, ...], count: int, offset: Point2) -> Iterator[DragStep]:
        """The cheapest way to each end back-off, where driving on from another end is no cheaper."""
        best: dict[int, DragWay] = {}
        for way in ways:
            for stand in way.stands:
                best.setdefault(stand, way)
        steps = np.full(self._work.back_offs, IMPOSSIBLE)
        for stand in best:
            end = stand + count * _STEPS_PER_DRAG
            if end < len(steps):
                steps[end] = abs(state.back_off - stand) + end - stand
        for end in unbeaten(steps):
            stand = end - count * _STEPS_PER_DRAG
            after = State(state.done, offset, state.station, end)
            yield DragStep(self._work, best[stand], state, after, stand)

    def _holding(self, state: State, way: DragWay, count: int, offset: Point2) -> Iterator[DragStep]:
        work = self._work
        held = tuple(Held(arm, grip) for arm, grip in sorted(zip(way.arms, way.grips, strict=True)))
        blue = (f for f in work.sequence.dag.available(state.done) if not work.sequence.folds[f].is_red)
        if not any(self._serves(state.done, f, held) for f in blue):
            return
        for stand in way.stands:
            end = stand + count * _STEPS_PER_DRAG
            if end < work.back_offs:
                after = State(state.done, offset, state.station, end, held, is_dragged=True)
                yield DragStep(work, way, state, after, stand)


def _point(row: FloatArray) -> Point3:
    return (float(row[0]), float(row[1]), float(row[2]))
