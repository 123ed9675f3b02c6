"""Cut phases into stretches of waypoints: each hand first turns in its grip where it must, then follows its path.

Waypoints are closer to each other where something moves or turns fast.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from planner.geometry.pose import Approach, FloatArray, wrapped_angle
from planner.geometry.tolerance import ANGLE_RAD, EDGE_RAD, LENGTH_M, nearest_whole
from planner.task.trajectory import Hand, Phase


@dataclass(frozen=True, slots=True, eq=False)
class Stretch:
    """Waypoints of one phase, in which hands turn in their grips or follow their paths.

    Attributes:
        number: index of the phase.
        shares: the fraction of the phase that is done, shape (n,).
        rolls: the roll of each hand beyond what its phase says (rad).
        turned: each arm's tool axes while it turns in its grip, shape (arms, n, 3, 3); None while it follows its path.
    """

    number: int
    shares: FloatArray
    rolls: tuple[float, ...]
    turned: FloatArray | None


@dataclass(frozen=True, slots=True)
class _Wrist:
    """The orientation of a hand: its approach, and its roll about that (rad)."""

    approach: Approach
    roll_rad: float

    def seen_with(self, heading_rad: float) -> "_Wrist":
        """Return the same orientation with another heading, for a hand that points straight down.

        The heading of such a hand is nothing but a roll.
        """
        turned = self.roll_rad + heading_rad - self.approach.heading_rad
        return _Wrist(Approach(heading_rad, self.approach.pitch_rad), turned)


class _Turn(NamedTuple):
    """Heading, pitch and roll (rad) of a hand before and after it turns in its grip."""

    start: tuple[float, float, float]
    goal: tuple[float, float, float]

    @property
    def angle_rad(self) -> float:
        """The angles by which it turns, added up (rad)."""
        return sum(abs(after - before) for before, after in zip(self.start, self.goal, strict=True))

    def rotations(self, shares: FloatArray) -> FloatArray:
        """Return the tool's axes in the base frame at shares of the turn, shape (n, 1) -> (n, 3, 3)."""
        start, goal = np.array(self.start), np.array(self.goal)
        angles = start + shares * (goal - start)
        axes = [Approach(heading_rad, pitch_rad).rotation for heading_rad, pitch_rad in angles[:, :2].tolist()]
        return np.asarray(np.array(axes) @ about_x(angles[:, 2]))


class StretchSampler:
    """Cuts phases into waypoints, knowing each hand's orientation at the end of the phase before."""

    def __init__(self, arms: int, only_ends: bool) -> None:
        self._only_ends = only_ends
        self._wrists: list[_Wrist | None] = [None] * arms
        self._rolls = [0.0] * arms

    def stretches(self, number: int, phase: Phase) -> Iterator[Stretch]:
        """Yield the turning in the grips, if there is any, and the path; its start only in the first phase."""
        turns = [self._turn(arm, hand) for arm, hand in enumerate(phase.hands)]
        angle = max((turn.angle_rad for turn in turns if turn is not None), default=0.0)
        rolls = tuple(self._rolls)
        if angle > ANGLE_RAD:
            parts = np.linspace(0.0, 1.0, int(np.ceil((angle - EDGE_RAD) / STEP_RAD)) + 1)[1:, None]
            turned = [np.full((len(parts), 3, 3), np.nan) if turn is None else turn.rotations(parts) for turn in turns]
            yield Stretch(number, np.zeros(len(parts)), rolls, np.array(turned))
        shares = np.array([0.0, 1.0]) if self._only_ends else shares_of(phase)
        yield Stretch(number, shares[1 if number else 0 :], rolls, None)
        for arm, hand in enumerate(phase.hands):
            self._wrists[arm] = None if hand is None else _Wrist(hand.approach, self._rolls[arm] + rolls_of(hand)[-1])

    def _turn(self, arm: int, hand: Hand | None) -> "_Turn | None":
        """Return how a hand turns in its grip.

        None for an empty hand. The hand keeps its roll, so that a hand with its fingers flat above the table stays so;
        the roll with which it goes on is settled here.
        """
        before = self._wrists[arm]
        if hand is None:
            self._rolls[arm] = 0.0
            return None
        after = hand.approach
        if before is None or before.approach == after:
            self._rolls[arm] = 0.0 if before is None else before.roll_rad - rolls_of(hand)[0]
            still = (after.heading_rad, after.pitch_rad, self._rolls[arm] + rolls_of(hand)[0])
            return _Turn(still, still)
        if before.approach.is_vertical:
            before = before.seen_with(after.heading_rad)
            level = math.pi * nearest_whole(before.roll_rad / math.pi)
            goal = _Wrist(after, before.roll_rad if after.is_vertical else level)
        elif after.is_vertical:
            goal = _Wrist(Approach(before.approach.heading_rad, after.pitch_rad), before.roll_rad)
        else:
            goal = _Wrist(after, before.roll_rad)
        self._rolls[arm] = goal.seen_with(after.heading_rad).roll_rad - rolls_of(hand)[0]
        start = (before.approach.heading_rad, before.approach.pitch_rad, before.roll_rad)
        turn = _turn_rad(before.approach.heading_rad, goal.approach.heading_rad)
        return _Turn(start, (start[0] + turn, goal.approach.pitch_rad, goal.roll_rad))


