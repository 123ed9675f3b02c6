"""The PR2's parts for collision checking, and the pairs of them that are compared.

A part moves as one rigid body. The arms are mirror images, so the parts of one arm serve for both.

All parts of the robot are compared, except where one carries the other over no more than `CARRIED_OVER` joints: the
meshes of such neighbours enclose each other, so that their convex hulls overlap (upper arm and torso in a third of all
postures) where the meshes never touch. The SRDF that comes with the description, made by sampling the meshes, lists no
such pair either. The fingers of one gripper are one part.
"""

from collections.abc import Iterator
from typing import NamedTuple

CARRIED_OVER = 3
"""Number of joints up to which a part is not compared with the part that carries it."""


class Part(NamedTuple):
    """A part.

    Attributes:
        name: its name for people.
        joint: the joint that moves it, without an arm's prefix; ``universe`` for what stands on the floor.
    """

    name: str
    joint: str


ARM_PARTS = (
    Part("shoulder", "shoulder_pan_joint"),
    Part("shoulder lift", "shoulder_lift_joint"),
    Part("upper arm", "upper_arm_roll_joint"),
    Part("elbow", "elbow_flex_joint"),
    Part("forearm", "forearm_roll_joint"),
    Part("wrist", "wrist_flex_joint"),
    Part("palm", "wrist_roll_joint"),
    Part("fingers", "gripper_l_finger_joint"),
    Part("fingertips", "gripper_l_finger_tip_joint"),
)
"""The parts of an arm from the shoulder outwards; each carries the next over one joint."""

ELBOW, PALM, FINGERS, FINGERTIPS = 3, 6, 7, 8
"""Indices of an arm's parts; from the palm on they are one rigid body while the fingers do not move."""

BODY_PARTS = (
    Part("base", "universe"),
    Part("torso", "torso_lift_joint"),
    Part("neck", "head_pan_joint"),
    Part("head", "head_tilt_joint"),
    Part("laser", "laser_tilt_mount_joint"),
)

_CARRIERS = {0: 2, 1: 1}
"""For each body part that carries the arms, the number of joints over which it carries a shoulder."""


def pairs_in_arm() -> Iterator[tuple[int, int]]:
    """Yield the pairs of parts of one arm that are compared."""
    for outer in range(len(ARM_PARTS)):
        yield from ((outer, inner) for inner in range(outer - CARRIED_OVER))


def pairs_with_body() -> Iterator[tuple[int, int]]:
    """Yield the pairs of an arm's part and a body part that are compared."""
    for outer in range(len(ARM_PARTS)):
        for number in range(len(BODY_PARTS)):
            if number not in _CARRIERS or outer + _CARRIERS[number] > CARRIED_OVER:
                yield outer, number
