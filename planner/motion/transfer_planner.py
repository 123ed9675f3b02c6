"""Plan transfers: choose among the ways to do the steps of a transfer, and find joint paths for the promising ones."""

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import lru_cache, partial
from typing import TypeAlias

import numpy as np

from planner.geometry.keyframes import values_at
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.table import Table
from planner.geometry.tolerance import TIME_S
from planner.motion.answer_memory import RecentAnswers
from planner.motion.blocking_contacts import BlockingContacts
from planner.motion.hand_holds import edge_holds, opening_of, settling_s
from planner.motion.joint_trajectory import Line, finger_run_s
from planner.motion.lying_cloth import LyingCloth, LyingCloths
from planner.motion.opened_collisions import OpenedCollisions
from planner.motion.transfer import Transfer, Transit, is_carrying, transit_between
from planner.motion.transfer_candidate import (
    QUICK,
    SAMPLED_MORE_MAX,
    BlockedWaypoints,
    Candidate,
    KnownTransfers,
    SearchLimits,
    motion_of,
    ways_of,
)
from planner.motion.transfer_path import TransferPath
from planner.motion.transfer_path_finder import TRANSFERS_KEPT, TransferPathFinder
from planner.motion.transfer_timing import Carrying, TransferLimits, TransferTiming
from planner.motion.transit_paths import Spared, TransitPaths
from planner.motion.transit_planner import TransitPlanner
from planner.motion.waypoints import Waypoints, forget_waypoints, waypoints_of
from planner.primitives.context import Context
from planner.primitives.drive_time import DriveTime
from planner.primitives.obstacle import BlockingContact
from planner.primitives.primitive import Step
from planner.robots.armed_robot import ArmedRobot
from planner.robots.card import EDGE_OPEN_M, HELD_M
from planner.robots.tool_path import NoPath
from planner.task.trajectory import Phase

MARGIN_M = 0.001
"""The distance kept between bodies that must not touch, at the waypoints tested (m)."""

_TimedKey: TypeAlias = tuple[TransferPath, Carrying, tuple[DriveTime, float]]
"""What the timing of a path depends on: the path, the phases that it serves, how the base drives, and the rests (s)."""

_TimedPath: TypeAlias = tuple[TransferPath, TransferTiming]


