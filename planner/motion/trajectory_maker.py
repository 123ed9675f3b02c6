"""Make the trajectory of a plan from its plan segments: phases of base and cloth, one joint trajectory for the arms.

Both come from the transfers, while cloth is held, and from the transits between them, while hands are empty and the
base drives.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import accumulate, pairwise

import numpy as np

from planner.geometry.keyframes import ramps, rate_at, values_at
from planner.geometry.pose import FloatArray
from planner.geometry.table import TableTop
from planner.geometry.tolerance import TIME_S
from planner.motion.hand_holds import settling_s
from planner.motion.joint_trajectory import JointTrajectory, Keyframes, finger_limits_over
from planner.motion.plan_segment import PlanSegment
from planner.motion.timed_phase import TimedPhase
from planner.motion.transfer import Transfer, Transit
from planner.motion.transfer_planner import TransferPlanner
from planner.motion.transit_paths import TransitPaths
from planner.primitives.context import Context
from planner.primitives.drive_time import DriveTime
from planner.robots.card import ArmCard, RobotCard
from planner.task.trajectory import ArmTrack, ClothMotion, GripperTrack, Phase, Segment, Trajectory

_FINGER_KNOTS = 8
"""Keyframes while fingers close or open: they swing on links, so their joint does not move as the opening does."""

_NEAR_M = 1e-6
"""The distance between openings by which the joint's change with the opening is measured (m)."""


def trajectory(
    context: Context, card: RobotCard, maker: TransferPlanner, plan_segments: Sequence[PlanSegment]
) -> Trajectory:
    """Return the trajectory of robot and cloth in a plan's segments.

    Args:
        context: the planning context.
        card: the robot.
        maker: the planner that made the segments' joint paths.
        plan_segments: the segments, one after the other.
    """
    builder = _TrajectoryBuilder(context.drive_time, maker.transits, maker.dwell_s)
    segments = tuple(builder.segments(plan_segments, _standing(context)))
    track = builder.track
    rows, velocities = np.array(track.joints), np.array(track.velocities)
    names = tuple(name for arm in card.arms for name in arm.joint_names)
    return Trajectory(
        segments[-1].start_s + segments[-1].duration_s,
        segments,
        ArmTrack(names, tuple(track.times_s), *(tuple(map(tuple, each.tolist())) for each in (rows, velocities))),
        tuple(_gripper_track(arm, *track.openings(number)) for number, arm in enumerate(card.arms)),
        0.0 if card.lift_joint is None else context.scene.torso_m,
        card.still_values(context.scene.torso_m),
    )


def _gripper_track(arm: ArmCard, times_s: Sequence[float], openings_m: Sequence[float]) -> GripperTrack:
    """Return a gripper's keyframes, with additional ones wherever it moves."""
    hand = arm.gripper
    keyframes = [(times_s[0], openings_m[0], 0.0)]
    for (begin, start), (until, end) in pairwise(zip(times_s, openings_m, strict=True)):
        run = ramps(until - begin, 1.0, *finger_limits_over(hand, end - start))
        knots = np.array(run.times_s) if start == end else np.linspace(0.0, until - begin, _FINGER_KNOTS + 1)
        since = np.union1d(run.times_s, knots)[1:]
        since = since[np.append(np.diff(since) > TIME_S, True)]
        way = np.array(run.times_s), np.array(run.fractions), np.array(run.rates)
        opened = start + values_at(*way, since) * (end - start)
        faster = np.array([rate_at(run.times_s, run.fractions, run.rates, t) for t in since.tolist()]) * (end - start)
        opened[-1] = end  # but for rounding it is there
        keyframes += zip((begin + since).tolist(), opened.tolist(), faster.tolist(), strict=True)
    times, openings, rates = (tuple(column) for column in zip(*keyframes, strict=True))
    angle = {one: hand.angle(one) for one in set(openings)}
    swing = {one: (hand.angle(one + _NEAR_M) - hand.angle(one - _NEAR_M)) / (2.0 * _NEAR_M) for one in angle}
    positions = tuple(angle[one] for one in openings)
    velocities = tuple(swing[one] * rate for one, rate in zip(openings, rates, strict=True))
    return GripperTrack(arm.name, hand.joint_name, times, openings, positions, rates, velocities)


def _standing(context: Context) -> Phase:
    """Return a phase of no length in which nothing moves: all that a plan without steps shows."""
    state = context.start
    base, placement = context.base_pose(state.station, state.standoff), context.placed(state.offset)
    still = ClothMotion(state.done, placement, placement, TableTop.of(context.scene.table))
    return Phase(0.0, (base, base), (None,) * len(context.reach.arm_names), still)


