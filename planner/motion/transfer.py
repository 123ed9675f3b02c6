"""A validated transfer: joint paths, and the time they take."""

from dataclasses import dataclass, replace

from planner.geometry.tolerance import TIME_S
from planner.motion.carried import Carried
from planner.motion.hand_holds import Holds
from planner.motion.line import Line
from planner.motion.transfer_timing import TransferTiming
from planner.primitives.primitive import Step
from planner.task.phase import Phase


def is_carrying(phase: Phase) -> bool:
    """Return whether a hand holds cloth throughout a phase."""
    return any(hand is not None and not hand.is_reaching for hand in phase.hands)


@dataclass(frozen=True, slots=True)
class ReachTime:
    """The time of a reach: hands go home from the transfer before, come to their grips, and close their fingers.

    The times are those that the joints' speeds allow; a transit that must also speed up and slow down may take longer.

    Attributes:
        coming_s: the time they need from home to the grips (s).
        leaving_s: the time they need to go home after the transfer (s); 0 where they need not.
        room_s: the part of the reach available for leaving the transfer before and for coming (s); negative where the
            reach is too short for its rests.
        share_s: the part of any reach reserved for leaving while the transfer before is unknown (s).
        before_s: the time they need to go home after the transfer before (s); the share as long as that is unknown.
    """

    coming_s: float
    leaving_s: float
    room_s: float
    share_s: float
    before_s: float

    @property
    def late_s(self) -> float:
        """The time by which the reach takes longer than there is room for (s)."""
        return max(0.0, self.before_s + self.coming_s - self.room_s)

    @property
    def late_at_most_s(self) -> tuple[float, float]:
        """The times by which coming and leaving exceed their shares (s)."""
        return self.late_s, max(0.0, self.leaving_s - self.share_s)


@dataclass(frozen=True, slots=True, eq=False)
class Transfer:
    """The motion of the arms from before their grips to after letting go.

    Attributes:
        steps: the primitives, as steps of the plan.
        carried: the joint paths.
        timing: the timing while cloth is held.
        lead: the quickest way straight to the grips.
        tail: the quickest way straight from them.
        reach: the time that hands need before and after it, and the time available for that.
    """

    steps: tuple[Step, ...]
    carried: Carried
    timing: TransferTiming
    lead: Line
    tail: Line
    reach: ReachTime

    @property
    def holds(self) -> Holds:
        """How each arm's hand holds the cloth."""
        return self.carried.lines.holds

    @property
    def free_phases(self) -> tuple[Phase, ...]:
        """The phases before the hands reach the grips: the base drives, the hands reach."""
        return tuple(p for p in self.steps[0].phases() if p.duration_s > 0.0 and not is_carrying(p))

    def following(self, before: "Transfer | None") -> "Transfer":
        """Return the transfer as it follows another one; None: the hands come from home."""
        return replace(self, reach=replace(self.reach, before_s=0.0 if before is None else before.reach.leaving_s))

    @property
    def reach_late_s(self) -> float:
        """The time by which its reach takes longer than estimated (s); negative where later rests are part of it."""
        return self.reach.late_s - self.timing.borrowed_s

    @property
    def is_late(self) -> bool:
        """Whether it takes longer than its steps' estimates, whatever comes before and after it."""
        return sum(self.durations_at_most_s()) > sum(step.duration_s for step in self.steps)

    def durations_s(self) -> tuple[float, ...]:
        """Return the real duration of each step (s)."""
        return self._durations_s(self.reach.late_s, 0.0)

    def durations_at_most_s(self) -> tuple[float, ...]:
        """Return each step's duration if hands have fixed shares of the reaches before and after it (s).

        This holds for a transfer on its own; in a sequence, transfers never take longer.
        """
        return self._durations_s(*self.reach.late_at_most_s)

    def _durations_s(self, coming_late_s: float, leaving_late_s: float) -> tuple[float, ...]:
        late = [0.0] * len(self.steps)
        for timed in self.timing.timed_phases:
            late[timed.primitive] += timed.duration_s - timed.phase.duration_s
        late[0] += coming_late_s - self.timing.borrowed_s
        late[-1] += leaving_late_s
        exact = (excess if excess > TIME_S else 0.0 for excess in late)
        return tuple(step.duration_s + excess for step, excess in zip(self.steps, exact, strict=True))
