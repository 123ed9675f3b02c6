"""Tool poses to test: on both sides of the boundary of the left arm's reach, the same in every run."""

from dataclasses import dataclass

import numpy as np

from bench.pin_arm import pin_arm
from planner.geometry.pose import BoolArray, FloatArray
from planner.geometry.tolerance import LENGTH_M
from planner.robots.pr2.reach import APPROACHES

SEED = 2012
FURTHEST_M = 0.5
"""Largest displacement of a tool from a reachable pose (m)."""

UNMOVED = 0.25
"""Fraction of poses left where the arm can surely take them."""


@dataclass(frozen=True, slots=True)
class Queries:
    """Tool poses in the base frame.

    Attributes:
        points: shape (n, 3) (m).
        rotations: shape (n, 3, 3).
        is_sure: which are the poses of joints within limits, and so surely within reach, shape (n,).
        approaches: for pinches the index of the approach, shape (n,); otherwise -1.
    """

    points: FloatArray
    rotations: FloatArray
    is_sure: BoolArray
    approaches: FloatArray

    def __len__(self) -> int:
        return len(self.points)

    @property
    def axes(self) -> FloatArray:
        """The axes along which the tool points, shape (n, 3)."""
        return np.ascontiguousarray(self.rotations[:, :, 0])

    def part(self, start: int, end: int) -> "Queries":
        """Return the queries from a start index to before an end index."""
        some = slice(start, end)
        return Queries(self.points[some], self.rotations[some], self.is_sure[some], self.approaches[some])


def any_poses(count: int) -> Queries:
    """Return poses of uniform random joints within their limits; three quarters of them moved by up to `FURTHEST_M`."""
    random = np.random.default_rng(SEED)
    tools = [pin_arm().tool(joints).copy() for joints in pin_arm().random_joints(random, count)]
    points = np.array([tool.translation for tool in tools])
    rotations = np.array([tool.rotation for tool in tools])
    is_sure = random.random(count) < UNMOVED
    directions = random.normal(size=(count, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    lengths = np.where(is_sure, 0.0, random.uniform(0.0, FURTHEST_M, count))
    return Queries(points + lengths[:, None] * directions, rotations, is_sure, np.full(count, -1))


def pinches(poses: Queries) -> Queries:
    """Return the points on the planner's grid, each with the planner's approach nearest to its pose's."""
    fan = np.array([approach.rotation for approach in APPROACHES])
    nearest = np.argmax(poses.axes @ fan[:, :, 0].T, axis=1)
    on_grid = LENGTH_M * np.round(poses.points / LENGTH_M)
    return Queries(on_grid, fan[nearest], np.zeros(len(poses), dtype=bool), nearest)
