"""The displacements of a place out of reach that are tried to bring it into reach."""

import math

import numpy as np

from planner.geometry.pose import FloatArray
from planner.geometry.reach_query import Cause

FURTHEST_M = 0.8
"""Largest displacement tried (m)."""

_SIDEWAYS = 0.1
"""Fraction of a displacement below which its change of the distance to the shoulder counts as sideways."""

STRAIGHT = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (-1.0, 0.0, 0.0), (0.0, -1.0, 0.0))
_SLANTING = tuple((x * math.sqrt(0.5), y * math.sqrt(0.5), 0.0) for x in (1.0, -1.0) for y in (1.0, -1.0))
DIRECTIONS = np.array((*STRAIGHT, *_SLANTING, (0.0, 0.0, -1.0), (0.0, 0.0, 1.0)))
"""Directions in which a point is displaced: eight horizontal ones, straight down and straight up."""


def homewards(point: FloatArray) -> FloatArray:
    """Return the unit direction to the shoulder; straight ahead from the shoulder itself."""
    distance = float(np.linalg.norm(point))
    return -point / distance if distance > 0.0 else DIRECTIONS[0]


def cause_of(point: FloatArray, towards: FloatArray, short_by_m: float) -> Cause:
    """Return why a point, seen from the shoulder, is out of reach, given the displacement that brings it into reach."""
    further_m = np.linalg.norm(point + short_by_m * towards) - np.linalg.norm(point)
    if further_m < -_SIDEWAYS * short_by_m:
        return "too_far"
    return "too_near" if further_m > _SIDEWAYS * short_by_m else "joint_limit"
