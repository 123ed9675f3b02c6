"""A transit: how base, cloth and empty hands come from one transfer to the next, and what that takes."""

from collections.abc import Sequence
from dataclasses import dataclass

from planner.geometry.tolerance import TIME_S
from planner.motion.line import Keyframes
from planner.motion.lying_cloth import LyingCloth
from planner.motion.timed_phase import TimedPhase, TransitTime
from planner.motion.transfer import Transfer
from planner.motion.transit_planner import TransitPlanner
from planner.primitives.drive_time import DriveTime
from planner.primitives.primitive import Step


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
        for phase in step.phases():
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
    times = TransitTime(timed_phases, 0.0, cloth)
    if late is None:
        free, keyframes = planner.keyframes(times, retreat, transfer.approach, going, transfer.coming)
    else:
        before_s = TransitTime(list(late.timed_phases), 0.0, cloth)
        free, keyframes = planner.sooner(times, retreat, transfer.approach, (before_s, late.keyframes))
    late_s = free.end_s - planned_s
    return Transit(tuple(free.timed_phases), keyframes, late_s if late_s > TIME_S else 0.0)
