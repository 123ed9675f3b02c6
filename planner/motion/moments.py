"""Cut the motion of hands that hold cloth into moments: the tool poses that joint paths must meet.

A *transfer* is what happens between two times at which all hands are empty: a fold, a drag, or several primitives that
follow one another without letting go. Its phases are cut so finely that the base and the tools move and turn only a
little from one moment to the next.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from planner.geometry.pose import Approach, BoolArray, FloatArray, wrapped_angle
from planner.geometry.tolerance import ANGLE_RAD, EDGE_RAD, nearest_whole
from planner.motion.phase_shares import STEP_RAD, shares_of
from planner.task.phase import Hand, Phase


@dataclass(frozen=True, slots=True, eq=False)
class Moments:
    """Moments in the order of time; n of them.

    Attributes:
        phases: index of the phase that each belongs to, shape (n,).
        fractions: the fraction of that phase that is done, shape (n,).
        bases: the base in the table frame: x (m), y (m), yaw (rad), shape (n, 3).
        positions: each arm's tool in the base frame, shape (arms, n, 3), m; nan while the hand is empty.
        rotations: the tool's axes as columns in the base frame, shape (arms, n, 3, 3); nan while the hand is empty.
        nominal_s: the time since the moment before at an even pace (s), shape (n,).
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
        """Whether each hand holds cloth at each moment, shape (arms, n)."""
        return ~np.isnan(self.positions[:, :, 0])

    @property
    def is_used(self) -> BoolArray:
        """Whether each arm holds cloth at some of the moments, shape (arms,)."""
        return np.asarray(self.is_held.any(axis=1))

    @property
    def is_last_held(self) -> BoolArray:
        """Whether each hand holds for the last time at each moment, shape (arms, n)."""
        return np.asarray(
            self.is_held & ~np.append(self.is_held[:, 1:], np.zeros((len(self.is_held), 1), bool), axis=1)
        )

    @property
    def progress(self) -> FloatArray:
        """The progress of the whole at each, 0 to 1, every phase counting the same, shape (n,)."""
        done = self.phases + self.fractions
        return np.asarray(done / max(float(done[-1]), 1.0))

    def __len__(self) -> int:
        """Return the number of moments."""
        return len(self.phases)


