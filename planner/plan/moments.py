"""What hands do while they hold cloth, moment by moment: the questions that joint paths must answer.

A *run* is what happens between two times at which all hands are free: a fold, a drag, or several primitives that follow
one another without letting go. Its phases are cut into moments so close together that the base goes, a tool goes and
a tool turns but a little from one to the next.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from planner.geometry.pose import Approach, BoolArray, FloatArray, wrapped_angle
from planner.geometry.tolerance import ANGLE_RAD
from planner.primitives.phase import Hand, Phase

STEP_M = 0.01
"""How far a tool or the base goes from one moment to the next at most (m)."""

STEP_RAD = 0.05
"""How far a tool turns from one moment to the next at most (rad)."""


@dataclass(frozen=True, slots=True, eq=False)
class Moments:
    """Moments in the order of time; n of them.

    Attributes:
        phases: index of the phase that each belongs to, shape (n,).
        fractions: how much of that phase is done, shape (n,).
        bases: where the base stands, table frame: x (m), y (m), yaw (rad), shape (n, 3).
        positions: each arm's tool in the base frame, shape (arms, n, 3), m; nan while the hand is free.
        rotations: the tool's axes as columns in the base frame, shape (arms, n, 3, 3); nan while the hand is free.
        nominal_s: how long after the moment before each is at an even pace (s), shape (n,).
        is_driving: whether the base drives on the way to each, which cannot be hurried, shape (n,).
    """

    phases: NDArray[np.int64]
    fractions: FloatArray
    bases: FloatArray
    positions: FloatArray
    rotations: FloatArray
    nominal_s: FloatArray
    is_driving: BoolArray

    @property
    def is_held(self) -> BoolArray:
        """Which hands hold cloth when, shape (arms, n)."""
        return ~np.isnan(self.positions[:, :, 0])

    def __len__(self) -> int:
        """How many there are."""
        return len(self.phases)


def moments_of(phases: Sequence[Phase], height_m: float) -> Moments:
    """The moments of phases in which no hand is reaching.

    Where a hand that holds on is to take another orientation, it turns in its grip before that phase begins.

    Args:
        phases: what happens, one phase after the other.
        height_m: the table top's height over the floor.
    """
    sampler = _Sampler(height_m, len(phases[0].hands))
    parts = [part for number, phase in enumerate(phases) for part in sampler.parts(number, phase)]
    return Moments(
        np.concatenate([part.phases for part in parts]),
        np.concatenate([part.fractions for part in parts]),
        np.concatenate([part.bases for part in parts]),
        np.concatenate([part.positions for part in parts], axis=1),
        np.concatenate([part.rotations for part in parts], axis=1),
        np.concatenate([part.nominal_s for part in parts]),
        np.concatenate([part.is_driving for part in parts]),
    )


@dataclass(frozen=True, slots=True)
class _Wrist:
    """How a hand is turned: its approach, and its roll about that (rad)."""

    approach: Approach
    roll_rad: float

    def seen_with(self, heading_rad: float) -> "_Wrist":
        """The same for a hand that points straight down, whose heading is nothing but a roll."""
        turned = self.roll_rad + heading_rad - self.approach.heading_rad
        return _Wrist(Approach(heading_rad, self.approach.pitch_rad), turned)


class _Sampler:
    """Cuts phases into moments; knows how each hand was turned at the end of the phase before."""

    def __init__(self, height_m: float, arms: int) -> None:
        self._height_m = height_m
        self._wrists: list[_Wrist | None] = [None] * arms
        self._rolls = [0.0] * arms

    def parts(self, number: int, phase: Phase) -> Iterator[Moments]:
        """The turning in the grips, if there is any, and the phase; its start only if nothing went before."""
        turns = [self._turn(arm, hand) for arm, hand in enumerate(phase.hands)]
        angle = max(float(np.abs(turn[1] - turn[0]).sum()) for turn in turns)
        if angle > ANGLE_RAD:
            shares = np.linspace(0.0, 1.0, int(np.ceil(angle / STEP_RAD)) + 1)[1:]
            part = self._part(number, phase, np.zeros(len(shares)))
            turned = np.array([_rotations(*(start + shares[:, None] * (end - start)).T) for start, end in turns])
            is_held = part.is_held[:, :, None, None]
            yield replace(
                part, rotations=np.where(is_held, turned, np.nan), is_driving=np.zeros(len(shares), dtype=bool)
            )
        part = self._part(number, phase, np.linspace(0.0, 1.0, _count(phase) + 1)[1 if number else 0 :])
        for arm, hand in enumerate(phase.hands):
            self._wrists[arm] = None if hand is None else _Wrist(hand.approach, self._rolls[arm] + _rolls(hand)[-1])
        yield part

    def _turn(self, arm: int, hand: Hand | None) -> FloatArray:
        """Heading, pitch and roll (rad) of a hand before and after it turns in its grip, shape (2, 3).

        It keeps its roll, so that a hand with its fingers flat over the table stays so; the roll with which it goes on
        is settled here.
        """
        before = self._wrists[arm]
        if hand is None or before is None:
            self._rolls[arm] = 0.0
            return np.zeros((2, 3))
        after = hand.approach
        if before.approach.is_vertical:
            before = before.seen_with(after.heading_rad)
            goal = _Wrist(after, before.roll_rad if after.is_vertical else math.pi * round(before.roll_rad / math.pi))
        elif after.is_vertical:
            goal = _Wrist(Approach(before.approach.heading_rad, after.pitch_rad), before.roll_rad)
        else:
            goal = _Wrist(after, before.roll_rad)
        self._rolls[arm] = goal.seen_with(after.heading_rad).roll_rad - _rolls(hand)[0]
        start = (before.approach.heading_rad, before.approach.pitch_rad, before.roll_rad)
        turn = wrapped_angle(goal.approach.heading_rad - before.approach.heading_rad)
        return np.array([start, (start[0] + turn, goal.approach.pitch_rad, goal.roll_rad)])

    def _part(self, number: int, phase: Phase, shares: FloatArray) -> Moments:
        ends = np.array([[pose.x_m, pose.y_m, pose.yaw_rad] for pose in phase.base])
        bases = ends[0] + shares[:, None] * (ends[1] - ends[0])
        count, arms = len(shares), len(phase.hands)
        positions, rotations = np.full((arms, count, 3), np.nan), np.full((arms, count, 3, 3), np.nan)
        for arm, hand in enumerate(phase.hands):
            if hand is not None:
                positions[arm] = self._in_base(bases, _along(np.array(hand.points), shares))
                rolls = self._rolls[arm] + _along(_rolls(hand)[:, None], shares)[:, 0]
                rotations[arm] = hand.approach.rotation @ about_x(rolls)
        nominal_s = phase.duration_s * np.diff(shares, prepend=0.0)
        is_driving = np.full(count, phase.motion is None)
        return Moments(np.full(count, number), shares, bases, positions, rotations, nominal_s, is_driving)

    def _in_base(self, bases: FloatArray, points: FloatArray) -> FloatArray:
        """Points of the table frame, each seen from its own base, both of shape (n, 3); z over the floor (m)."""
        cos, sin = np.cos(bases[:, 2]), np.sin(bases[:, 2])
        dx, dy = points[:, 0] - bases[:, 0], points[:, 1] - bases[:, 1]
        return np.column_stack([cos * dx + sin * dy, cos * dy - sin * dx, points[:, 2] + self._height_m])


def about_x(angles_rad: FloatArray) -> FloatArray:
    """The rotations about the x axis, shape (n,) -> (n, 3, 3)."""
    turns = np.zeros((len(angles_rad), 3, 3))
    turns[:, 0, 0] = 1.0
    turns[:, 1, 1] = turns[:, 2, 2] = np.cos(angles_rad)
    turns[:, 2, 1] = np.sin(angles_rad)
    turns[:, 1, 2] = -turns[:, 2, 1]
    return turns


def _rotations(headings_rad: FloatArray, pitches_rad: FloatArray, rolls_rad: FloatArray) -> FloatArray:
    """The tool's axes as columns in the base frame, shape (n, 3, 3); see `Approach.rotation`."""
    angles = np.column_stack([headings_rad, pitches_rad, rolls_rad])
    return np.asarray(Rotation.from_euler("ZYX", angles).as_matrix())


