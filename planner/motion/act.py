"""What a plan consists of once it is real: runs in which cloth is held, and moves between them."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from planner.motion.transfer import Transfer
from planner.primitives.primitive import Step


@dataclass(frozen=True, slots=True, eq=False)
class Act:
    """Primitives that follow one another without letting go, or one in which nothing is held.

    Attributes:
        first: the index of its first primitive in the plan.
        steps: its primitives, as they are performed.
        run: the joint paths; None where nothing is held.
    """

    first: int
    steps: tuple[Step, ...]
    run: Transfer | None

    def durations_s(self) -> tuple[float, ...]:
        """How long each of its primitives takes (s)."""
        return self.run.durations_s() if self.run is not None else tuple(step.duration_s for step in self.steps)


def in_turn(acts: Sequence[Act]) -> tuple[Act, ...]:
    """Return acts as they are done one after the other: the hands come to each run from the one before it."""
    before: Transfer | None = None
    found = []
    for act in acts:
        run = None if act.run is None else act.run.following(before)
        found.append(replace(act, run=run))
        before = run or before
    return tuple(found)


def duration_s(acts: Sequence[Act]) -> float:
    """Return how long acts take together (s)."""
    return sum(sum(act.durations_s()) for act in acts)


def runs_of(steps: Sequence[Step]) -> Iterator[tuple[int, tuple[Step, ...]]]:
    """Steps that follow one another without letting go, each time with the index of the first.

    The last ones may end with cloth in the hands, if that is all that is asked for.
    """
    first = 0
    for number, step in enumerate(steps):
        if not step.after.held or number == len(steps) - 1:
            yield first, tuple(steps[first : number + 1])
            first = number + 1
