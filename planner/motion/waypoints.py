"""Cut the motion of hands that hold cloth into waypoints: the tool poses that joint paths must meet.

A *transfer* is what happens between two times at which all hands are empty: a fold, a drag, or several primitives that
follow one another without letting go. Its phases are cut so finely that the base and the tools move and turn only a
little from one waypoint to the next.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray, Point3
from planner.geometry.tolerance import LENGTH_M
from planner.motion.phase_stretches import Stretch, StretchSampler, about_x, rolls_of
from planner.task.trajectory import Phase


@dataclass(frozen=True, slots=True, eq=False)
class Waypoints:
    """Waypoints in the order of time; n of them.

    Attributes:
        phases: index of the phase that each belongs to, shape (n,).
        fractions: the fraction of that phase that is done, shape (n,).
        bases: the base in the table frame: x (m), y (m), yaw (rad), shape (n, 3).
        positions: each arm's tool in the base frame, shape (arms, n, 3), m; nan while the hand is empty.
        rotations: the tool's axes as columns in the base frame, shape (arms, n, 3, 3); nan while the hand is empty.
        nominal_s: the time since the waypoint before at an even pace (s), shape (n,).
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
        """Whether each hand holds cloth at each waypoint, shape (arms, n)."""
        return ~np.isnan(self.positions[:, :, 0])

    @property
    def is_used(self) -> BoolArray:
        """Whether each arm holds cloth at some of the waypoints, shape (arms,)."""
        return np.asarray(self.is_held.any(axis=1))

    @property
    def is_last_held(self) -> BoolArray:
        """Whether each waypoint is the last at which a hand holds, shape (arms, n)."""
        return np.asarray(
            self.is_held & ~np.append(self.is_held[:, 1:], np.zeros((len(self.is_held), 1), bool), axis=1)
        )

    @property
    def is_still(self) -> BoolArray:
        """Whether no tool moves in the base frame from the waypoint before to the waypoint after, shape (n,)."""
        moved_m, turned = (np.abs(np.nan_to_num(np.diff(each, axis=1))) for each in (self.positions, self.rotations))
        stays = (moved_m.max(axis=(0, 2)) < LENGTH_M) & (turned.max(axis=(0, 2, 3)) < LENGTH_M)
        stays &= (self.is_held[:, 1:] == self.is_held[:, :-1]).all(axis=0)
        return np.asarray(np.append(False, stays) & np.append(stays, False))

    @property
    def progress(self) -> FloatArray:
        """The progress of the whole at each, 0 to 1, every phase counting the same, shape (n,)."""
        done = self.phases + self.fractions
        return np.asarray(done / max(float(done[-1]), 1.0))

    def __len__(self) -> int:
        return len(self.phases)


_MOMENTS_KEPT = 512
"""Waypoints kept, by phases, some 35 kB each: two for each transfer that is kept, at its ends and all."""

_NOWHERE: Point3 = (math.nan, math.nan, math.nan)
"""Where an empty hand counts as being."""


def waypoints_of(phases: Sequence[Phase], height_m: float, *, only_ends: bool = False) -> Waypoints:
    """Return the waypoints of phases in which no hand is reaching; they are kept and must not be changed.

    Where a hand that holds on is to take another orientation, it turns in its grip before that phase begins.

    Args:
        phases: the phases, one after the other.
        height_m: the table top's height above the floor (m).
        only_ends: whether only the beginning and the end of each phase are wanted.
    """
    return _known_waypoints(tuple(phases), height_m, only_ends)


def forget_waypoints() -> None:
    """Drop the waypoints that are kept, so that benchmarks measure their computation."""
    _known_waypoints.cache_clear()


