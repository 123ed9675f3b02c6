"""Have hands hold edges with one finger under the cloth, where that costs no time.

The search asks where hands may be, whatever they are like. Which of equally quick ways has room for a finger between
cloth and table is looked for when the search validates a path, and once more in the plan that it has found.
"""

from collections.abc import Iterator, Sequence
from functools import cached_property
from itertools import chain, islice, product, takewhile

from planner.deadline import Deadline
from planner.folds.fold_path import REST_HEIGHT_M
from planner.geometry.tolerance import TIME_S
from planner.motion.plan_segment import PlanSegment, duration_s, linked
from planner.motion.transfer import Transfer
from planner.motion.transfer_planner import TransferPlanner
from planner.primitives.context import Context
from planner.primitives.primitive import Step
from planner.robots.armed_robot import ArmedRobot

_LOOKED_AT = 120
"""Ways to do a step that are looked at for hands that may hold edges."""

_EACH = 2
"""Ways to do a step with a number of hands that may hold edges that are combined with those of the other steps."""

TRIED = 4
"""Transfers for which joint paths are sought."""


def _rolling(step: Step) -> int:
    """Return how many hands roll over with the cloth: they lay it down more exactly than those that do not."""
    return sum(hand is not None and any(hand.rolls_rad) for hand in step.extremes()[0].hands) if step.grips else 0


def _best(found: list[tuple[int, Step]]) -> list[Step]:
    """Return the first of the steps in which most hands roll, and the first of all, which is the most natural one."""
    most = max(rolling for rolling, _ in found)
    best = next(one for rolling, one in found if rolling == most)
    return [best, *(one for _, one in found if one is not best)][:_EACH]


class EdgeHands:
    """Finds segments in which more hands hold edges than in those given."""

    def __init__(self, context: Context, machine: ArmedRobot, maker: TransferPlanner) -> None:
        self._context, self._machine, self._maker = context, machine, maker
        self._known: dict[tuple[object, ...], list[Step]] = {}

    def ways(self, steps: Sequence[Step], tried: int = TRIED) -> Iterator[Transfer]:
        """Yield transfers that do as some steps do, as quick, in which hands hold edges; so many are tried."""
        first, *others = steps
        able = [self._at_edges(first), *([*self._at_edges(step), step] for step in others)]
        for way in islice(product(*able), tried):
            transfer = self._maker.made_at_edges(self._maker.candidate(way))
            if transfer is not None:
                yield transfer

    def held(self, plan_segments: Sequence[PlanSegment], deadline: Deadline) -> tuple[PlanSegment, ...]:
        """Return segments that follow one another, with more hands that hold edges where these take no longer.

        Args:
            plan_segments: the segments of a validated plan.
            deadline: polled before each segment; once it is over the segments are returned as they are by then.
        """
        ways = [self._others(plan_segment) for plan_segment in plan_segments]
        firsts = [None if deadline.is_over else next(way, None) for way in ways]
        if not any(firsts):
            return tuple(plan_segments)
        limit_s = duration_s(plan_segments) + TIME_S
        best = linked(
            [first or plan_segment for first, plan_segment in zip(firsts, plan_segments, strict=True)],
            self._maker,
            hastens=True,
        )
        if duration_s(best) <= limit_s:
            return best
        # Mostly one transit is slower for it: the segment to which hands come late does without, or with another way.
        are_late = [
            one.late_s > plan_segment.late_s + TIME_S for plan_segment, one in zip(plan_segments, best, strict=True)
        ]
        mixed = (
            plan_segment if is_late else one
            for plan_segment, one, is_late in zip(plan_segments, best, are_late, strict=True)
        )
        best = linked(tuple(mixed), self._maker, hastens=True)
        if duration_s(best) > limit_s:
            best, are_late = tuple(plan_segments), [True] * len(plan_segments)
        for number, (first, others, is_late) in enumerate(zip(firsts, ways, are_late, strict=True)):
            for other in chain([first], others) if is_late and first is not None and not deadline.is_over else ():
                tried = linked((*best[:number], other, *best[number + 1 :]), self._maker, hastens=True)
                if duration_s(tried) <= limit_s:
                    best = tried
                    break
        return best

    def _others(self, plan_segment: PlanSegment) -> Iterator[PlanSegment]:
        """Yield segments between the same states, of the same duration, in which more hands hold edges."""
        if plan_segment.transfer is None:
            return
        edges = plan_segment.transfer.edges
        if edges < int(plan_segment.transfer.transfer_path.waypoints.is_used.sum()):
            for transfer in self.ways(plan_segment.steps):
                if transfer.edges > edges:
                    yield PlanSegment(plan_segment.first, transfer.steps, transfer)

    def _at_edges(self, step: Step) -> list[Step]:
        """Return a few ways to do a step, as quick and by the same arms, whose hands may hold edges, most first.

        They are sought once.
        """
        if step.motion not in self._known:
            self._known[step.motion] = self._sought(step)
        return self._known[step.motion]

    def _sought(self, step: Step) -> list[Step]:
        alike = takewhile(lambda one: one.duration_s <= step.duration_s + TIME_S, islice(step.variants(), _LOOKED_AT))
        most = len(step.grips)
        of_count: dict[int, list[tuple[int, Step]]] = {}
        for one in alike:
            edges = self._edges(one) if one.task == step.task else 0
            if edges:
                found = of_count.setdefault(edges, [])
                found.append((_rolling(one), one))
                if edges == most and sum(rolling == most for rolling, _ in found) == _EACH:
                    break
        return [one for edges in sorted(of_count, reverse=True) for one in _best(of_count[edges])]

    def _edges(self, step: Step) -> int:
        """Return how many hands point so far down that they may hold edges."""
        return sum(approach.pitch_rad in self._pitches_rad[arm] for arm, approach in step.hands.items())

    @cached_property
    def _pitches_rad(self) -> tuple[frozenset[float], ...]:
        """For each arm the pitches at which its hand can have one finger under cloth that lies (rad)."""
        pitches = {approach.pitch_rad for approach in self._context.reach.approaches if not approach.is_vertical}
        return tuple(
            frozenset(p for p in pitches if self._machine.edge_raised_m(arm, REST_HEIGHT_M, p) is not None)
            for arm in range(len(self._machine.card.arms))
        )