class TransferPlanner:
    """Plans the transfers of one task.

    Attributes:
        transits: the paths of empty hands.
        dwell_s: how long hands rest while fingers close, and while they open (s).
        glances: how often the ends of steps were tested for free postures, cached answers counted.
        path_requests: how often joint paths were requested, cached answers counted.
        transits_planned: how many transits were planned.
    """

    def __init__(self, context: Context, machine: ArmedRobot, known: KnownTransfers | None = None) -> None:
        """Set up the planner for one context and robot.

        Args:
            context: the planning context.
            machine: the robot.
            known: what is known of the transfers of a task that differs in nothing that they depend on: it allows other
                ways to do the steps; None: nothing is known.
        """
        scene = context.scene
        paths, self.transits, collisions, self._timed = _transfer_path_finder(machine, scene.table, scene.torso_m)
        self._context, self._machine = context, machine
        self._paths = paths
        self._collisions = collisions
        self._blocked = BlockedWaypoints()
        self.known = known or KnownTransfers()
        self._candidates: dict[tuple[object, ...], Candidate] = {}
        self._made: dict[Candidate, Transfer | None] = {}
        self.glances = self.path_requests = self.transits_planned = 0
        self._contacts = BlockingContacts(machine, collisions.wide, scene.torso_m, scene.table.height_m)
        self.dwell_s = max(scene.grip_dwell_s, *(finger_run_s(arm.gripper) for arm in machine.card.arms))
        self._cloths = LyingCloths(context, collisions)
        self._hands = TransitPlanner(self.transits, self.dwell_s)
        self._pace = (context.drive_time, self.dwell_s)
        self._limits = TransferLimits.of(self.transits.layout, *self._pace)

    def validated(self, steps: Sequence[Step], search_limits: SearchLimits = QUICK) -> Transfer | None:
        """Return the transfer of a few primitives, none but the last of which lets go; None if none was found."""
        return self.first_valid(ways_of(steps, search_limits), search_limits)

    def first_valid(self, choices: Iterable[tuple[Step, ...]], search_limits: SearchLimits) -> Transfer | None:
        """Return the transfer of the first valid choice of steps; None if none is found within the tries.

        If all take longer than their steps' estimates, return the quickest of the first few. Once one is found, choices
        that cannot be quicker are not tried, though they count.
        """
        best: Transfer | None = None
        best_s, late, failed = math.inf, 0, 0
        for candidate in self.candidates(choices):
            if sum(step.duration_s for step in candidate.steps) >= best_s - TIME_S:
                late += 1
            elif (made := self.made(candidate)) is None:
                failed += 1
            elif not made.is_late:
                return made
            else:
                late += 1
                best, best_s = min((best, best_s), (made, sum(made.durations_s())), key=lambda found: found[1])
            if late == search_limits.late or failed >= (
                search_limits.together if candidate.is_together else search_limits.alone
            ):
                break
        return best

    def candidates(self, choices: Iterable[tuple[Step, ...]]) -> "Iterator[Candidate]":
        """Yield the choices of steps that pass a quick test, much cheaper than a search for joint paths.

        The arms must have free postures at a few waypoints: first where the steps begin and end, then where the last
        transfer of the same kind was blocked.
        """
        for steps in choices:
            if self.can_begin_and_end(steps):
                candidate = self.candidate(steps)
                if self._paths.postures.can_hold(candidate.waypoints, self._blocked.suspects(candidate)):
                    yield candidate

    def can_begin_and_end(self, steps: Sequence[Step]) -> bool:
        """Return whether the arms have free postures when each step takes hold and when its motions end."""
        self.glances += 1
        key = motion_of(steps)
        known = self.known.can_be_there
        if key not in known:
            phases = [phase for step in steps for phase in step.extremes()]
            waypoints = waypoints_of(phases, self._context.scene.table.height_m, only_ends=True)
            ends = np.flatnonzero(np.diff(waypoints.phases, append=waypoints.phases[-1] + 1))
            known[key] = self._paths.postures.can_hold_at(waypoints, [0, *ends[::-1].tolist()])
        return known[key]

    def candidate(self, steps: tuple[Step, ...]) -> "Candidate":
        """Return the candidate that some steps make, whether or not it is valid. Cached."""
        key = motion_of(steps)
        if key not in self._candidates:
            known = self.known.candidates
            if key not in known:
                known[key] = self._candidate(steps, key)
            self._candidates[key] = replace(known[key], steps=steps)
        return self._candidates[key]

    def _candidate(self, steps: tuple[Step, ...], key: tuple[object, ...]) -> "Candidate":
        phases = [(n, phase) for n, step in enumerate(steps) for phase in step.phases if phase.duration_s > 0.0]
        carrying = tuple((n, phase) for n, phase in phases if is_carrying(phase))
        before = None if steps[0].before.held else self._cloths.of(steps[0].before)
        cloths = (before, self._cloths.of(steps[-1].after))
        return Candidate(steps, key, carrying, self._waypoints([phase for _, phase in carrying]), cloths)

    def made(self, candidate: "Candidate") -> Transfer | None:
        """Return the transfer of a candidate; None if it has no path. Cached."""
        self.path_requests += 1
        if candidate not in self._made:
            self._made[candidate] = self._made_or_known(candidate)
        return self._made[candidate]

    def _made_or_known(self, candidate: "Candidate") -> Transfer | None:
        known = self.known.made
        if candidate.motion not in known:
            left_out = self.known.sampling.left_out
            found = self._paths.transfer_path(candidate.waypoints, candidate.cloths)
            made = self._transfer(candidate, found)
            known[candidate.motion] = (made, found if isinstance(found, NoPath) else None)
            if made is None and self.known.sampling.left_out > left_out:
                self.known.unsampled.add(candidate.motion)
        transfer, blocked = known[candidate.motion]
        if blocked is not None:
            self._blocked.note(candidate, blocked)
        return None if transfer is None else replace(transfer, steps=candidate.steps)

    def made_like(self, candidate: "Candidate", like: Transfer) -> Transfer | None:
        """Return the transfer of a candidate, with joints near to those of another if possible; None without a path."""
        self.path_requests += 1
        transfer_path = self._paths.adapted(candidate.waypoints, candidate.cloths, like.transfer_path)
        if isinstance(transfer_path, NoPath):
            self._blocked.note(candidate, transfer_path)
        return self._transfer(candidate, transfer_path, like)

    def made_at_edges(self, candidate: "Candidate") -> Transfer | None:
        """Return a candidate's transfer with hands holding edges where they can; None if there is none. Cached."""
        known = self.known.made_at_edges
        if candidate.motion not in known:
            known[candidate.motion] = self._searched_at_edges(candidate)
        is_searched, transfer = known[candidate.motion]
        self.path_requests += is_searched
        return None if transfer is None else replace(transfer, steps=candidate.steps)

    def _searched_at_edges(self, candidate: "Candidate") -> tuple[bool, Transfer | None]:
        waypoints = candidate.waypoints
        holds = edge_holds(self._machine, waypoints)
        if holds is None or not self._paths.postures.can_hold(waypoints, ways=(holds,)):
            return False, None
        found = self._paths.transfer_path(waypoints, candidate.cloths, (holds,))
        return True, self._transfer(candidate, found)

    def _transfer(
        self, candidate: "Candidate", transfer_path: TransferPath | NoPath, like: Transfer | None = None
    ) -> Transfer | None:
        if isinstance(transfer_path, NoPath):
            return None
        timed = self._timed.answer((transfer_path, candidate.carrying, self._pace), partial(self._clear, candidate))
        if timed is None:
            return None
        transfer_path, timing = timed
        joints, first, last = transfer_path.joints, transfer_path.first, transfer_path.last
        coming, leaving = transfer_path.approach, transfer_path.retreat
        if transfer_path.settles:
            lines = np.array([coming[-1], joints[first]]), np.array([joints[last], leaving[0]])
            if max(float(self.transits.needed_s(line)[0]) for line in lines) > settling_s(self.dwell_s):
                return None
        at_grips = joints[first] if transfer_path.settles else None
        openings_m = np.array([opening_of(hold) for hold in transfer_path.lines.holds])
        approach, retreat = self.transits.line(coming, openings_m, at_grips), self.transits.line(leaving, openings_m)
        ways = self._ways_home(candidate.steps, transfer_path, approach, retreat, like)
        return None if ways is None else Transfer(candidate.steps, transfer_path, timing, approach, retreat, *ways)

    def _clear(self, candidate: "Candidate", key: _TimedKey) -> _TimedPath | None:
        """Return a candidate's path with its timing, smoothed if nothing touches then; None if something does."""
        path, carrying, _ = key
        for one in dict.fromkeys((path.smoothed(), path)):
            joints = one.joints[one.first : one.last + 1]
            timing = TransferTiming.of(carrying, candidate.waypoints, joints, self._limits)
            if is_clear_between(one, timing, self._collisions):
                return one, timing
        return None

    def _waypoints(self, phases: Sequence[Phase]) -> Waypoints:
        return waypoints_of(phases, self._context.scene.table.height_m)

    def contact(self, steps: Sequence[Step]) -> BlockingContact | None:
        """Return the contact that blocks a transfer; None if free postures exist but no path connects them."""
        phases = [phase for step in steps for phase in step.phases if phase.duration_s > 0.0 and is_carrying(phase)]
        return self._contacts.of(self._waypoints(phases))

    def _ways_home(
        self, steps: Sequence[Step], transfer_path: TransferPath, approach: Line, retreat: Line, like: Transfer | None
    ) -> tuple[FloatArray | None, FloatArray | None] | None:
        """Return the paths of hands from home and to home while the base stands; None if one is blocked.

        They need not come where they hold the cloth already, nor go after the last fold. The ways of a similar transfer
        are tried first.
        """
        home = self.transits.home
        is_last = steps[-1].after.done == (1 << len(self._context.sequence.folds)) - 1
        (before, after), (first, last) = transfer_path.cloths, (Pose2.of(base) for base in transfer_path.bases[[0, -1]])
        coming = going = None
        if before is not None:
            spared, near = self.transits.spared(None, approach.joints), None if like is None else like.coming
            coming = self._way(first, home, approach.joints[0], before, spared, near)
            if coming is None:
                return None
        if not is_last:
            spared, near = self.transits.spared(retreat.joints, None), None if like is None else like.going
            going = self._way(last, retreat.joints[-1], home, after, spared, near)
            if going is None:
                return None
        return coming, going

    def _way(
        self,
        base: Pose2,
        start: FloatArray,
        goal: FloatArray,
        cloth: LyingCloth,
        spared: Spared,
        near: FloatArray | None,
    ) -> FloatArray | None:
        """Return a path of empty hands while the base stands; paths are sampled as long as that helps."""
        found = None if near is None else self.transits.way_near(base, start, goal, cloth, spared, near)
        if found is None:
            samples = self.known.sampling.is_worth_a_try
            found = self.transits.way(base, start, goal, cloth, spared, samples=samples)
            if found is None:
                self.known.sampling.vain += samples
                self.known.sampling.left_out += not samples
        return found

    def sample_more(self) -> None:
        """Let more paths of empty hands be sampled in vain, also for what has no transfer for want of one."""
        self.known.sampling.most = SAMPLED_MORE_MAX
        for motion in self.known.unsampled:
            self.known.made.pop(motion, None)
        self.known.unsampled.clear()
        self._made = {candidate: made for candidate, made in self._made.items() if made is not None}

    def transit(
        self, before: Transfer | None, moves: Sequence[Step], transfer: Transfer, *, hastens: bool = False
    ) -> Transit | None:
        """Return how hands come from a transfer, or from home, to the next one. Cached.

        Args:
            before: the transfer before, None for none.
            moves: the steps between the two.
            transfer: the next transfer.
            hastens: whether shortcuts are looked for where hands come late; what is found is returned from then on.

        Returns:
            None where the transfer begins with cloth in the hands.
        """
        cloth = transfer.transfer_path.cloths[0]
        if cloth is None:
            return None
        begins = (moves[0] if moves else transfer.steps[0]).before.key
        key = (before and before.transfer_path, begins, *(move.after.key for move in moves), transfer.transfer_path)
        known = self.known.transits
        if key not in known:
            self.transits_planned += 1
            known[key] = transit_between(self._hands, self._context.drive_time, before, moves, transfer, cloth)
        if hastens and known[key].late_s > 0.0 and key not in self.known.hastened:
            self.transits_planned += 1
            self.known.hastened.add(key)
            known[key] = transit_between(
                self._hands, self._context.drive_time, before, moves, transfer, cloth, known[key]
            )
        return known[key]


