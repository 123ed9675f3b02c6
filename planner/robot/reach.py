"""The PR2's answer to what the primitives ask of a robot's reach."""

import math
from dataclasses import replace
from time import perf_counter

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import Approach, BoolArray, FloatArray, Point3
from planner.geometry.shortfall import Shortfall
from planner.geometry.tolerance import LENGTH_M
from planner.robot.back_offs import anywhere, back_off_masks, empty_memory
from planner.robot.shortfall import left_shortfall
from planner.robot.sided_arm import SidedArm

_PITCHES_DEG = (15, 30, 45, 60)
_HEADINGS_DEG = range(-90, 91, 15)
_MOST_BACK_OFFS = 32

APPROACHES = (
    *(Approach(math.radians(heading), math.radians(pitch)) for pitch in _PITCHES_DEG for heading in _HEADINGS_DEG),
    Approach(0.0, math.pi / 2),
)
"""The directions from which a gripper may pinch: a fan at four pitches, and straight down."""


def _mirror_images() -> NDArray[np.int64]:
    """For each approach the index of its mirror image, shape (len(APPROACHES),)."""
    fan = len(_HEADINGS_DEG)
    inner = [index - index % fan + fan - 1 - index % fan for index in range(len(APPROACHES) - 1)]
    return np.array([*inner, len(APPROACHES) - 1], dtype=np.int64)


class Pr2Reach:
    """The reach of a PR2 with its torso at one height, to one comfort radius.

    It remembers its answers and counts its queries, so each plan should have one of its own; it is
    not to be shared between threads. Places are asked on the grid of `LENGTH_M`, base frame.
    """

    def __init__(
        self, arm_names: tuple[str, ...], arms: tuple[SidedArm, ...], torso_m: float, comfort_m: float
    ) -> None:
        """Start with nothing remembered: names and arms from left to right, torso and comfort in m."""
        self._arm_names = arm_names
        self._arms = arms
        self._torso_m = torso_m
        self._comfort_m = comfort_m
        self._memory = empty_memory()
        self._axes = np.array([approach.rotation[:, 0] for approach in APPROACHES])
        self._mirror_images = _mirror_images()
        self._queries = 0
        self._query_time_s = 0.0

    @property
    def arm_names(self) -> tuple[str, ...]:
        """The arms from left to right."""
        return self._arm_names

    @property
    def approaches(self) -> tuple[Approach, ...]:
        """The directions from which the grippers may pinch cloth, base frame."""
        return APPROACHES

    @property
    def shoulders(self) -> tuple[Point3, ...]:
        """Where each arm is hung up, base frame (m)."""
        found = [arm.mirrored_places(arm.shoulder(self._torso_m)[None])[0] for arm in self._arms]
        return tuple((float(x), float(y), float(z)) for x, y, z in found)

    @property
    def torso_m(self) -> float:
        """How far the torso is raised (m)."""
        return self._torso_m

    @property
    def comfort_m(self) -> float:
        """The comfort radius (m)."""
        return self._comfort_m

    @property
    def queries(self) -> int:
        """Queries computed by the exact kernel so far, comfort points counted.

        What is remembered, or further away than the arm is long, is answered without one.
        """
        return self._queries

    @property
    def query_time_s(self) -> float:
        """Time spent answering (s), memory included."""
        return self._query_time_s

    def back_offs(
        self,
        arm: int,
        points: FloatArray,
        approaches: NDArray[np.int64],
        count: int,
        step_m: float,
        enough: int | None = None,
        start: int | None = None,
    ) -> NDArray[np.uint32]:
        """Bit masks, shape (k, n): from which back-offs each point is within comfortable reach.

        Args:
            arm: index into `arm_names`.
            points: tool points in the base frame at back-off 0 (m), shape (n, 3).
            approaches: indices into `approaches`, shape (k,).
            count: how many back-offs there are, at most 32; raises `ValueError` beyond.
            step_m: from one back-off to the next (m).
            enough: so many approaches that can follow the points are enough; None: all are wanted.
            start: where the base stands when the hand is at the first point already; None: anywhere.

        Returns:
            Bit j is set where the base may stand, having backed off by j * step_m, when the hand has
            followed the points up to there; a row is 0 if it cannot follow them all.
        """
        if count > _MOST_BACK_OFFS:
            raise ValueError(f"{count} back-offs do not fit into a mask of {_MOST_BACK_OFFS} bits")
        started = perf_counter()
        sided, seen = self._arms[arm], self._as_left_arm_sees(arm, approaches)
        masks, queries = back_off_masks(
            sided.shape,
            self._memory,
            sided.shoulder(self._torso_m),
            sided.mirrored_places(np.reshape(points, (-1, 3))),
            self._axes[seen],
            seen + 1,
            count,
            float(step_m),
            self._comfort_m,
            len(seen) if enough is None else enough,
            (1 << count) - 1 if start is None else 1 << start,
        )
        self._queries += queries
        self._query_time_s += perf_counter() - started
        return masks

    def from_anywhere(
        self, arm: int, points: FloatArray, approaches: NDArray[np.int64], count: int, step_m: float
    ) -> BoolArray:
        """Which points, each on its own, are within comfortable reach from at least one back-off, shape (k, n).

        Args:
            arm: index into `arm_names`.
            points: tool points in the base frame at back-off 0 (m), shape (n, 3).
            approaches: indices into `approaches`, shape (k,).
            count: how many back-offs there are.
            step_m: from one back-off to the next (m).
        """
        started = perf_counter()
        sided, seen = self._arms[arm], self._as_left_arm_sees(arm, approaches)
        answers, queries = anywhere(
            sided.shape,
            self._memory,
            sided.shoulder(self._torso_m),
            sided.mirrored_places(np.reshape(points, (-1, 3))),
            self._axes[seen],
            seen + 1,
            count,
            float(step_m),
            self._comfort_m,
        )
        self._queries += queries
        self._query_time_s += perf_counter() - started
        return answers

    def shortfall(self, arm: int, point: FloatArray, approaches: NDArray[np.int64]) -> Shortfall | None:
        """Why, and by how much, a point is not within comfortable reach, in the best of some approaches.

        Tried are displacements up to 0.8 m, along eight horizontal directions, straight down and straight up.

        Args:
            arm: index into `arm_names`.
            point: the tool's place in the base frame (m), shape (3,).
            approaches: indices into `approaches`, shape (k,); raises `ValueError` if there are none.

        Returns:
            The smallest shortfall; None where the point is in comfort in one of the approaches. From 0.8 m on
            `short_by_m` is a lower bound: nothing that was tried helps.
        """
        if len(approaches) == 0:
            raise ValueError("without an approach no point is within reach")
        if self.from_anywhere(arm, point, approaches, 1, 0.0).any():
            return None
        started = perf_counter()
        sided, seen = self._arms[arm], self._as_left_arm_sees(arm, approaches)
        on_grid = LENGTH_M * np.round(sided.mirrored_places(point) / LENGTH_M)
        found, queries = left_shortfall(
            sided.shape, on_grid - sided.shoulder(self._torso_m), self._axes[seen], self._comfort_m
        )
        x, y, z = sided.mirrored_places(np.array(found.towards))
        self._queries += queries
        self._query_time_s += perf_counter() - started
        return replace(found, towards=(float(x), float(y), float(z)), approach=int(approaches[found.approach]))

    def _as_left_arm_sees(self, arm: int, approaches: NDArray[np.int64]) -> NDArray[np.int64]:
        indices = np.asarray(approaches, dtype=np.int64)
        return self._mirror_images[indices] if self._arms[arm].is_mirrored else indices
