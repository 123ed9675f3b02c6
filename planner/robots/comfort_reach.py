"""The places within the comfort radius, for each arm of a robot: the compiled queries and the state they share.

Where arms are mirror images, places and approaches are mirrored on the way in, and the memory of answers (see
`planner.robots.comfort`) is one arm's. Queries are counted and timed here.
"""

from time import thread_time

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import Approach, BoolArray, FloatArray, Point3
from planner.geometry.tolerance import LENGTH_M, grid_keys
from planner.robots.comfort import QUERIES, ROW_CELLS, ROW_STEP, ROWS, Memory, empty_memory
from planner.robots.comfort_memories import Memories
from planner.robots.driving_task import UNSEEN, DrivingTask
from planner.robots.following import FollowingPaths
from planner.robots.posture_room import Room, no_walls
from planner.robots.queried_arms import QueriedArms
from planner.robots.standoffs import anywhere, standoff_masks

_MOST_STANDOFFS = 32
"""Largest number of standoffs: one bit of a mask each."""

_SMALL_BITS = 4
"""Size of a memory that will hardly be used any more, as a power of two."""


class ComfortReach:
    """The reach of a robot with its lift at one height, for one comfort radius.

    It remembers its answers and counts its queries, so each plan should have its own; it must not be shared between
    threads. Places are tested on the grid of `LENGTH_M`, base frame.
    """

    def __init__(
        self,
        asked: QueriedArms,
        torso_m: float,
        comfort_m: float,
        room: Room | None = None,
        memories: Memories | None = None,
    ) -> None:
        """Start with nothing asked.

        Args:
            asked: the arms.
            torso_m: how far the torso is raised (m).
            comfort_m: the comfort radius (m).
            room: the obstacles to the first arm's postures; None: the body is no obstacle.
            memories: what earlier plans with the same arms, torso, radius and room have learned; None: nothing.
        """
        self._asked = asked
        self._torso_m = torso_m
        self._comfort_m = comfort_m
        self._memories = memories
        self._memory = empty_memory() if memories is None else memories.take()
        self._room = no_walls() if room is None else room._replace(poses=room.poses.copy())
        self._axes = np.array([approach.rotation[:, 0] for approach in asked.approaches])
        self._shoulders = tuple(arm.shoulder(torso_m) for arm in asked.arms)
        self._shortfall_queries = 0
        self._query_time_s = 0.0

    def forget(self) -> None:
        """Leave the memory, some 4 MB, to another plan and keep the counts; the answers stay the same."""
        queries = self.queries - self._shortfall_queries
        if self._memories is not None:
            self._memories.leave(self._memory)
            self._memories = None
        self._memory = empty_memory(_SMALL_BITS)
        self._memory.counts[QUERIES] = queries

    def share(self) -> None:
        """Leave a copy of the memory to the next plan (1 ms); see `Memories`."""
        if self._memories is not None and self._memory.counts[ROWS]:
            keys, bits, counts, hints = self._memory
            self._memories.leave(Memory(keys.copy(), bits.copy(), counts.copy(), hints.copy()))

    @property
    def arm_names(self) -> tuple[str, ...]:
        """The arms from left to right."""
        return self._asked.names

    @property
    def approaches(self) -> tuple[Approach, ...]:
        """The directions from which the grippers may pinch cloth, base frame."""
        return self._asked.approaches

    @property
    def shoulders(self) -> tuple[Point3, ...]:
        """The shoulder of each arm, base frame (m)."""
        seen = zip(self._asked.arms, self._shoulders, strict=True)
        found = [arm.mirrored_places(shoulder[None])[0] for arm, shoulder in seen]
        return tuple((float(x), float(y), float(z)) for x, y, z in found)

    @property
    def torso_m(self) -> float:
        """The torso's height (m)."""
        return self._torso_m

    @property
    def comfort_m(self) -> float:
        """The comfort radius (m)."""
        return self._comfort_m

    @property
    def queries(self) -> int:
        """The number of queries computed by the exact kernel so far, points on the comfort circle included.

        What is remembered, or further away than the arm is long, is answered without a query.
        """
        return int(self._memory.counts[QUERIES]) + self._shortfall_queries

    @property
    def query_time_s(self) -> float:
        """Time spent answering (s), memory included."""
        return self._query_time_s

    def standoffs(
        self,
        arm: int,
        points: FloatArray,
        approaches: NDArray[np.int64],
        count: int,
        step_m: float,
        enough: int | None = None,
        start: int | None = None,
        end: int | None = None,
        among: NDArray[np.uint32] | None = None,
    ) -> NDArray[np.uint32]:
        """Return bit masks, shape (k, n), of the standoffs from which each point is within the comfort radius.

        Args:
            arm: index into `arm_names`.
            points: tool points in the base frame at standoff 0 (m), shape (n, 3).
            approaches: indices into `approaches`, shape (k,).
            count: the number of standoffs, at most 32; raises `ValueError` beyond.
            step_m: the distance between standoffs (m).
            enough: the number of approaches wanted that can follow the points; None: all.
            start: the standoff at which the hand is at the first point already; None: any.
            end: the standoff at which the base is to be in the end; None: any.
            among: bit masks of the standoffs that matter at each point, shape (n,); None: all.

        Returns:
            Bit j is set where the base may stand at standoff j * step_m when the hand has followed the points up to
            there; a row is 0 if it cannot follow them all.
        """
        if count > _MOST_STANDOFFS:
            raise ValueError(f"{count} standoffs do not fit into a mask of {_MOST_STANDOFFS} bits")
        self._cover(arm, points)
        started, full = thread_time(), (1 << count) - 1
        masks = standoff_masks(
            self._asked.numbers,
            self._shoulders[arm],
            self._memory,
            self._asked.arms[arm].mirrored_places(points),
            self._axes,
            self._asked.labels[arm][approaches],
            count,
            round(step_m / LENGTH_M),
            self._comfort_m,
            len(approaches) if enough is None else enough,
            full if start is None else 1 << start,
            np.full(len(points), full) if among is None else among.astype(np.int64),
            full if end is None else 1 << end,
            self._room,
        )
        self._query_time_s += thread_time() - started
        return masks

    def following(
        self, arms: tuple[int, ...], paths: FloatArray, approaches: tuple[NDArray[np.int64], ...], step_m: float
    ) -> FollowingPaths:
        """Return hands that are to follow paths, each in one approach.

        Args:
            arms: for each hand its index into `arm_names`.
            paths: for each hand its tool points in the base frame at standoff 0 (m), shape (hands, n, 3).
            approaches: for each hand indices into `approaches`, best first.
            step_m: the distance between standoffs (m).
        """
        for arm, path in zip(arms, paths, strict=True):
            self._cover(arm, path)
        labels = np.zeros((len(arms), max(len(allowed) for allowed in approaches)), dtype=np.int64)
        places = np.empty(paths.shape, dtype=np.int64)
        for hand, (arm, allowed) in enumerate(zip(arms, approaches, strict=True)):
            labels[hand, : len(allowed)] = self._asked.labels[arm][allowed]
            steps = grid_keys(self._asked.arms[arm].mirrored_places(paths[hand]))
            places[hand] = steps - grid_keys(self._shoulders[arm])
        slots = np.full((*labels.shape, paths.shape[1]), UNSEEN, dtype=np.int64)
        step = round(step_m / LENGTH_M)
        cells = places[:, :, 0] // ROW_STEP + ROW_CELLS // 2
        task = DrivingTask(
            self._asked.numbers,
            self._shoulders[0],
            self._memory,
            self._axes,
            labels,
            places,
            cells,
            slots,
            self._comfort_m,
            step,
            self._room,
        )
        return FollowingPaths(task, self._add_time)

    def _cover(self, arm: int, points: FloatArray) -> None:
        """Make sure that what an arm computes with covers points of the base frame (m), shape (n, 3): it does."""

    def _add_time(self, time_s: float) -> None:
        self._query_time_s += time_s

    def from_anywhere(
        self,
        arm: int,
        points: FloatArray,
        approaches: NDArray[np.int64],
        count: int,
        step_m: float,
        enough: int | None = None,
    ) -> BoolArray:
        """Return which points, each on its own, are within the comfort radius from at least one standoff, shape (k, n).

        Args:
            arm: index into `arm_names`.
            points: tool points in the base frame at standoff 0 (m), shape (n, 3).
            approaches: indices into `approaches`, shape (k,).
            count: the number of standoffs.
            step_m: the distance between standoffs (m).
            enough: the number of approaches wanted that reach every point; None: all.
        """
        self._cover(arm, points)
        started = thread_time()
        answers = anywhere(
            self._asked.numbers,
            self._shoulders[arm],
            self._memory,
            self._asked.arms[arm].mirrored_places(points),
            self._axes,
            self._asked.labels[arm][approaches],
            count,
            round(step_m / LENGTH_M),
            self._comfort_m,
            len(approaches) if enough is None else enough,
            self._room,
        )
        self._query_time_s += thread_time() - started
        return answers
