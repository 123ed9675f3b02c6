"""The tool paths of a transfer: straight to the grips, along the cloth's path, and straight away from it.

A hand comes to its grip along its approach axis, fingers first, and withdraws backwards and upwards. These lines are
part of the path, so that the joints with which a hand takes the cloth are also joints from which it can come and
withdraw.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.motion.hand_holds import HandHold, Holds, settles
from planner.motion.lying_cloth import NEAR_GRIP_M, LyingCloth
from planner.motion.phase_stretches import about_x
from planner.motion.polylines import lengths_along, resampled, stepped
from planner.motion.waypoints import Waypoints
from planner.robots.tool_path import ToolPath

APPROACH_M, RETREAT_M = 0.10, 0.12
"""The lengths of the straight lines to a grip and away from it, where they are within reach (m)."""

CLEAR_M = 0.12
"""The height above the table from which a hand travels, where that is within reach (m)."""

_STEP_M = 0.01
"""The distance between neighbouring steps on these lines (m)."""

Shares = tuple[tuple[float, float], ...]
"""Fractions of the straight line and of the rise, in the order in which they are tried."""

NEAR: Shares = ((0.2, 0.0), (0.0, 0.0))
"""The least that must do: hardly any straight line, and no rise."""

UP: Shares = ((0.2, 0.4), (0.0, 0.4), *NEAR)
"""A short line and some rise, which take hands clear of the cloth."""

FAR: Shares = ((1.0, 1.0), (0.5, 1.0), (1.0, 0.5), (0.5, 0.5), (0.2, 0.5), (0.0, 1.0), (1.0, 0.0), (0.5, 0.0), *NEAR)
"""The preferred ones: up to the whole line and the whole rise."""

HasRoom = Callable[[int, HandHold, FloatArray, FloatArray, FloatArray, LyingCloth | None], bool]
"""The test whether an arm can take a tool pose with open fingers, clear of the cloth.

Its arguments: the arm, how it holds, the base (x, y, yaw; table frame), the tool's position (m) and axes (base frame),
and the cloth on the table.
"""


Cloths = tuple[LyingCloth | None, LyingCloth]
"""The cloth on the table before a transfer and after it; None before one that begins with cloth in the hands."""


@dataclass(frozen=True, slots=True)
class ApproachLines:
    """The lines along which hands approach and withdraw.

    Attributes:
        holds: how they hold cloth.
        shares: the fractions of the line and of the rise to try; the first for which there is room is taken.
    """

    holds: Holds
    shares: Shares


@dataclass(frozen=True, slots=True, eq=False)
class TransferToolPath:
    """The tool path of one arm in a transfer, and its ways to the grip and from it.

    Attributes:
        arm: the arm.
        path: the tool path over all steps of the transfer; once withdrawn, the tool stays.
        from_grip_m: the way still to go to the grip, or gone since letting go (m); 0 while the hand holds, shape
            (steps,).
        let_go: the first step at which it no longer holds.
        is_coming: whether it takes the cloth, with open fingers; else it holds it from the first step on.
    """

    arm: int
    path: ToolPath
    from_grip_m: FloatArray
    let_go: int
    is_coming: bool

    def is_open(self, steps: NDArray[np.int64], *, opens_on_path: bool) -> BoolArray:
        """Return at which steps its fingers may be open: before the grip and after letting go.

        Fingers that open and close where the cloth's path begins and ends may be open there too.
        """
        begin, end = self.path.core
        return ((steps < begin + opens_on_path) & self.is_coming) | (steps >= end - opens_on_path)

    def must_clear(self, steps: NDArray[np.int64]) -> tuple[BoolArray, BoolArray]:
        """Return at which steps it must be clear of the cloth on the table, as it lies before and as it lies after."""
        is_far = self.from_grip_m[steps] > NEAR_GRIP_M
        return is_far & (steps < self.let_go), is_far & (steps >= self.let_go)


@dataclass(frozen=True, slots=True, eq=False)
class TransferToolPaths:
    """All arms' parts in a transfer.

    Attributes:
        each: the arms that take part.
        bases: the base at each step: x (m), y (m), yaw (rad), table frame, shape (steps, 3).
        first: the step at which the hands reach the grips. Where some hand opens and closes elsewhere, all do so at the
            step before it, and at the step after the last at which they hold.
    """

    each: tuple[TransferToolPath, ...]
    bases: FloatArray
    first: int

    @staticmethod
    def of(
        waypoints: Waypoints,
        lines: ApproachLines,
        rolls_rad: FloatArray,
        height_m: float,
        has_room: HasRoom,
        cloths: Cloths,
    ) -> "TransferToolPaths":
        """Return the parts of the arms that hold cloth at some of the waypoints.

        Args:
            waypoints: the waypoints while cloth is held.
            lines: how hands approach and withdraw.
            rolls_rad: the roll of each arm's hand about its approach axis (rad), shape (arms,).
            height_m: the table top's height above the floor (m).
            has_room: the test whether a hand has room.
            cloths: the cloth on the table before and after.
        """
        arms = np.flatnonzero(waypoints.is_held.any(axis=1))
        ways = [_way(int(arm), waypoints, lines, rolls_rad, height_m, has_room, cloths) for arm in arms]
        settling = int(settles(lines.holds))
        before = max(len(stepped(way.approach, _STEP_M)) for way in ways) - 1 + settling
        after = max(len(stepped(way.retreat, _STEP_M)) for way in ways) - 1 + settling
        start, end = waypoints.bases[:1].repeat(before, 0), waypoints.bases[-1:].repeat(after, 0)
        bases = np.concatenate([start, waypoints.bases, end])
        return TransferToolPaths(
            tuple(way.tool_path(before, after, len(bases), settling) for way in ways), bases, before
        )


@dataclass(frozen=True, slots=True, eq=False)
class _Way:
    """The tool path of one arm: to its grip, along the cloth's path, and away."""

    arm: int
    positions: FloatArray
    rotations: FloatArray
    spans_s: FloatArray
    approach: FloatArray
    retreat: FloatArray
    is_coming: bool

    def tool_path(self, before: int, after: int, steps: int, settling: int) -> TransferToolPath:
        """Return the tool path over `steps` steps: `before` to come, then the grip, `after` to withdraw, then rest.

        With `settling`, the last of those to come and the first to withdraw lead between the grip and where the fingers
        open and close.
        """
        kept = 1 - settling
        coming = resampled(stepped(self.approach, _STEP_M), before - settling)[kept:][::-1]
        leaving = resampled(stepped(self.retreat, _STEP_M), after - settling)[kept:]
        first, last = self.rotations[:1], self.rotations[-1:]
        rest = steps - before - len(self.positions)
        path = ToolPath(
            np.concatenate([coming, self.positions, leaving, leaving[-1:].repeat(rest - after, 0)]),
            np.concatenate([first.repeat(before, 0), self.rotations, last.repeat(rest, 0)]),
            np.concatenate([np.full(before, np.inf), self.spans_s, np.full(rest, np.inf)]),
            (before, before + len(self.positions)),
        )
        from_grip = np.zeros(steps)
        from_grip[:before] = lengths_along(path.positions[before::-1])[:0:-1]
        from_grip[steps - rest :] = lengths_along(path.positions[steps - rest - 1 :])[1:]
        return TransferToolPath(self.arm, path, from_grip, steps - rest, self.is_coming)


