"""The acts of a validated plan: transfers in which cloth is held, and moves between them."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from planner.motion.transfer import Transfer
from planner.primitives.primitive import Step


@dataclass(frozen=True, slots=True, eq=False)
class Act:
    """Primitives that follow one another without letting go, or one primitive in which nothing is held.

    Attributes:
        first: the index of its first primitive in the plan.
        steps: its primitives, as steps of the plan.
        transfer: the transfer with its joint paths; None where nothing is held.
    """

    first: int
    steps: tuple[Step, ...]
    transfer: Transfer | None

    def durations_s(self) -> tuple[float, ...]:
        """Return the duration of each of its primitives (s)."""
        return (
            self.transfer.durations_s() if self.transfer is not None else tuple(step.duration_s for step in self.steps)
        )


def in_turn(acts: Sequence[Act]) -> tuple[Act, ...]:
    """Return acts as they follow one another: the hands come to each transfer from the one before it."""
    before: Transfer | None = None
    found = []
    for act in acts:
        transfer = None if act.transfer is None else act.transfer.following(before)
        found.append(replace(act, transfer=transfer))
        before = transfer or before
    return tuple(found)


def duration_s(acts: Sequence[Act]) -> float:
    """Return the total duration of acts (s)."""
    return sum(sum(act.durations_s()) for act in acts)


def transfers_of(steps: Sequence[Step]) -> Iterator[tuple[int, tuple[Step, ...]]]:
    """Yield the transfers of a plan: steps that follow one another without letting go, with the index of the first.

    The last transfer may end with cloth in the hands, if the task asks for no more.
    """
    first = 0
    for number, step in enumerate(steps):
        if not step.after.held or number == len(steps) - 1:
            yield first, tuple(steps[first : number + 1])
            first = number + 1
