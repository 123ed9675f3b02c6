"""Validated transfers, with joint paths and the time they take, and the transits between them.

In a transit base, cloth and empty hands come from one transfer to the next.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from planner.geometry.pose import FloatArray
from planner.geometry.tolerance import TIME_S
from planner.motion.hand_holds import Holds
from planner.motion.joint_trajectory import Keyframes, Line
from planner.motion.lying_cloth import LyingCloth
from planner.motion.timed_phase import TimedPhase, TransitTime
from planner.motion.transfer_path import TransferPath
from planner.motion.transfer_timing import TransferTiming
from planner.motion.transit_planner import TransitPlanner
from planner.primitives.drive_time import DriveTime
from planner.primitives.primitive import Step
from planner.task.trajectory import Phase


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
        return sum(hold.is_narrow and hold.kind == "edge" for hold in self.holds)

    @property
    def free_phases(self) -> tuple[Phase, ...]:
        """The phases before the hands reach the grips: the base drives, the hands reach."""
        return tuple(p for p in self.steps[0].phases if p.duration_s > 0.0 and not is_carrying(p))

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


@dataclass(frozen=True, slots=True, eq=False)
class Transit:
    """The motion from where hands let go, or from home, to the next grips.

    Attributes:
        timed_phases: the phases of base and cloth; their primitives are counted from the first step of the transfer
            that follows, so those of moves before it are negative.
        keyframes: the hands' keyframes, from 0 s on, continuous joints wound as at the end of the transfer before.
        late_s: the time by which it takes longer than the cost model says (s).
    """

    timed_phases: tuple[TimedPhase, ...]
    keyframes: Keyframes
    late_s: float

    @property
    def duration_s(self) -> float:
        """The duration (s)."""
        return sum(timed.duration_s for timed in self.timed_phases)


def transit_between(
    planner: TransitPlanner,
    time: DriveTime,
    before: Transfer | None,
    moves: Sequence[Step],
    transfer: Transfer,
    cloth: LyingCloth,
    late: Transit | None = None,
) -> Transit:
    """Plan a transit.

    Args:
        planner: leads the hands.
        time: the time that the base takes.
        before: the transfer before; None: the hands come from home.
        moves: the steps between the two transfers, in which nothing is held.
        transfer: the transfer that follows.
        cloth: the cloth on the table meanwhile.
        late: the transit as planned before, with hands that come late: a quicker one is looked for.
    """
    # Rests of a drag are part of the reach before it, and so is what a base needs to speed up and to slow down.
    lost_s = transfer.timing.borrowed_s
    planned_s, timed_phases = -lost_s, []
    for number, step in enumerate(moves, start=-len(moves)):
        for phase in step.phases:
            if phase.duration_s > 0.0:
                timed_phases.append(TimedPhase.driven(number, phase, time))
                planned_s += phase.duration_s
    for phase in transfer.free_phases:
        planned_s += phase.duration_s
        if any(phase.hands):
            timed_phases.append(TimedPhase.even(0, phase, max(phase.duration_s - lost_s, planner.dwell_s)))
        else:
            timed_phases.append(TimedPhase.driven(0, phase, time))
            lost_s += timed_phases[-1].duration_s - phase.duration_s
    retreat = None if before is None else before.retreat
    going = None if before is None else before.going
    times = TransitTime(timed_phases, cloth)
    if late is None:
        free, keyframes = planner.keyframes(times, retreat, transfer.approach, going, transfer.coming)
    else:
        before_s = TransitTime(list(late.timed_phases), cloth)
        free, keyframes = planner.sooner(times, retreat, transfer.approach, (before_s, late.keyframes))
    late_s = free.end_s - planned_s
    return Transit(tuple(free.timed_phases), keyframes, late_s if late_s > TIME_S else 0.0)