@lru_cache(maxsize=4)
def _transfer_path_finder(
    machine: ArmedRobot, table: Table, torso_m: float
) -> tuple[TransferPathFinder, TransitPaths, OpenedCollisions, RecentAnswers[_TimedKey, _TimedPath | None]]:
    """Return what is kept from plan to plan at a table: the searches for joint paths, collisions, and timed paths."""
    collisions = OpenedCollisions(machine, table, torso_m, MARGIN_M)
    transits = TransitPaths(machine, collisions, torso_m)
    paths = TransferPathFinder(machine, collisions, torso_m, table.height_m)
    return paths, transits, collisions, RecentAnswers(TRANSFERS_KEPT)


def forget_paths() -> None:
    """Clear the cache of joint paths and transits, so that benchmarks measure their computation."""
    _transfer_path_finder.cache_clear()
    forget_waypoints()


_SHARES = np.array([0.0, 0.25, 0.5, 0.75])
"""Where hands are tested from each waypoint on to the next: between these joints turn about evenly."""


def is_clear_between(transfer_path: TransferPath, timing: TransferTiming, collisions: OpenedCollisions) -> bool:
    """Return whether nothing touches between the waypoints of a transfer, where joints sag a little, before and after.

    While hands hold cloth their joints are taken as they are timed; on the lines to the grips and from them joints turn
    evenly.
    """
    gaps = np.diff(timing.times_s)
    starts = np.flatnonzero(gaps > TIME_S)
    times = np.append((timing.times_s[starts, None] + gaps[starts, None] * _SHARES).ravel(), timing.times_s[-1])
    rows = transfer_path.first + timing.waypoints
    joints = values_at(timing.times_s, transfer_path.joints[rows], timing.velocities, times)
    bases = np.column_stack([np.interp(times, timing.times_s, column) for column in transfer_path.bases[rows].T])
    holds, lead, tail = transfer_path.lines.holds, transfer_path.approach, transfer_path.retreat
    is_held = np.all(transfer_path.waypoints.is_held[:, [0, -1]], axis=1)
    open_m = [opening_of(hold) for hold in holds]
    held_m = [
        opening_of(hold) if not is_held[arm] else HELD_M if hold.is_narrow else EDGE_OPEN_M
        for arm, hold in enumerate(holds)
    ]
    return all(
        collisions.is_path_free(stands, there, np.tile(openings_m, (len(there), 1)))
        for stands, there, openings_m in (
            (bases, joints, held_m),
            (transfer_path.bases[: len(lead)], lead, open_m),
            (transfer_path.bases[-len(tail) :], tail, open_m),
        )
    )
