"""A drag as a step of a plan."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import islice
from typing import Any, ClassVar

import numpy as np

from planner.geometry.driving import STANDOFFS_PER_M
from planner.geometry.pose import Approach, FloatArray, Point2, point3
from planner.geometry.table import TableTop
from planner.primitives.context import DRAGS_PER_M, Context
from planner.primitives.drag_way import DragWay, DragWays, drag_covers, dragged, hands_at, towards_robot
from planner.primitives.grasping import by_nearness, holdings
from planner.primitives.state import Held, State
from planner.task.trajectory import ClothMotion, Hand, Phase
from planner.task.world_state import Grip, Holding


@dataclass(frozen=True)
class DragStep:
    """A drag as a step of a plan.

    Attributes:
        context: the planning context.
        way: grips and arms.
        before: the state it starts in.
        after: the state it leads to.
        first_stand: the standoff at which the hands reach the grips.
        approaches: each grip's approach, where it is not the preferred one.
    """

    context: Context
    way: DragWay
    before: State
    after: State
    first_stand: int
    approaches: tuple[int, ...] | None = None
    kind: str = "drag"
    arm_motion: ClassVar[int | None] = None
    """The index of the arm motion that moves the cloth; None: the base does."""

    @property
    def distance_m(self) -> float:
        """The distance over which the garment is dragged (m)."""
        return (self.after.standoff - self.first_stand) / STANDOFFS_PER_M

    @cached_property
    def duration_s(self) -> float:
        """The time to drive, reach and drag (s)."""
        steps = abs(self.before.standoff - self.first_stand)
        return self.context.scene.arm_motion_s + self.context.drive_s(steps) + self.dragging_s

    @property
    def dragging_s(self) -> float:
        """The time from the grips to where the cloth is let go (s)."""
        return self.context.drag_s(self.after.standoff - self.first_stand)

    @property
    def towards(self) -> Point2:
        """The direction of the drag: a unit vector, garment frame."""
        return towards_robot(self.context, self.before.station)

    @cached_property
    def grips(self) -> tuple[Grip, ...]:
        """Each hand's pick and place, from the leftmost arm to the rightmost."""
        names = self.context.reach.arm_names
        ends = self._ends()
        return tuple(
            Grip(names[arm], point3(self.way.picks[i]), None, point3(ends[i]))
            for arm, i in sorted(zip(self.way.arms, range(len(ends)), strict=True))
        )

    @property
    def details(self) -> dict[str, Any]:
        """The distance, and whether the hands keep hold afterwards."""
        return {"distance_m": self.distance_m, "holds": bool(self.after.held)}

    def holdings(self) -> tuple[Holding, ...]:
        """Return what each arm holds, and which vertices Theorem 2 asks for."""
        covers = drag_covers(self.context, self.before.done, self.before.offset, self.towards)
        return holdings(self.way.taken, covers.vertices, self.context.reach.arm_names)

    def extremes(self) -> tuple[Phase, ...]:
        """Return the phase of the drag itself."""
        return self.phases[-1:]

    @property
    def hands(self) -> dict[int, Approach]:
        """The orientation in which each arm's hand takes hold, by the arm's number."""
        return {arm: self._approach(grip) for grip, arm in enumerate(self.way.arms)}

    @cached_property
    def phases(self) -> tuple[Phase, ...]:
        """The phases: drive, reach, back off with the cloth."""
        context = self.context
        begin, stand, end = (
            context.base_pose(self.before.station, b)
            for b in (self.before.standoff, self.first_stand, self.after.standoff)
        )
        start, goal = context.placed(self.before.offset), context.placed(self.after.offset)
        top = TableTop.of(context.scene.table)
        still = ClothMotion(self.before.done, start, start, top)
        carried = ClothMotion(self.before.done, start, goal, top.open_towards(self._ends()[:, :2]))
        free: tuple[Hand | None, ...] = (None,) * len(context.reach.arm_names)
        drive = context.drive_s(abs(self.before.standoff - self.first_stand))
        return (
            Phase(drive, (begin, stand), free, still),
            Phase(context.scene.arm_motion_s, (stand, stand), self._hands(is_reaching=True), still),
            Phase(self.dragging_s, (stand, end), self._hands(is_reaching=False), carried, self.arm_motion),
        )

    def variants(self) -> Iterator["DragStep"]:
        """Yield this step, then the drag with every other choice of approaches, the best first."""
        yield self
        chosen = tuple(self.way.approaches[self.first_stand].tolist())
        for approaches in _best_first(self._able()):
            if approaches != chosen:
                yield replace(self, approaches=approaches)

    @property
    def turns(self) -> Mapping[int, int]:
        """The number of each arm's approach."""
        return dict(zip(self.way.arms, self._chosen, strict=True))

    def turned(self, turns: Mapping[int, int]) -> Iterator["DragStep"]:
        """Yield the drag with the hands in given approaches, if they can be and are not."""
        approaches = tuple(turns.get(arm, -1) for arm in self.way.arms)
        is_able = all(turn in able for turn, able in zip(approaches, self._able(), strict=True))
        if is_able and approaches != self._chosen:
            yield replace(self, approaches=approaches)

    def _able(self) -> list[list[int]]:
        """Return the approaches in which each hand can drag, the best first."""
        able = []
        for grip, arm, pick in zip(self.way.grips, self.way.arms, self.way.picks, strict=True):
            allowed, is_able = hands_at(self.context, self.before, grip, arm, pick, self.way.move)
            able.append([int(a) for a in allowed[is_able[:, self.first_stand]]])
        return able

    @cached_property
    def motion(self) -> tuple[object, ...]:
        """The key that identifies it: both states, the hands, and the standoff at which it begins."""
        return (self.kind, self.before, self.after, self.first_stand, self.way.tracks, self._chosen)

    @cached_property
    def situation(self) -> tuple[object, ...]:
        """The key it shares with drags in which the hands move alike and the base stands elsewhere."""
        length = self.after.standoff - self.first_stand
        return (self.kind, length, bool(self.after.held), self.before.station, self.before.place, self.way.hands)

    @property
    def task(self) -> tuple[object, ...]:
        """The key it shares with other drags of the same cloth from the same station by the same arms."""
        return (self.kind, self.before.done, self.before.station, frozenset(self.way.arms))

    def begun_in(self, state: State) -> "DragStep":
        """Return the drag begun in another state of the same situation."""
        return replace(self, before=state, after=replace(self.after, done=state.done))

    def elsewhere(self, count: int) -> Iterator["DragStep"]:
        """Yield up to about `count` other ways to drag the same grips as far, begun at other standoffs.

        For each standoff several choices of approaches follow one another, the best first, because the arms cannot
        always carry out the preferred one.
        """
        length = self.after.standoff - self.first_stand
        stands = [s for s in self.way.stands if s != self.first_stand and s + length < self.context.standoffs]
        for stand in stands[:: max(1, len(stands) // count)]:
            after = replace(self.after, standoff=stand + length)
            there = replace(self, after=after, first_stand=stand, approaches=None)
            yield from islice(there.variants(), max(1, count // len(stands)))

    def again(self, context: Context, state: State) -> Iterator["DragStep"]:
        """Yield drags by the same hands, as far, from the same standoff, each hand at the grip nearest to its old one.

        Drags from other standoffs follow, the nearest first; then drags by other hands.
        """
        steps = self.after.standoff - self.first_stand
        count = steps * DRAGS_PER_M // STANDOFFS_PER_M
        offset = dragged(context, state.offset, state.station, count)
        if not context.stays(state.done, offset):
            return
        for way in by_nearness(self.way, context.kept(DragWays).of(state)):
            held = tuple(sorted(map(Held, way.arms, way.grips), key=lambda h: h.arm)) if self.after.held else ()
            for stand in sorted(way.stands, key=lambda stand: abs(stand - self.first_stand)):
                if stand + steps < context.standoffs:
                    after = State(state.done, offset, state.station, stand + steps, held, count if held else 0)
                    yield from self._turned_alike(DragStep(context, way, state, after, stand))

    def _turned_alike(self, other: "DragStep") -> Iterator["DragStep"]:
        """Yield another drag, first with its hands turned as here if they can be and it prefers another turn."""
        if other.first_stand == self.first_stand:
            yield from other.turned(self.turns)
        yield other

    def _hands(self, *, is_reaching: bool) -> tuple[Hand | None, ...]:
        hands: list[Hand | None] = [None] * len(self.context.reach.arm_names)
        ends = self._ends()
        for i, arm in enumerate(self.way.arms):
            pick, place = point3(self.way.picks[i]), point3(ends[i])
            points = (pick,) if is_reaching else (pick, place)
            hands[arm] = Hand(self._approach(i), points, not is_reaching, is_reaching)
        return tuple(hands)

    def _approach(self, grip: int) -> Approach:
        return self.context.reach.approaches[self._chosen[grip]]

    @property
    def _chosen(self) -> tuple[int, ...]:
        """Each grip's approach."""
        return self.approaches or tuple(self.way.approaches[self.first_stand].tolist())

    def _ends(self) -> FloatArray:
        dx = self.after.offset[0] - self.before.offset[0]
        dy = self.after.offset[1] - self.before.offset[1]
        return np.asarray(self.way.picks + np.array([dx, dy, 0.0]))


def _best_first(able: Sequence[Sequence[int]]) -> Iterator[tuple[int, ...]]:
    """Yield the combinations of one approach for each hand by rising sum of their ranks; mostly a few are enough.

    Those of one sum come in the order of their ranks.
    """
    for total in range(sum(len(approaches) - 1 for approaches in able) + 1):
        yield from _of_rank(able, total)


def _of_rank(able: Sequence[Sequence[int]], total: int) -> Iterator[tuple[int, ...]]:
    """Yield the combinations whose ranks add up to `total`, in the order of their ranks."""
    first, *others = able
    most = sum(len(approaches) - 1 for approaches in others)
    ranks = range(max(0, total - most), min(len(first) - 1, total) + 1)
    if not others:
        yield from ((first[rank],) for rank in ranks)
        return
    for rank in ranks:
        yield from ((first[rank], *rest) for rest in _of_rank(others, total - rank))
