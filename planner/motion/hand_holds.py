"""How hands hold cloth: their roll, and with it where the fingers are.

With one finger under the cloth and one over it a hand holds its edge (kind ``edge``). It opens a little only, and opens
and closes at the height at which the lower finger just clears the table: there is room for no more. Where gripper or
joints do not allow that, both fingers come from above and close along the table (kind ``top``).
"""

import math
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from planner.folds.fold_path import REST_HEIGHT_M
from planner.geometry.tolerance import ANGLE_RAD, LENGTH_M
from planner.motion.joint_trajectory import CLOSED_M, OPEN_M
from planner.motion.waypoints import Waypoints
from planner.robots.armed_robot import ArmedRobot
from planner.robots.card import EDGE_OPEN_M, HELD_M, OPENING_M
from planner.task.world_state import GripKind

OVER, BESIDE = 0.5 * math.pi, 0.0
"""The roll of a hand with one finger above the other, and with both side by side (rad)."""

_STEEP = 0.6
"""The sine of the pitch from which a hand that opens widely may have one finger above the other.

The lower finger of a hand that points down less steeply would be pushed into the table.
"""

_SETTLING = 0.2
"""The share of a rest in which hands go from where their fingers close to their path, or from there to where they open.

Nothing is opened or closed meanwhile.
"""

_DIGITS = 9
"""Decimals of a pitch (rad): what remains is rounding."""


@dataclass(frozen=True, slots=True)
class HandHold:
    """How one hand holds cloth.

    Attributes:
        roll_rad: its roll about its approach axis (rad); a mirrored arm's hand rolls the other way.
        kind: how its fingers hold.
        opening_m: how far its fingers open (m).
        raised_m: how far above its path it opens and closes (m); negative: below.
    """

    roll_rad: float
    kind: GripKind = "top"
    opening_m: float = OPEN_M
    raised_m: float = 0.0

    @property
    def is_narrow(self) -> bool:
        """Whether its fingers open so little that one of them fits between cloth and table."""
        return self.opening_m <= EDGE_OPEN_M

    @property
    def held_m(self) -> float:
        """How far its fingers are open while they hold (m)."""
        return HELD_M if self.is_narrow else CLOSED_M


Holds: TypeAlias = tuple[HandHold, ...]
"""How the hand of each arm holds."""

_BESIDE, _NARROWLY = HandHold(BESIDE), HandHold(BESIDE, opening_m=EDGE_OPEN_M)


def usual_holds(waypoints: Waypoints, height_m: float) -> tuple[Holds, ...]:
    """Return the ways in which hands may hold cloth in a transfer, the best first.

    Hands open widely; between hanging cloth and the table's edge there may be room for narrowly opened fingers only.

    Args:
        waypoints: the waypoints while cloth is held.
        height_m: the table top's height above the floor (m).
    """
    beside = tuple(
        _NARROWLY if is_used and _hangs(waypoints, arm, height_m) else _BESIDE
        for arm, is_used in enumerate(waypoints.is_used.tolist())
    )
    return (*_wide_holds(waypoints), *([beside] if _NARROWLY in beside else []))


def _hangs(waypoints: Waypoints, arm: int, height_m: float) -> bool:
    """Return whether a hand takes or lets go of cloth that hangs: lower than tools rest over the table."""
    held = waypoints.positions[arm, waypoints.is_held[arm]]
    return bool(held[[0, -1], 2].min() < height_m + REST_HEIGHT_M - LENGTH_M)


def _wide_holds(waypoints: Waypoints) -> tuple[Holds, ...]:
    beside = (_BESIDE,) * len(waypoints.is_used)
    sines = [-waypoints.rotations[arm, 0, 2, 0] for arm in np.flatnonzero(waypoints.is_used)]
    if not all(sine > _STEEP for sine in sines):
        return (beside,)
    kinds: list[GripKind] = ["edge" if _pitch_rad(waypoints, arm) < _VERTICAL else "top" for arm in range(len(beside))]
    return tuple(HandHold(OVER, kind) for kind in kinds), beside


def edge_holds(machine: ArmedRobot, waypoints: Waypoints) -> Holds | None:
    """Return how hands hold in a transfer if all that can have one finger under the cloth, where some can.

    A hand that opens before others let go has no time of its own to go where it has room for that.
    """
    if not waypoints.is_last_held[waypoints.is_used, -1].all():
        return None
    found = tuple(
        _edge_hold(machine, arm, waypoints) if is_used else _BESIDE
        for arm, is_used in enumerate(waypoints.is_used.tolist())
    )
    return found if any(hold.is_narrow for hold in found) else None


def _edge_hold(machine: ArmedRobot, arm: int, waypoints: Waypoints) -> HandHold:
    pitch_rad = _pitch_rad(waypoints, arm)
    raised_m = None if pitch_rad >= _VERTICAL else machine.edge_raised_m(arm, REST_HEIGHT_M, round(pitch_rad, _DIGITS))
    return _BESIDE if raised_m is None else HandHold(OVER, "edge", EDGE_OPEN_M, raised_m)


_VERTICAL = math.pi / 2 - math.sqrt(ANGLE_RAD)
"""The pitch from which a hand points straight down (rad)."""


def _pitch_rad(waypoints: Waypoints, arm: int) -> float:
    """Return how far below the horizontal a hand points when it first holds (rad); nan where it never does."""
    x, y, z = waypoints.rotations[arm, int(np.argmax(waypoints.is_held[arm])), :, 0].tolist()
    return math.atan2(-z, math.hypot(x, y))


def opening_of(hold: HandHold) -> float:
    """Return how far fingers are open at most on the way to their grip or from it (m)."""
    return hold.opening_m if hold.is_narrow else OPENING_M


def settling_s(dwell_s: float) -> float:
    """Return the time in which hands settle, as a part of a rest (s)."""
    return _SETTLING * dwell_s


def settles(holds: Holds) -> bool:
    """Return whether some hand opens and closes elsewhere than its path begins and ends."""
    return any(hold.raised_m != 0.0 for hold in holds)
