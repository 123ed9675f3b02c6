"""The roll of a hand about its approach axis, given by the last joint where that turns about the axis. Compiled."""

import math

import numpy as np

from planner.geometry.pose import FloatArray
from planner.kernels import kernel
from planner.robots.chain import PITCH, Chain, Scratch, forward

_ALONG = 0.999
"""The last joint gives the roll where the cosine between its axis and the approach axis is at least this."""

_BLENDED = 2.0
"""The heading counts fully for the roll where the approach axis is less than acos(1/2), 60 degrees, steep."""


@kernel
def gives_roll(chain: Chain) -> bool:
    """Return whether the last joint turns the hand about its approach axis."""
    return not chain.is_prismatic[-1] and abs(chain.tool_rotation[2, 0]) >= _ALONG


@kernel
def turn_to_roll(chain: Chain, rotation: FloatArray, more: float, joints: FloatArray, scratch: Scratch) -> bool:
    """Set the last joint to the roll of a tool pose and an angle more; return whether its limits allow that.

    Where they do not, the joint is set to the nearer limit. For arms that have another heading than the pose see
    `roll_left`.
    """
    forward(chain, joints, scratch)
    roll = roll_left(rotation, chain.rows == PITCH, scratch.frame) + more
    last, low, high = len(joints) - 1, chain.low[-1], chain.high[-1]
    middle = 0.5 * (low + high)
    wanted = joints[last] + (roll if chain.tool_rotation[2, 0] > 0.0 else -roll)
    wanted -= math.tau * math.floor((wanted - middle) / math.tau + 0.5)
    joints[last] = min(max(wanted, low), high)
    return bool(low <= wanted <= high)


@kernel
def roll_left(rotation: FloatArray, with_heading: bool, frame: FloatArray) -> float:
    """Return by how much a hand must roll about its own approach axis to have the roll of a rotation (rad).

    With a heading of its own a hand has the roll that the rotation has once it is turned about the vertical; pointing
    straight down, where headings mean nothing, once it is tilted the shortest way.
    """
    ahead, wanted, closing = frame[:, 0], rotation[:, 0], rotation[:, 1]
    across = np.cross(wanted, ahead)
    cosine = wanted[0] * ahead[0] + wanted[1] * ahead[1] + wanted[2] * ahead[2]
    tilted = closing + np.cross(across, closing) + np.cross(across, np.cross(across, closing)) / max(1.0 + cosine, 1e-9)
    roll = roll_between(frame, tilted)
    level = math.hypot(wanted[0], wanted[1])
    if with_heading and level > 1e-9:
        turn = math.atan2(ahead[1], ahead[0]) - math.atan2(wanted[1], wanted[0])
        c, s = math.cos(turn), math.sin(turn)
        turned = np.array([c * closing[0] - s * closing[1], s * closing[0] + c * closing[1], closing[2]])
        more = roll_between(frame, turned) - roll
        more -= math.tau * math.floor(more / math.tau + 0.5)
        roll += min(1.0, _BLENDED * level) * more
    return roll


@kernel
def roll_between(frame: FloatArray, closing: FloatArray) -> float:
    """Return the angle from a frame's y axis to a direction, about its x axis (rad)."""
    along = frame[0, 1] * closing[0] + frame[1, 1] * closing[1] + frame[2, 1] * closing[2]
    aside = frame[0, 2] * closing[0] + frame[1, 2] * closing[1] + frame[2, 2] * closing[2]
    return math.atan2(aside, along)
