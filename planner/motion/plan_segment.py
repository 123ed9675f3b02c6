"""The segments of a validated plan: transfers in which cloth is held, and moves between them."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from planner.motion.transfer import Transfer, Transit
from planner.motion.transfer_planner import TransferPlanner
from planner.primitives.primitive import Step


@dataclass(frozen=True, slots=True, eq=False)
class PlanSegment:
    """Primitives that follow one another without letting go, or one primitive in which nothing is held.

    Attributes:
        first: the index of its first primitive in the plan.
        steps: its primitives, as steps of the plan.
        transfer: the transfer with its joint paths; None where nothing is held.
        transit: how the hands come to it; None as long as what comes before is unknown, and where it begins with cloth
            in the hands.
    """

    first: int
    steps: tuple[Step, ...]
    transfer: Transfer | None
    transit: Transit | None = None

    def durations_s(self) -> tuple[float, ...]:
        """Return the duration of each of its primitives (s)."""
        if self.transfer is None:
            return tuple(step.duration_s for step in self.steps)
        first_s, *others_s = self.transfer.durations_s()
        return first_s + self.late_s, *others_s

    @property
    def late_s(self) -> float:
        """The time by which the hands come to it late (s)."""
        return 0.0 if self.transit is None else self.transit.late_s


def linked(
    plan_segments: Sequence[PlanSegment], maker: TransferPlanner, *, hastens: bool = False
) -> tuple[PlanSegment, ...]:
    """Return segments as they follow one another: the hands come to each transfer from the one before it.

    If wanted, shortcuts are looked for where they come late.
    """
    before: Transfer | None = None
    moves: list[Step] = []
    found = []
    for plan_segment in plan_segments:
        if plan_segment.transfer is None:
            found.append(plan_segment)
            moves += plan_segment.steps
        else:
            transit = maker.transit(before, moves, plan_segment.transfer, hastens=hastens)
            found.append(replace(plan_segment, transit=transit))
            before, moves = plan_segment.transfer, []
    return tuple(found)


def duration_s(plan_segments: Sequence[PlanSegment]) -> float:
    """Return the total duration of segments (s)."""
    return sum(sum(plan_segment.durations_s()) for plan_segment in plan_segments)


def is_transfer(steps: Sequence[Step]) -> bool:
    """Return whether hands hold cloth in some of the steps."""
    return any(step.grips for step in steps)


def transfers_of(steps: Sequence[Step]) -> Iterator[tuple[int, tuple[Step, ...]]]:
    """Yield the transfers of a plan: steps that follow one another without letting go, with the index of the first.

    The last transfer may end with cloth in the hands, if the task asks for no more.
    """
    first = 0
    for number, step in enumerate(steps):
        if not step.after.held or number == len(steps) - 1:
            yield first, tuple(steps[first : number + 1])
            first = number + 1
