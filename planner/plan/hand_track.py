"""One arm through a whole plan: keyframes of its joints and of its gripper.

While a hand follows points, each point becomes a keyframe: the solution of the inverse kinematics nearest to the
one before. When it reaches for something it goes by way of points above where it was and above where it goes. When
it is free it rises and goes home.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from planner.geometry.pose import Approach, FloatArray, Pose2
from planner.plan.machine import Machine
from planner.primitives.phase import Hand, Phase
from planner.primitives.work import Work

VIA_HEIGHTS_M = (0.15, 0.10, 0.05)
"""How far above a grip a hand passes: the first of these that is in reach (m)."""

OPEN_M, CLOSED_M = 0.06, 0.004
"""The gripper's opening when it is free and when it holds cloth (m)."""

_BASE_STEP_M = 0.02
_DESCENT_STEPS = 6
_RISE_S = 0.8
_HOME_S = 3.0
_GRASP_S = 0.3
_SWINGS_RAD = (-1.4, -0.7, 0.0, 0.7, 1.4)
_ELBOW_CLEAR_M = 0.12
_TURN_RAD_S = 2.0
_TURN_STEP_S = 0.01
_FAST_RAD, _FINER = 0.1, 8
"""Where joints go further than this from one point to the next, so many points are put in between (rad)."""

_JUMP_RAD = 0.3
"""Joints that differ by more than this belong to different ways to reach a pose: nothing lies between them (rad)."""


@dataclass(slots=True)
class HandTrack:
    """Keyframes of one arm.

    Attributes:
        times_s: when the joints' keyframes are (s), not falling.
        joints: the joints there (rad), shape (7,) each.
        grip_times_s: when the gripper's keyframes are (s).
        openings_m: the openings there (m).
    """

    times_s: list[float] = field(default_factory=list)
    joints: list[FloatArray] = field(default_factory=list)
    grip_times_s: list[float] = field(default_factory=list)
    openings_m: list[float] = field(default_factory=list)

    def joints_at(self, t_s: float) -> FloatArray:
        """The joints at a time (rad), shape (7,)."""
        after = int(np.searchsorted(self.times_s, t_s, side="right"))
        if after == 0 or after == len(self.times_s):
            return self.joints[max(after - 1, 0)]
        start, end = self.times_s[after - 1], self.times_s[after]
        share = (t_s - start) / (end - start)
        return np.asarray((1.0 - share) * self.joints[after - 1] + share * self.joints[after])

    def opening_at(self, t_s: float) -> float:
        """The gripper's opening at a time (m)."""
        return float(np.interp(t_s, self.grip_times_s, self.openings_m))

    def add(self, t_s: float, joints: FloatArray) -> None:
        """Add a keyframe of the joints."""
        self.times_s.append(t_s)
        self.joints.append(joints)


def hand_tracks(phases: list[Phase], starts: tuple[float, ...], work: Work, machine: Machine) -> tuple[HandTrack, ...]:
    """The tracks of all arms, from left to right, through phases that start at the given times (s)."""
    arms = range(len(work.reach.arm_names))
    return tuple(_Tracker(arm, work, machine).track(phases, starts) for arm in arms)


