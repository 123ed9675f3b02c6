"""A run of primitives made real: joint paths, and the time they take."""

from dataclasses import dataclass, replace

from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import TIME_S
from planner.motion.carried import Carried
from planner.motion.transfer_timing import TransferTiming
from planner.primitives.primitive import Step
from planner.task.phase import Phase


def is_carrying(phase: Phase) -> bool:
    """Whether a hand holds cloth throughout a phase."""
    return any(hand is not None and not hand.is_reaching for hand in phase.hands)


@dataclass(frozen=True, slots=True)
class ReachTime:
    """The time of a reach: hands go home from the run before, come to their grips, and close their fingers.

    Attributes:
        coming_s: what they need to come from home to the grips (s).
        leaving_s: what they need to go home after the run (s); 0 where they need not.
        room_s: what there is of the reach for leaving the run before and for coming (s), negative where there is less
            than no time.
        share_s: how much of any reach is for leaving where it is not known which run is before (s).
        before_s: what they need to go home after the run before (s); the share as long as that run is not known.
    """

    coming_s: float
    leaving_s: float
    room_s: float
    share_s: float
    before_s: float

    @property
    def late_s(self) -> float:
        """How much longer the reach takes than there is room for (s)."""
        return max(0.0, self.before_s + self.coming_s - self.room_s)

    @property
    def late_at_most_s(self) -> tuple[float, float]:
        """How much coming and leaving exceed their shares (s)."""
        return self.late_s, max(0.0, self.leaving_s - self.share_s)


@dataclass(frozen=True, slots=True, eq=False)
class Transfer:
    """What the arms do from before their grips to after letting go.

    Attributes:
        steps: the primitives, as they are performed.
        carried: the joints.
        timing: when what happens while cloth is held.
        lead_s: the least time for each step that leads to the grips, shape (steps before the moments,).
        tail_s: the least time for each step away from them, shape (steps after the moments,).
        reach: the time that hands need before and after it, and what there is for that.
    """

    steps: tuple[Step, ...]
    carried: Carried
    timing: TransferTiming
    lead_s: FloatArray
    tail_s: FloatArray
    reach: ReachTime

    @property
    def free_phases(self) -> tuple[Phase, ...]:
        """The phases before the grips are reached: the base drives, the hands reach."""
        return tuple(p for p in self.steps[0].phases() if p.duration_s > 0.0 and not is_carrying(p))

    def following(self, before: "Transfer | None") -> "Transfer":
        """Return it as it is done after another run; None: the hands come from home."""
        return replace(self, reach=replace(self.reach, before_s=0.0 if before is None else before.reach.leaving_s))

    @property
    def reach_late_s(self) -> float:
        """How much longer its reach takes than it seems to (s); negative where rests that follow are part of it."""
        return self.reach.late_s - self.timing.borrowed_s

    @property
    def is_late(self) -> bool:
        """Whether it takes longer than its steps seem to, whatever is done before and after it."""
        return sum(self.durations_at_most_s()) > sum(step.duration_s for step in self.steps)

    def durations_s(self) -> tuple[float, ...]:
        """Return how long each step really takes (s)."""
        return self._durations_s(self.reach.late_s, 0.0)

    def durations_at_most_s(self) -> tuple[float, ...]:
        """Return how long each step takes where hands have fixed shares of the reaches before and after it (s).

        That is for a run as it was made; one after the other, runs never take longer.
        """
        return self._durations_s(*self.reach.late_at_most_s)

    def _durations_s(self, coming_late_s: float, leaving_late_s: float) -> tuple[float, ...]:
        late = [0.0] * len(self.steps)
        for cue in self.timing.cues:
            late[cue.primitive] += cue.duration_s - cue.phase.duration_s
        late[0] += coming_late_s - self.timing.borrowed_s
        late[-1] += leaving_late_s
        exact = (excess if excess > TIME_S else 0.0 for excess in late)
        return tuple(step.duration_s + excess for step, excess in zip(self.steps, exact, strict=True))