@lru_cache(_MOMENTS_KEPT)
def _known_waypoints(phases: tuple[Phase, ...], height_m: float, only_ends: bool) -> Waypoints:
    """Return what `waypoints_of` does: plans of similar tasks, and restricted tasks, ask for the same again."""
    sampler = StretchSampler(len(phases[0].hands), only_ends)
    stretches = [stretch for number, phase in enumerate(phases) for stretch in sampler.stretches(number, phase)]
    lengths = [len(stretch.shares) for stretch in stretches]
    numbers = np.repeat([stretch.number for stretch in stretches], lengths)
    shares = np.concatenate([stretch.shares for stretch in stretches])
    ends = np.array([[(pose.x_m, pose.y_m, pose.yaw_rad) for pose in phase.base] for phase in phases])
    bases = ends[numbers, 0] + shares[:, None] * (ends[numbers, 1] - ends[numbers, 0])
    ways = [_positions_and_rotations(phases, stretches, arm, numbers, shares) for arm in range(len(phases[0].hands))]
    paces = np.concatenate([_paces(stretch.shares) for stretch in stretches])
    is_turning = np.repeat([stretch.turned is not None for stretch in stretches], lengths)
    return Waypoints(
        numbers,
        shares,
        bases,
        np.array([_in_base(bases, positions, height_m) for positions, _ in ways]),
        np.array([rotations for _, rotations in ways]),
        np.array([phase.duration_s for phase in phases])[numbers] * paces,
        np.array([phase.motion is None for phase in phases])[numbers] & ~is_turning,
    )


def _paces(shares: FloatArray) -> FloatArray:
    """Return the fraction of its phase that is done since the waypoint before, shape (n,)."""
    paces = shares.copy()
    paces[1:] -= shares[:-1]
    return paces


def _positions_and_rotations(
    phases: Sequence[Phase],
    stretches: Sequence[Stretch],
    arm: int,
    numbers: NDArray[np.int64],
    shares: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Return an arm's tool in the table frame, shape (n, 3), m, and its axes in the base frame.

    The axes are of shape (n, 3, 3); both are nan while the hand is empty.
    """
    if all(phase.hands[arm] is None for phase in phases):
        return np.full((len(shares), 3), np.nan), np.full((len(shares), 3, 3), np.nan)
    more = {stretch.number: stretch.rolls[arm] for stretch in stretches}
    points: list[Point3] = []
    rolls: list[float] = []
    firsts, lasts, axes = [], [], np.full((len(phases), 3, 3), np.nan)
    for number, phase in enumerate(phases):
        hand = phase.hands[arm]
        firsts.append(len(points))
        if hand is None:
            points.append(_NOWHERE)
            rolls.append(math.nan)
        else:
            points += hand.points
            beyond = more[number]
            rolls += [beyond + roll for roll in rolls_of(hand)] if beyond else rolls_of(hand)
            axes[number] = hand.approach.rotation
        lasts.append(len(points) - 1)
    first, last = np.array(firsts)[numbers], np.array(lasts)[numbers]
    at = shares * (last - first)
    before = np.floor(at).astype(np.int64)
    along, table = (at - before)[:, None], np.empty((len(points), 4))
    table[:, :3], table[:, 3] = points, rolls
    found = (1.0 - along) * table[first + before] + along * table[np.minimum(first + before + 1, last)]
    rotations = axes[numbers] @ about_x(found[:, 3])
    end = 0
    for stretch in stretches:
        end += len(stretch.shares)
        if stretch.turned is not None:
            rotations[end - len(stretch.shares) : end] = stretch.turned[arm]
    return found[:, :3], rotations


def _in_base(bases: FloatArray, points: FloatArray, height_m: float) -> FloatArray:
    """Return points of the table frame, each seen from its own base, both of shape (n, 3); z above the floor (m)."""
    cos, sin = np.cos(bases[:, 2]), np.sin(bases[:, 2])
    dx, dy = points[:, 0] - bases[:, 0], points[:, 1] - bases[:, 1]
    return np.column_stack([cos * dx + sin * dy, cos * dy - sin * dx, points[:, 2] + height_m])
