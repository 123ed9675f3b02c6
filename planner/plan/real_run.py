"""A run of primitives made real: joint paths, and the time they take."""

from dataclasses import dataclass

from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import TIME_S
from planner.plan.carried import Carried
from planner.plan.run_timing import RunTiming
from planner.primitives.phase import Phase
from planner.primitives.primitive import Step


def is_carrying(phase: Phase) -> bool:
    """Whether a hand holds cloth throughout a phase."""
    return any(hand is not None and not hand.is_reaching for hand in phase.hands)


@dataclass(frozen=True, slots=True, eq=False)
class RealRun:
    """What the arms do from before their grips to after letting go.

    Attributes:
        steps: the primitives, as they are performed.
        carried: the joints.
        timing: when what happens while cloth is held.
        lead_s: the least time for each step that leads to the grips, shape (steps before the moments,).
        tail_s: the least time for each step away from them, shape (steps after the moments,).
        late_s: how much more than their shares of a reach's time it takes to come from home to the grips and close
            the fingers, and to go home afterwards (s).
    """

    steps: tuple[Step, ...]
    carried: Carried
    timing: RunTiming
    lead_s: FloatArray
    tail_s: FloatArray
    late_s: tuple[float, float]

    @property
    def free_phases(self) -> tuple[Phase, ...]:
        """The phases before the grips are reached: the base drives, the hands reach."""
        return tuple(p for p in self.steps[0].phases() if p.duration_s > 0.0 and not is_carrying(p))

    @property
    def reach_late_s(self) -> float:
        """How much longer its reach takes than it seems to (s); negative where rests that follow are part of it."""
        return self.late_s[0] - self.timing.borrowed_s

    @property
    def is_late(self) -> bool:
        """Whether it takes longer than its steps seem to."""
        return sum(self.durations_s()) > sum(step.duration_s for step in self.steps)

    def durations_s(self) -> tuple[float, ...]:
        """How long each step really takes (s)."""
        late = [0.0] * len(self.steps)
        for cue in self.timing.cues:
            late[cue.primitive] += cue.duration_s - cue.phase.duration_s
        late[0] += self.reach_late_s
        late[-1] += self.late_s[1]
        exact = (excess if excess > TIME_S else 0.0 for excess in late)
        return tuple(step.duration_s + excess for step, excess in zip(self.steps, exact, strict=True))
