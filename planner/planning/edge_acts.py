"""The segments of a path in which hands hold edges, looked for when the path is validated.

Hands at edges come from few directions, for which there is mostly a path: then no others need be looked for.
"""

from collections.abc import Callable, Sequence
from itertools import chain, islice

from planner.geometry.tolerance import TIME_S
from planner.motion.edge_hands import EdgeHands
from planner.motion.plan_segment import PlanSegment, duration_s, is_transfer, linked, transfers_of
from planner.motion.transfer import Transfer
from planner.motion.transfer_planner import TransferPlanner
from planner.planning.sequence_costs import step_key
from planner.primitives.primitive import Step

_TRIED = 2
"""Transfers in which hands hold edges that are tried for each part of a path; more are once a plan is found."""


class EdgeActs:
    """Finds segments in which hands hold edges; those of a transfer are looked for once."""

    def __init__(
        self,
        hands: EdgeHands,
        maker: TransferPlanner,
        real: Callable[[tuple[Step, ...]], Transfer | None],
        known_s: Callable[[Step], float],
        require_time: Callable[[], None],
        show: Callable[[tuple[PlanSegment, ...]], None],
    ) -> None:
        """Keep what finds transfers.

        Args:
            hands: finds those in which hands hold edges.
            maker: plans how hands come from one to the next.
            real: finds a transfer whose hands may hold in any way.
            known_s: returns the least time that a step is known to take (s).
            require_time: called before each transfer is looked for; raises an error where there is no time.
            show: called with segments that can be performed before quicker ones are looked for.
        """
        self._hands, self._maker = hands, maker
        self._real, self._known_s, self._require_time, self._show = real, known_s, require_time, show
        self._made: dict[tuple[object, ...], Transfer | None] = {}

    def transfer(self, steps: Sequence[Step]) -> Transfer | None:
        """Return a transfer that does as some steps do and in which hands hold edges; None if none is soon found."""
        key = tuple(step_key(step) for step in steps)
        if key not in self._made:
            self._require_time()
            self._made[key] = next(self._hands.ways(steps, _TRIED), None)
        return self._made[key]

    def plan_segments(self, steps: Sequence[Step]) -> tuple[PlanSegment, ...] | None:
        """Return the segments of a path, with hands at edges where these are not late; None without any, or a path.

        Where such a segment takes longer than is known of its steps, others are tried in its place. A part that has no
        transfer ends the look at once: the path will be rejected, and what its other parts could hold is of no use.
        """
        parts = list(transfers_of(steps))
        held: list[Transfer | None] = []
        for _, part in parts:
            held.append(self.transfer(part) if is_transfer(part) else None)
            if held[-1] is None and is_transfer(part) and self._real(part) is None:
                return None
        plan_segments = self._acts_of(parts, held) if any(held) else None
        if plan_segments is None:
            return None
        if any(map(self._is_late, plan_segments)):
            self._show(plan_segments)
        for number, (_, part) in enumerate(parts):
            if held[number] is None or not self._is_late(plan_segments[number]):
                continue
            for other in chain(islice(self._hands.ways(part, _TRIED), 1, None), [None]):
                tried = self._acts_of(parts, [*held[:number], other, *held[number + 1 :]])
                if tried is not None and duration_s(tried) < duration_s(plan_segments) - TIME_S:
                    plan_segments, held[number] = tried, other
                if not self._is_late(plan_segments[number]):
                    break
                self._require_time()
        return plan_segments

    def _acts_of(
        self, parts: Sequence[tuple[int, tuple[Step, ...]]], transfers: Sequence[Transfer | None]
    ) -> tuple[PlanSegment, ...] | None:
        """Return the segments of a path with the transfers given, others where none is given; None without a path."""
        plan_segments = []
        for (first, part), given in zip(parts, transfers, strict=True):
            made = given or (self._real(part) if is_transfer(part) else None)
            if made is None and is_transfer(part):
                return None
            plan_segments.append(PlanSegment(first, part if made is None else made.steps, made))
        return linked(plan_segments, self._maker)

    def _is_late(self, plan_segment: PlanSegment) -> bool:
        return sum(plan_segment.durations_s()) > sum(map(self._known_s, plan_segment.steps)) + TIME_S
