"""The directions from which a gripper of the PR2 may pinch cloth: few enough to be tested one by one.

The fan is symmetric: the left arm can do in an approach's mirror image what the right arm can do in the approach.
"""

import math

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import Approach

_PITCHES_DEG = (15, 30, 45, 60)
_HEADINGS_DEG = range(-90, 91, 15)

APPROACHES = (
    *(Approach(math.radians(heading), math.radians(pitch)) for pitch in _PITCHES_DEG for heading in _HEADINGS_DEG),
    Approach(0.0, math.pi / 2),
)
"""Directions from which a gripper may pinch: a fan at four pitches, and straight down."""


def mirror_images() -> NDArray[np.int64]:
    """Return for each approach the index of its mirror image, shape (len(APPROACHES),)."""
    fan = len(_HEADINGS_DEG)
    inner = [index - index % fan + fan - 1 - index % fan for index in range(len(APPROACHES) - 1)]
    return np.array([*inner, len(APPROACHES) - 1], dtype=np.int64)