def moments_of(phases: Sequence[Phase], height_m: float, *, only_ends: bool = False) -> Moments:
    """Return the moments of phases in which no hand is reaching.

    Where a hand that holds on is to take another orientation, it turns in its grip before that phase begins.

    Args:
        phases: the phases, one after the other.
        height_m: the table top's height above the floor (m).
        only_ends: whether only the beginning and the end of each phase are wanted.
    """
    sampler = _Sampler(len(phases[0].hands), only_ends)
    stretches = [stretch for number, phase in enumerate(phases) for stretch in sampler.stretches(number, phase)]
    lengths = [len(stretch.shares) for stretch in stretches]
    numbers = np.repeat([stretch.number for stretch in stretches], lengths)
    shares = np.concatenate([stretch.shares for stretch in stretches])
    ends = np.array([[(pose.x_m, pose.y_m, pose.yaw_rad) for pose in phase.base] for phase in phases])
    bases = ends[numbers, 0] + shares[:, None] * (ends[numbers, 1] - ends[numbers, 0])
    ways = [_positions_and_rotations(phases, stretches, arm, numbers, shares) for arm in range(len(phases[0].hands))]
    paces = np.concatenate([np.diff(stretch.shares, prepend=0.0) for stretch in stretches])
    is_turning = np.repeat([stretch.turned is not None for stretch in stretches], lengths)
    return Moments(
        numbers,
        shares,
        bases,
        np.array([_in_base(bases, positions, height_m) for positions, _ in ways]),
        np.array([rotations for _, rotations in ways]),
        np.array([phase.duration_s for phase in phases])[numbers] * paces,
        np.array([phase.motion is None for phase in phases])[numbers] & ~is_turning,
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Stretch:
    """Moments of one phase, of its turning in the grips or of its path.

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


class _Sampler:
    """Cuts phases into moments, knowing each hand's orientation at the end of the phase before."""

    def __init__(self, arms: int, only_ends: bool) -> None:
        self._only_ends = only_ends
        self._wrists: list[_Wrist | None] = [None] * arms
        self._rolls = [0.0] * arms

    def stretches(self, number: int, phase: Phase) -> Iterator[_Stretch]:
        """Yield the turning in the grips, if there is any, and the path; its start only in the first phase."""
        turns = [self._turn(arm, hand) for arm, hand in enumerate(phase.hands)]
        angles = [float(np.abs(turn[1] - turn[0]).sum()) for turn in turns if turn is not None]
        angle = max(angles, default=0.0)
        rolls = tuple(self._rolls)
        if angle > ANGLE_RAD:
            parts = np.linspace(0.0, 1.0, int(np.ceil((angle - EDGE_RAD) / STEP_RAD)) + 1)[1:, None]
            turned = [
                np.full((len(parts), 3, 3), np.nan)
                if turn is None
                else _rotations(turn[0] + parts * (turn[1] - turn[0]))
                for turn in turns
            ]
            yield _Stretch(number, np.zeros(len(parts)), rolls, np.array(turned))
        shares = np.array([0.0, 1.0]) if self._only_ends else shares_of(phase)
        yield _Stretch(number, shares[1 if number else 0 :], rolls, None)
        for arm, hand in enumerate(phase.hands):
            self._wrists[arm] = None if hand is None else _Wrist(hand.approach, self._rolls[arm] + _rolls(hand)[-1])

    def _turn(self, arm: int, hand: Hand | None) -> FloatArray | None:
        """Return heading, pitch and roll (rad) of a hand before and after it turns in its grip, shape (2, 3).

        None for an empty hand. The hand keeps its roll, so that a hand with its fingers flat above the table stays so;
        the roll with which it goes on is settled here.
        """
        before = self._wrists[arm]
        if hand is None:
            self._rolls[arm] = 0.0
            return None
        after = hand.approach
        if before is None or before.approach == after:
            self._rolls[arm] = 0.0 if before is None else before.roll_rad - _rolls(hand)[0]
            return np.array([(after.heading_rad, after.pitch_rad, self._rolls[arm] + _rolls(hand)[0])] * 2)
        if before.approach.is_vertical:
            before = before.seen_with(after.heading_rad)
            level = math.pi * nearest_whole(before.roll_rad / math.pi)
            goal = _Wrist(after, before.roll_rad if after.is_vertical else level)
        elif after.is_vertical:
            goal = _Wrist(Approach(before.approach.heading_rad, after.pitch_rad), before.roll_rad)
        else:
            goal = _Wrist(after, before.roll_rad)
        self._rolls[arm] = goal.seen_with(after.heading_rad).roll_rad - _rolls(hand)[0]
        start = (before.approach.heading_rad, before.approach.pitch_rad, before.roll_rad)
        turn = wrapped_angle(goal.approach.heading_rad - before.approach.heading_rad)
        return np.array([start, (start[0] + turn, goal.approach.pitch_rad, goal.roll_rad)])


def _positions_and_rotations(
    phases: Sequence[Phase],
    stretches: Sequence[_Stretch],
    arm: int,
    numbers: NDArray[np.int64],
    shares: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Return an arm's tool in the table frame, shape (n, 3), m, and its axes in the base frame.

    The axes are of shape (n, 3, 3); both are nan while the hand is empty.
    """
    more = {stretch.number: stretch.rolls[arm] for stretch in stretches}
    corners: list[tuple[float, ...]] = []
    firsts, lasts, axes = [], [], np.full((len(phases), 3, 3), np.nan)
    for number, phase in enumerate(phases):
        hand = phase.hands[arm]
        firsts.append(len(corners))
        if hand is None:
            corners.append((math.nan,) * 4)
        else:
            rolls = (more[number] + roll for roll in _rolls(hand))
            corners += [(*point, roll) for point, roll in zip(hand.points, rolls, strict=True)]
            axes[number] = hand.approach.rotation
        lasts.append(len(corners) - 1)
    first, last = np.array(firsts)[numbers], np.array(lasts)[numbers]
    at = shares * (last - first)
    before = np.floor(at).astype(np.int64)
    along, table = (at - before)[:, None], np.array(corners)
    found = (1.0 - along) * table[first + before] + along * table[np.minimum(first + before + 1, last)]
    rotations = axes[numbers] @ about_x(found[:, 3])
    start = 0
    for stretch in stretches:
        end = start + len(stretch.shares)
        if stretch.turned is not None:
            rotations[start:end] = stretch.turned[arm]
        start = end
    return found[:, :3], rotations


def _in_base(bases: FloatArray, points: FloatArray, height_m: float) -> FloatArray:
    """Return points of the table frame, each seen from its own base, both of shape (n, 3); z above the floor (m)."""
    cos, sin = np.cos(bases[:, 2]), np.sin(bases[:, 2])
    dx, dy = points[:, 0] - bases[:, 0], points[:, 1] - bases[:, 1]
    return np.column_stack([cos * dx + sin * dy, cos * dy - sin * dx, points[:, 2] + height_m])


def about_x(angles_rad: FloatArray) -> FloatArray:
    """Return the rotations about the x axis, shape (n,) -> (n, 3, 3)."""
    turns = np.zeros((len(angles_rad), 3, 3))
    turns[:, 0, 0] = 1.0
    turns[:, 1, 1] = turns[:, 2, 2] = np.cos(angles_rad)
    turns[:, 2, 1] = np.sin(angles_rad)
    turns[:, 1, 2] = -turns[:, 2, 1]
    return turns


def _rotations(angles_rad: FloatArray) -> FloatArray:
    """Return the tool's axes in the base frame for headings, pitches and rolls, shape (n, 3) -> (n, 3, 3)."""
    return np.asarray(Rotation.from_euler("ZYX", angles_rad).as_matrix())


def _rolls(hand: Hand) -> tuple[float, ...]:
    """Return the roll at each of a hand's points (rad)."""
    return hand.rolls_rad or (0.0,) * len(hand.points)
