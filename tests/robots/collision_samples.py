"""Postures for the tests of collisions."""

import numpy as np

from planner.geometry.pose import FloatArray, Pose2
from planner.robots.pr2.arm import MIRROR
from tests.robots.model import random_joints, the_pr2

ROBOT = the_pr2()
CARD = ROBOT.card
HOME = np.array([ROBOT.home(0), ROBOT.home(1)])
FAR = Pose2(-5.0, 0.0, 0.0)
"""A base that stands nowhere near the table."""

FRONT = Pose2(-0.95, 0.0, 0.0)
TORSO_M = 0.29


def random_postures(count: int, seed: int) -> FloatArray:
    """Return all arms' joints anywhere within their limits, shape (count, 2, 7)."""
    rng = np.random.default_rng(seed)
    return np.array([[random_joints(CARD, arm, rng) for arm in (0, 1)] for _ in range(count)])


def with_left(*joints: float) -> FloatArray:
    """Return the left arm's joints with the right arm at home, shape (2, 7)."""
    return np.array([joints, HOME[1]])


def both(*joints: float) -> FloatArray:
    """Return the left arm's joints with the right arm as their mirror image, shape (2, 7)."""
    return np.array([joints, np.array(joints) * MIRROR])