def _turn_rad(start_rad: float, goal_rad: float) -> float:
    """Return by how much a hand turns from one heading to another: the short way round, a half turn by way of ahead.

    Of two half turns the mirror image of a task must take the mirror image; behind there is the robot.
    """
    turn = wrapped_angle(goal_rad - start_rad)
    if abs(turn) < math.pi - EDGE_RAD or abs(math.sin(start_rad)) < EDGE_RAD:
        return turn
    towards = -math.copysign(1.0, math.sin(start_rad))
    return turn if turn * towards > 0.0 else turn + towards * math.tau


def rolls_of(hand: Hand) -> tuple[float, ...]:
    """Return the roll at each of a hand's points (rad)."""
    return hand.rolls_rad or (0.0,) * len(hand.points)


def about_x(angles_rad: FloatArray) -> FloatArray:
    """Return the rotations about the x axis, shape (n,) -> (n, 3, 3)."""
    turns = np.zeros((len(angles_rad), 3, 3))
    turns[:, 0, 0] = 1.0
    turns[:, 1, 1] = turns[:, 2, 2] = np.cos(angles_rad)
    turns[:, 2, 1] = np.sin(angles_rad)
    turns[:, 1, 2] = -turns[:, 2, 1]
    return turns


STEP_M = 0.01
"""The largest distance that a tool or the base goes from one moment to the next (m)."""

STEP_RAD = 0.05
"""The largest angle that a tool turns from one moment to the next (rad)."""


def shares_of(phase: Phase) -> FloatArray:
    """Return the fraction of a phase that is done at each of its waypoints, with even steps on each piece of its paths.

    The start is included. Some pieces need more steps than others: a hand near the fold line's end rolls there within a
    few centimetres. Cutting the whole phase as finely would take several times as many waypoints.

    Returns:
        Shape (n,), rising from 0 to 1.
    """
    hands = [hand for hand in phase.hands if hand is not None]
    pieces = max((len(hand.points) - 1 for hand in hands), default=1) or 1
    way = np.array([phase.base[1].x_m - phase.base[0].x_m, phase.base[1].y_m - phase.base[0].y_m, 0.0])
    drive = math.hypot(way[0], way[1])
    if all(len(hand.points) == 1 for hand in hands):
        count = max(math.ceil((drive - LENGTH_M) / STEP_M), 1)
        return np.arange(count + 1) / count
    wanted = np.full(pieces, (drive - LENGTH_M) / pieces / STEP_M)
    for hand in hands:
        if len(hand.points) > 1:
            points = np.array(hand.points)
            gone = points[1:] - points[:-1]
            # Over the table, and seen from the base, which drives meanwhile: a drag's tools rest on it.
            for seen in (gone, gone - way / len(gone)):
                _need(wanted, (np.sqrt((seen**2).sum(axis=1)) - LENGTH_M) / STEP_M)
        if len(hand.rolls_rad) > 1:
            rolls = np.array(hand.rolls_rad)
            _need(wanted, (np.abs(rolls[1:] - rolls[:-1]) - EDGE_RAD) / STEP_RAD)
    steps = np.maximum(np.ceil(wanted), 1.0).astype(np.int64)
    ends = steps.cumsum()
    each, whole = steps.repeat(steps), np.arange(pieces).repeat(steps)
    shares = np.zeros(int(ends[-1]) + 1)
    shares[1:] = (whole + (np.arange(1, len(shares)) - (ends - steps).repeat(steps)) / each) / pieces
    return shares


def _need(wanted: FloatArray, steps: FloatArray) -> None:
    """Raise the steps wanted in each piece of a phase to those that a hand needs in each piece of its path."""
    shared, rest = divmod(len(wanted), len(steps))
    each = (steps if shared == 1 else steps.repeat(shared) / shared) if rest == 0 else steps.max()
    np.maximum(wanted, each, out=wanted)