def rolled(roll_rad: float) -> FloatArray:
    """Return the rotation by which a hand rolls about its approach axis, shape (3, 3)."""
    return np.asarray(about_x(np.array([roll_rad]))[0])


def _way(
    arm: int,
    waypoints: Waypoints,
    lines: ApproachLines,
    rolls_rad: FloatArray,
    height_m: float,
    has_room: HasRoom,
    cloths: Cloths,
) -> _Way:
    held = np.flatnonzero(waypoints.is_held[arm])
    positions = waypoints.positions[arm, held]
    rotations = waypoints.rotations[arm, held] @ rolled(rolls_rad[arm])
    upwards = np.array([0.0, 0.0, 1.0])
    hold = lines.holds[arm]
    coming, leaving = -rotations[0, :, 0], -rotations[-1, :, 0]
    if not hold.is_narrow:  # else the lower finger slides back out from under the cloth
        leaving = leaving + upwards
    leaving *= RETREAT_M / np.linalg.norm(leaving)
    ends = []
    for number, line, cloth in ((0, APPROACH_M * coming, cloths[0]), (-1, leaving, cloths[1])):
        base, rotation, there = waypoints.bases[held[number]], rotations[number], positions[number]
        if number == 0 and cloth is None:
            ends.append(there[None].repeat(3, 0))
            continue
        there = there + hold.raised_m * upwards
        corners = _corners(there, line, lines.shares, height_m)
        able = (c for c in corners if has_room(arm, hold, base, c[-1], rotation, cloth if _is_far(c) else None))
        ends.append(next(able, there[None].repeat(3, 0)))
    spans = np.where(waypoints.is_driving, waypoints.nominal_s, np.inf)[held[1:]]
    approach, retreat = ends
    return _Way(arm, positions, rotations, spans, approach, retreat, cloths[0] is not None)


def _is_far(corners: FloatArray) -> bool:
    """Return whether a line leads so far from its grip that a hand at its end must be clear of cloth."""
    return float(lengths_along(corners)[-1]) > NEAR_GRIP_M


def _corners(position: FloatArray, line: FloatArray, shares: Shares, height_m: float) -> list[FloatArray]:
    """Return the corners of lines from a position along a direction and up, each of shape (3, 3), m."""
    far = position + np.array(shares)[:, :1] * line
    rises = np.maximum(height_m + CLEAR_M - far[:, 2], 0.0) * np.array(shares)[:, 1]
    tips = far + rises[:, None] * np.array([0.0, 0.0, 1.0])
    return [np.array([position, corner, tip]) for corner, tip in zip(far, tips, strict=True)]