class _TrajectoryBuilder:
    """Joins transits, transfers and moves into one trajectory."""

    def __init__(self, time: DriveTime, transits: TransitPaths, dwell_s: float) -> None:
        """Begin with all arms at home.

        Args:
            time: the time that the base takes.
            transits: the paths of empty hands.
            dwell_s: the time that fingers take to close and to open (s).
        """
        self._time = time
        self._transits, self._arms = transits, len(transits.layout.arms)
        self._dwell_s = dwell_s
        self.track = JointTrajectory.at_rest(transits.home, self._arms)
        self._timed_phases: list[TimedPhase] = []
        self._now = 0.0
        self._turns: FloatArray = np.zeros_like(transits.home)

    def segments(self, plan_segments: Sequence[PlanSegment], rest: Phase) -> Iterator[Segment]:
        """Yield the segments of base and cloth in a plan's segments; only `rest` if there are none."""
        moves: list[TimedPhase] = []
        for plan_segment in plan_segments:
            if plan_segment.transfer is not None:
                self._add(plan_segment, plan_segment.transfer)
                moves.clear()  # they were part of the transit
                continue
            for number, step in enumerate(plan_segment.steps, start=plan_segment.first):
                lasting = (phase for phase in step.phases if phase.duration_s > 0.0)
                moves += [TimedPhase.driven(number, phase, self._time) for phase in lasting]
        self._timed_phases += moves
        if not self._timed_phases:
            self._timed_phases.append(TimedPhase.even(0, rest, 0.0))
        starts = accumulate((timed.duration_s for timed in self._timed_phases), initial=0.0)
        for timed, start_s in zip(self._timed_phases, starts, strict=False):
            times, fractions = tuple(timed.times_s.tolist()), tuple(timed.fractions.tolist())
            rates, base_rates = tuple(timed.rates.tolist()), tuple(timed.base_rates.tolist())
            yield Segment(timed.primitive, start_s, timed.phase, times, fractions, rates, base_rates)

    def _add(self, plan_segment: PlanSegment, transfer: Transfer) -> None:
        """Add the transit to a transfer, and the transfer."""
        if plan_segment.transit is None:
            self._begin_holding(transfer)
        else:
            self._reach(plan_segment.first, plan_segment.transit)
            self._turns = self.track.last - transfer.transfer_path.joints[transfer.transfer_path.first]
        held = self._now
        timing = transfer.timing
        self._timed_phases += _counted(plan_segment.first, timing.timed_phases)
        transfer_path, end = transfer.transfer_path, held + float(timing.times_s[-1])
        joints = transfer_path.joints[transfer_path.first + timing.waypoints] + self._turns
        run = Keyframes(held + timing.times_s, joints, timing.velocities)
        settling = settling_s(self._dwell_s) if transfer_path.settles else 0.0
        if transfer_path.settles:
            opened = transfer_path.retreat[0] + self._turns
            settled = self._transits.eased(joints[-1], opened, settling).later(end - self._dwell_s)
            run = Keyframes.joined([run.until(len(joints) - 1), settled, Keyframes.still(opened, end)])
        self.track.add(run)
        is_last, holds = transfer_path.waypoints.is_last_held, transfer_path.lines.holds
        for arm in np.flatnonzero(transfer_path.waypoints.is_used).tolist():
            own = settling if holds[arm].is_narrow else 0.0
            opens = held + timing.first_s(int(np.argmax(is_last[arm]))) + own
            if held > 0.0:
                closes = held - self._dwell_s
                self.track.narrow(arm, holds[arm].opening_m, self._dwell_s, closes)
                self.track.close(arm, closes, held - own, holds[arm].held_m)
            self.track.open(arm, opens, opens + self._dwell_s - own, holds[arm].opening_m)
        self._now = end

    def _begin_holding(self, transfer: Transfer) -> None:
        """Begin with the cloth in the hands, at the first joints of the transfer."""
        self.track = JointTrajectory.at_rest(transfer.transfer_path.joints[transfer.transfer_path.first], self._arms)
        for arm in np.flatnonzero(transfer.transfer_path.waypoints.is_used).tolist():
            self.track.begin_closed(arm, transfer.holds[arm].held_m)

    def _reach(self, primitive: int, transit: Transit) -> None:
        """Add a transit to the transfer that begins with a primitive."""
        times_s, joints, velocities = transit.keyframes
        self.track.add(Keyframes(self._now + times_s, joints + self._turns, velocities))
        self._timed_phases += _counted(primitive, transit.timed_phases)
        self._now += transit.duration_s


def _counted(primitive: int, timed_phases: Iterable[TimedPhase]) -> Iterator[TimedPhase]:
    """Yield phases whose primitives are counted from one of the plan's."""
    return (replace(timed, primitive=primitive + timed.primitive) for timed in timed_phases)