def _count(phase: Phase) -> int:
    """Into how many steps a phase is cut: a whole multiple of the steps of its hands' polylines."""
    hands = [hand for hand in phase.hands if hand is not None]
    corners = max((len(hand.points) - 1 for hand in hands), default=1) or 1
    drive = np.hypot(phase.base[1].x_m - phase.base[0].x_m, phase.base[1].y_m - phase.base[0].y_m)
    wanted = [float(drive) / STEP_M, 1.0]
    for hand in hands:
        steps = np.linalg.norm(np.diff(np.array(hand.points), axis=0), axis=1)
        wanted.append(float(steps.max(initial=0.0)) * len(steps) / STEP_M)
        wanted.append(float(np.abs(np.diff(_rolls(hand))).max(initial=0.0)) * len(steps) / STEP_RAD)
    return corners * int(np.ceil(max(wanted) / corners - ANGLE_RAD))


def _rolls(hand: Hand) -> FloatArray:
    """The roll at each of a hand's points (rad), shape (points,)."""
    return np.array(hand.rolls_rad) if hand.rolls_rad else np.zeros(len(hand.points))


def _along(corners: FloatArray, shares: FloatArray) -> FloatArray:
    """What a polyline, shape (m, k), is at shares of its way counted by corners, shape (n,) -> (n, k)."""
    places = np.linspace(0.0, 1.0, len(corners))
    return np.column_stack([np.interp(shares, places, column) for column in corners.T])
