"""A path whose hands hold edges, looked for before the path is validated with hands that hold in any way.

Hands at edges come from few directions, for which there is mostly a path: then no others need be looked for.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import chain, islice

from planner.geometry.tolerance import TIME_S
from planner.motion.plan_segment import PlanSegment, duration_s, is_transfer, linked, transfers_of
from planner.motion.transfer import Transfer
from planner.planning.motion_validator import MotionValidator
from planner.primitives.primitive import Step


@dataclass(frozen=True, slots=True, eq=False)
class EdgePath:
    """A path that can be performed, in which hands hold edges where they can.

    Attributes:
        parts: the steps of each segment, with the index of the first.
        transfers: those in which hands hold edges; None for the other parts.
        plan_segments: the segments, with other transfers where there are none of these.
    """

    parts: tuple[tuple[int, tuple[Step, ...]], ...]
    transfers: tuple[Transfer | None, ...]
    plan_segments: tuple[PlanSegment, ...]

    @staticmethod
    def of(steps: Sequence[Step], validator: MotionValidator) -> "EdgePath | None":
        """Return a path that does as some steps do; None if no hand holds an edge, or there is no path.

        A part that has no transfer ends the look at once: the path will be rejected, and what its other parts could
        hold is of no use.

        Raises `OutOfTimeError` where there is no time to find out.
        """
        parts = tuple(transfers_of(steps))
        held: list[Transfer | None] = []
        for _, part in parts:
            held.append(validator.at_edges(part) if is_transfer(part) else None)
            if held[-1] is None and is_transfer(part) and validator.real(part) is None:
                return None
        return _linked(parts, tuple(held), validator) if any(held) else None

    def is_late(self, validator: MotionValidator) -> bool:
        """Return whether a segment takes longer than is known of its steps."""
        return any(_is_late(plan_segment, validator) for plan_segment in self.plan_segments)

    def quicker(self, validator: MotionValidator) -> "EdgePath":
        """Return this path with shortcuts and with other transfers where it takes longer than is known of its steps.

        Raises `OutOfTimeError` where there is no time to find out.
        """
        best = replace(self, plan_segments=linked(self.plan_segments, validator.maker, hastens=True))
        for number, (_, part) in enumerate(self.parts):
            if best.transfers[number] is None or not _is_late(best.plan_segments[number], validator):
                continue
            ways = validator.ways_at_edges(part)
            for other in chain(islice(ways, 1, None), [None]):
                transfers = (*best.transfers[:number], other, *best.transfers[number + 1 :])
                tried = _linked(self.parts, transfers, validator)
                if tried is not None and duration_s(tried.plan_segments) < duration_s(best.plan_segments) - TIME_S:
                    best = tried
                if not _is_late(best.plan_segments[number], validator):
                    break
                validator.require_time()
        return best


def _linked(
    parts: tuple[tuple[int, tuple[Step, ...]], ...],
    transfers: tuple[Transfer | None, ...],
    validator: MotionValidator,
) -> EdgePath | None:
    """Return the path with the transfers given, others where none is given; None without a path."""
    plan_segments = []
    for (first, part), given in zip(parts, transfers, strict=True):
        made = given or (validator.real(part) if is_transfer(part) else None)
        if made is None and is_transfer(part):
            return None
        plan_segments.append(PlanSegment(first, part if made is None else made.steps, made))
    return EdgePath(parts, transfers, linked(plan_segments, validator.maker))


def _is_late(plan_segment: PlanSegment, validator: MotionValidator) -> bool:
    known_s = sum(map(validator.known_s, plan_segment.steps))
    return sum(plan_segment.durations_s()) > known_s + TIME_S
