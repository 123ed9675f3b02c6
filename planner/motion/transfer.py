"""A validated transfer: joint paths, and the time they take."""

from dataclasses import dataclass

from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import TIME_S
from planner.motion.hand_holds import Holds
from planner.motion.line import Line
from planner.motion.transfer_path import TransferPath
from planner.motion.transfer_timing import TransferTiming
from planner.primitives.primitive import Step
from planner.task.phase import Phase


def is_carrying(phase: Phase) -> bool:
    """Return whether a hand holds cloth throughout a phase."""
    return any(hand is not None and not hand.is_reaching for hand in phase.hands)


@dataclass(frozen=True, slots=True, eq=False)
class Transfer:
    """The motion of the arms from before their grips to after letting go.

    Attributes:
        steps: the primitives, as steps of the plan.
        transfer_path: the joint paths.
        timing: the timing while cloth is held.
        approach: the quickest way straight to the grips.
        retreat: the quickest way straight from them.
        coming: the way from home to the approach beside a base that stands, shape (n, joints), rad; None where the
            hands hold the cloth already.
        going: the way home from the retreat, alike; None after the last fold.
    """

    steps: tuple[Step, ...]
    transfer_path: TransferPath
    timing: TransferTiming
    approach: Line
    retreat: Line
    coming: FloatArray | None
    going: FloatArray | None

    @property
    def holds(self) -> Holds:
        """How each arm's hand holds the cloth."""
        return self.transfer_path.lines.holds

    @property
    def edges(self) -> int:
        """How many hands hold an edge with one finger under it."""
        return sum(hold.is_narrow for hold in self.holds)

    @property
    def free_phases(self) -> tuple[Phase, ...]:
        """The phases before the hands reach the grips: the base drives, the hands reach."""
        return tuple(p for p in self.steps[0].phases() if p.duration_s > 0.0 and not is_carrying(p))

    @property
    def is_late(self) -> bool:
        """Whether it takes longer than its steps' estimates, whatever comes before and after it."""
        return sum(self.durations_s()) > sum(step.duration_s for step in self.steps)

    def durations_s(self) -> tuple[float, ...]:
        """Return the real duration of each step (s), if empty hands come in time."""
        late = [0.0] * len(self.steps)
        for timed in self.timing.timed_phases:
            late[timed.primitive] += timed.duration_s - timed.phase.duration_s
        late[0] -= self.timing.borrowed_s
        exact = (excess if excess > TIME_S else 0.0 for excess in late)
        return tuple(step.duration_s + excess for step, excess in zip(self.steps, exact, strict=True))