class _Tracker:
    """Builds the track of one arm."""

    def __init__(self, arm: int, work: Work, machine: Machine) -> None:
        self._arm = arm
        self._machine = machine
        self._torso_m = work.scene.torso_m
        self._height_m = work.scene.table.height_m
        self._track = HandTrack()
        self._now = machine.home(arm)
        self._approach: Approach | None = None

    def track(self, phases: list[Phase], starts: tuple[float, ...]) -> HandTrack:
        self._track.add(0.0, self._now)
        self._grip(0.0, is_closed=False)
        free_since = 0.0
        for phase, start in zip(phases, starts, strict=True):
            hand = phase.hands[self._arm]
            end = start + phase.duration_s
            if hand is None:
                continue
            if start > free_since:
                self._rest(free_since, start)
            if hand.is_reaching:
                self._reach(hand, phase.base[0], start, end)
            else:
                self._follow(hand, phase.base, start, end)
            free_since = end
        total = starts[-1] + phases[-1].duration_s if phases else 0.0
        if total > free_since:
            self._rest(free_since, total)
        return self._track

    def _rest(self, start: float, end: float) -> None:
        """Let go, rise, and go home if there is time for it."""
        self._grip(start, is_closed=False)
        rise = min(_RISE_S, end - start)
        if self._approach is not None:
            self._add_chain(self._above_here(), start, start + rise)
            self._approach = None
        if end - start - rise > _HOME_S / 2:
            self._track.add(start + rise, self._now)
            self._now = self._unwound(self._machine.home(self._arm))
            self._track.add(start + rise + min(_HOME_S, end - start - rise), self._now)
        self._track.add(end, self._now)

    def _reach(self, hand: Hand, base: Pose2, start: float, end: float) -> None:
        """Rise, pass over to above the grip, come down on it."""
        self._grip(start, is_closed=False)
        up, down = start + 0.2 * (end - start), start + 0.7 * (end - start)
        if self._approach is not None:
            self._add_chain(self._above_here(), start, up)
        else:
            self._track.add(start, self._now)
        goal = self._in_base(base, np.array(hand.points[0]))
        descent = self._descent(goal, hand.approach, self._elbow_up(goal, hand.approach))
        self._track.add(up, self._now)
        self._track.add(down, descent[0])
        self._now = descent[0]
        self._add_chain(descent[1:], down, end)
        self._approach = hand.approach
        self._grip(end - _GRASP_S, is_closed=True)

    def _follow(self, hand: Hand, base: tuple[Pose2, Pose2], start: float, end: float) -> None:
        """Keep to the points, the base standing or driving."""
        drive = float(np.hypot(base[1].x_m - base[0].x_m, base[1].y_m - base[0].y_m))
        count = max(len(hand.points), int(np.ceil(drive / _BASE_STEP_M)) + 1)
        if self._is_turned(hand.approach):
            count = max(count, int((end - start) / _TURN_STEP_S))
        corners, turn = np.array(hand.points), self._turn(hand.approach, end - start)

        def solved(share: float, near: FloatArray) -> FloatArray:
            there = self._in_base(base[0].between(base[1], share), _along(corners, share))
            return self._solved(there, turn(share), near)

        self._now = solved(0.0, self._now)
        self._track.add(start, self._now)
        for before, after in pairwise(np.linspace(0.0, 1.0, count)):
            joints = solved(float(after), self._now)
            parts = 1 if np.abs(joints - self._now).max() < _FAST_RAD else _FINER
            for share in np.linspace(before, after, parts + 1)[1:]:
                self._add_chain([solved(float(share), self._now)], start, start + float(share) * (end - start))
        self._approach = hand.approach
        self._grip(start, is_closed=hand.is_closed)

    def _is_turned(self, approach: Approach) -> bool:
        return self._approach is not None and self._approach != approach

    def _turn(self, approach: Approach, duration_s: float) -> Callable[[float], FloatArray]:
        """The tool's rotation at a share of a phase: the hand may first turn in its grip."""
        if self._approach is None or not self._is_turned(approach):
            return lambda _share: approach.rotation
        ends = Rotation.from_matrix([self._approach.rotation, approach.rotation])
        angle = float((ends[0].inv() * ends[1]).magnitude())
        settled = min(1.0, angle / _TURN_RAD_S / max(duration_s, angle / _TURN_RAD_S))
        between = Slerp([0.0, settled], ends)
        return lambda share: np.asarray(between(min(share, settled)).as_matrix())

    def _add_chain(self, chain: list[FloatArray], start: float, end: float) -> None:
        """Keyframes at an even pace, the last at the end."""
        for i, joints in enumerate(chain):
            t = start + (end - start) * (i + 1) / len(chain)
            if np.abs(joints - self._now).max() > _JUMP_RAD:
                self._track.add(t, self._now)
            self._track.add(t, joints)
            self._now = joints

    def _above_here(self) -> list[FloatArray]:
        """Straight up from where the tool is, as far as it can."""
        assert self._approach is not None
        position, _ = self._machine.tool_pose(self._arm, self._now, self._torso_m)
        rotation = self._approach.rotation
        for height in VIA_HEIGHTS_M:
            chain, now = [], self._now
            for lift in np.linspace(0.0, height, _DESCENT_STEPS)[1:]:
                target = position + np.array([0.0, 0.0, lift])
                found = self._machine.joints_near(self._arm, target, rotation, self._torso_m, now)
                if found is None:
                    break
                now = found
                chain.append(now)
            if len(chain) == _DESCENT_STEPS - 1:
                return chain
        return [self._now]

    def _elbow_up(self, goal: FloatArray, approach: Approach) -> FloatArray:
        """Of the ways to take a pose, the nearest whose elbow is well over the table, or the one where it is highest.

        While the hand then follows a path the arm stays near to how it began, so it is begun well.
        """
        found = [self._now]
        for pan in _SWINGS_RAD:
            for roll in _SWINGS_RAD:
                seed = self._now.copy()
                seed[0] += pan
                seed[2] += roll
                joints = self._machine.joints_near(self._arm, goal, approach.rotation, self._torso_m, seed)
                if joints is not None:
                    found.append(self._unwound(joints))
        heights = [self._machine.elbow_height(self._arm, joints, self._torso_m) for joints in found]
        clear = [j for j, h in zip(found[1:], heights[1:], strict=True) if h >= self._height_m + _ELBOW_CLEAR_M]
        if clear:
            return min(clear, key=lambda joints: float(np.abs(joints - self._now).max()))
        return found[1 + int(np.argmax(heights[1:]))] if len(found) > 1 else self._now

    def _descent(self, goal: FloatArray, approach: Approach, near: FloatArray) -> list[FloatArray]:
        """From above a goal, as high as is in reach, straight down to it."""
        for height in VIA_HEIGHTS_M:
            chain, now = [], near
            for lift in np.linspace(height, 0.0, _DESCENT_STEPS):
                target = goal + np.array([0.0, 0.0, lift])
                found = self._machine.joints_near(self._arm, target, approach.rotation, self._torso_m, now)
                if found is None:
                    break
                now = found
                chain.append(now)
            if len(chain) == _DESCENT_STEPS:
                return chain
        return [self._solved(goal, approach.rotation, near)] * 2

    def _solved(self, position: FloatArray, rotation: FloatArray, near: FloatArray) -> FloatArray:
        found = self._machine.joints_near(self._arm, position, rotation, self._torso_m, near)
        return near if found is None else found

    def _unwound(self, joints: FloatArray) -> FloatArray:
        """The same joints; continuous ones within half a turn of where they are."""
        card = self._machine.card.arms[self._arm]
        turns = np.round((self._now - joints) / (2 * np.pi)) * 2 * np.pi
        return np.asarray(joints + np.where(np.array(card.is_continuous), turns, 0.0))

    def _in_base(self, base: Pose2, point: FloatArray) -> FloatArray:
        return base.to_inner(point + np.array([0.0, 0.0, self._height_m]))

    def _grip(self, t_s: float, *, is_closed: bool) -> None:
        """From a time on open or close, unless it is so already."""
        goal = CLOSED_M if is_closed else OPEN_M
        track = self._track
        if not track.openings_m:
            track.grip_times_s.append(t_s)
            track.openings_m.append(goal)
        elif track.openings_m[-1] != goal:
            begin = max(t_s, track.grip_times_s[-1])
            track.grip_times_s += [begin, begin + _GRASP_S]
            track.openings_m += [track.openings_m[-1], goal]


def _along(points: FloatArray, share: float) -> FloatArray:
    """The point of a polyline, shape (n, 3), at a share of its way counted by corners."""
    corners = np.linspace(0.0, 1.0, len(points))
    return np.array([np.interp(share, corners, points[:, axis]) for axis in range(3)])
