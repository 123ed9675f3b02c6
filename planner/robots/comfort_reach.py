"""The reach of a robot's arms: the compiled queries about places within the comfort radius, and shortfalls of others.

Where arms are mirror images, places and approaches are mirrored on the way in, and the memory of answers (see
`planner.robots.comfort`) is one arm's.
"""

import math
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from time import thread_time
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from planner.deadline import ENDLESS, Deadline
from planner.geometry.driving import IMPOSSIBLE, Driving, Wanted
from planner.geometry.pose import Approach, BoolArray, FloatArray, Point3
from planner.geometry.reach_query import ReachQuery, Shortfall
from planner.geometry.tolerance import grid_keys
from planner.robots.arm_query import ArmNumbers
from planner.robots.comfort import GOOD, KNOWN, QUERIES, ROW_CELLS, ROWS, Memory, empty_memory
from planner.robots.driving import ANY, EVERY, UNBEATEN, UNSEEN, DrivingTask, least_driving
from planner.robots.place import STANDOFF_STEP
from planner.robots.standoffs import anywhere, standoff_masks

_LEFT_MAX = 2
"""Memories that are left for plans to come: as many as are mostly made at once."""

_FULL = 0.5
"""Share of a memory's rows from which it has no room for another plan."""

_SMALL_BITS = 4
"""Size of a memory that will hardly be used any more, as a power of two."""


class Memories:
    """The memories of one robot for one torso height and comfort radius. Threads may share it.

    Where an arm reaches depends on the robot alone, and a garment that has changed a little asks about much the same
    places. A memory (see `planner.robots.comfort`) must not be shared between threads, so a plan takes one and leaves
    it when done. A plan is charged for the queries of another, so that its work does not depend on what came before it.
    """

    def __init__(self) -> None:
        self._left: deque[Memory] = deque(maxlen=_LEFT_MAX)

    def take(self) -> Memory:
        """Return the memory left last, or an empty one."""
        try:
            memory = self._left.pop()
        except IndexError:
            return empty_memory()
        memory.bits[:, KNOWN : GOOD + 1] = 0
        memory.counts[QUERIES] = 0
        return memory

    def leave(self, memory: Memory) -> None:
        """Leave a memory for another plan, unless it is too full."""
        if memory.counts[ROWS] < _FULL * len(memory.keys):
            self._left.append(memory)


class PlanMemory:
    """The memory of one plan, and its counters; implements `planner.primitives.reach.ReachMemory`.

    Attributes:
        rows: what the compiled queries remember; they add to it.
        query_time_s: the time spent on answers (s), remembered ones included.
    """

    def __init__(self, others: Memories | None = None) -> None:
        """Take what other plans have found out; None: nothing."""
        self._others = others
        self.rows = empty_memory() if others is None else others.take()
        self.query_time_s = 0.0
        self._more_queries = 0

    @property
    def queries(self) -> int:
        """The number of queries computed by the exact kernel so far, points on the comfort circle included.

        What is remembered, or further away than the arm is long, is answered without a query.
        """
        return int(self.rows.counts[QUERIES]) + self._more_queries

    def charge(self, time_s: float, queries: int = 0) -> None:
        """Add the time of an answer (s), and queries that it took beyond those about remembered places."""
        self.query_time_s += time_s
        self._more_queries += queries

    def forget(self) -> None:
        """Leave the memory, some 4 MB, to another plan and keep the counters; the answers stay the same."""
        queries = self.rows.counts[QUERIES]
        if self._others is not None:
            self._others.leave(self.rows)
            self._others = None
        self.rows = empty_memory(_SMALL_BITS)
        self.rows.counts[QUERIES] = queries

    def share(self) -> None:
        """Leave a copy of the memory to the next plan (1 ms); see `Memories`."""
        if self._others is not None and self.rows.counts[ROWS]:
            self._others.leave(Memory(*(part.copy() for part in self.rows)))


_WANTED = {"unbeaten": UNBEATEN, "every": EVERY, "any": ANY}


class ReachingArm(Protocol):
    """An arm as the compiled queries see it."""

    def shoulder(self, torso_m: float) -> FloatArray:
        """Return its shoulder in its own frame with the lift raised (m), shape (3,)."""
        ...

    def mirrored_places(self, places: FloatArray) -> FloatArray:
        """Return points of the base frame, shape (..., 3), in the arm's own frame; a new array."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class QueriedArms:
    """The arms of a robot, and how the compiled queries take them.

    Attributes:
        names: the arms from left to right.
        arms: the same arms.
        numbers: what the queries compute with; one arm's where the others are its mirror images.
        approaches: the directions from which the grippers may pinch cloth, base frame.
        labels: for each arm the memory's label of each approach.
    """

    names: tuple[str, ...]
    arms: tuple[ReachingArm, ...]
    numbers: ArmNumbers
    approaches: tuple[Approach, ...]
    labels: tuple[NDArray[np.int64], ...]


_MOST_STANDOFFS = 32
"""Largest number of standoffs: one bit of a mask each."""


class ComfortReach(ABC):
    """The reach of a robot with its lift at one height, for one comfort radius; implements `Reach`.

    Each plan should have its own, as it has its own memory; it must not be shared between threads. Places are tested on
    the grid of `LENGTH_M`, base frame.

    Attributes:
        arm_names: the arms from left to right.
        approaches: the directions from which the grippers may pinch cloth, base frame.
        torso_m: the torso's height (m).
        comfort_m: the comfort radius (m).
        memory: what has been answered so far.
    """

    def __init__(self, queried: QueriedArms, torso_m: float, comfort_m: float, memories: Memories | None) -> None:
        """Start with nothing remembered.

        Args:
            queried: the arms.
            torso_m: how far the torso is raised (m).
            comfort_m: the comfort radius (m).
            memories: what earlier plans with the same arms, torso, radius and room have learned; None: nothing.
        """
        self._queried = queried
        self.arm_names, self.approaches = queried.names, queried.approaches
        self.torso_m, self.comfort_m = torso_m, comfort_m
        self.memory = PlanMemory(memories)
        self._shoulders = tuple(arm.shoulder(torso_m) for arm in queried.arms)

    @property
    def shoulders(self) -> tuple[Point3, ...]:
        """The shoulder of each arm, base frame (m)."""
        seen = zip(self._queried.arms, self._shoulders, strict=True)
        found = [arm.mirrored_places(shoulder[None])[0] for arm, shoulder in seen]
        return tuple((float(x), float(y), float(z)) for x, y, z in found)

    def standoffs(
        self,
        path: ReachQuery,
        *,
        start: int | None = None,
        end: int | None = None,
        among: NDArray[np.uint32] | None = None,
    ) -> NDArray[np.uint32]:
        """Return bit masks, shape (k, n), of the standoffs at which the base may be while a tool follows a path.

        See `Reach`; raises `ValueError` where there are more than 32 standoffs.
        """
        if path.count > _MOST_STANDOFFS:
            raise ValueError(f"{path.count} standoffs do not fit into a mask of {_MOST_STANDOFFS} bits")
        numbers = self._numbers_for(path)
        started, full = thread_time(), (1 << path.count) - 1
        masks = standoff_masks(
            numbers,
            self._shoulders[path.arm],
            self.memory.rows,
            self._queried.arms[path.arm].mirrored_places(path.points),
            self._queried.labels[path.arm][path.approaches],
            path.count,
            self.comfort_m,
            full if start is None else 1 << start,
            np.full(len(path.points), full) if among is None else among.astype(np.int64),
            full if end is None else 1 << end,
        )
        self.memory.charge(thread_time() - started)
        return masks

    def following(self, paths: Sequence[ReachQuery]) -> Callable[..., Driving]:
        """Return the query about hands that are to follow paths, each in one approach (see `Reach`)."""
        hands, waypoints = len(paths), len(paths[0].points)
        labels = np.zeros((hands, max(len(path.approaches) for path in paths)), dtype=np.int64)
        places = np.empty((hands, waypoints, 3), dtype=np.int64)
        for hand, path in enumerate(paths):
            numbers = self._numbers_for(path)
            labels[hand, : len(path.approaches)] = self._queried.labels[path.arm][path.approaches]
            steps = grid_keys(self._queried.arms[path.arm].mirrored_places(path.points))
            places[hand] = steps - grid_keys(self._shoulders[path.arm])
        slots = np.full((*labels.shape, waypoints), UNSEEN, dtype=np.int64)
        cells = places[:, :, 0] // STANDOFF_STEP + ROW_CELLS // 2
        task = DrivingTask(numbers, self.memory.rows, labels, places, cells, slots, self.comfort_m)
        charge = self.memory.charge

        def driven(begun: NDArray[np.int64], most: int = IMPOSSIBLE - 1, wanted: Wanted = "unbeaten") -> Driving:
            started = thread_time()
            answer, more = least_driving(task, begun, most, _WANTED[wanted])
            charge(thread_time() - started)
            return Driving(answer[0], answer[1], answer[2:], more)

        return driven

    def from_anywhere(self, places: ReachQuery) -> BoolArray:
        """Return which points, each on its own, are within the comfort radius from at least one standoff, (k, n)."""
        numbers = self._numbers_for(places)
        started = thread_time()
        answers = anywhere(
            numbers,
            self._shoulders[places.arm],
            self.memory.rows,
            self._queried.arms[places.arm].mirrored_places(places.points),
            self._queried.labels[places.arm][places.approaches],
            places.count,
            self.comfort_m,
        )
        self.memory.charge(thread_time() - started)
        return answers

    def _numbers_for(self, _query: ReachQuery) -> ArmNumbers:
        """Return what the compiled queries compute with, good for some points."""
        return self._queried.numbers

    @abstractmethod
    def at_least_short(self, ways: ReachQuery) -> FloatArray:
        """Return a lower bound, which takes no query, on each way's shortfall (see `Reach`)."""

    def shortfall(
        self, places: ReachQuery, at_most_m: float = math.inf, deadline: Deadline = ENDLESS
    ) -> Shortfall | None:
        """Return by how much and why one of some places is not within the comfort radius (see `Reach`).

        Displacements up to 0.8 m are tried, along eight horizontal directions, straight down and straight up. Raises
        `ValueError` if there is no approach.
        """
        if len(places.approaches) == 0:
            raise ValueError("without an approach no point is within reach")
        if len(places.points) > 1:
            return self._shortfall_together(places, at_most_m, deadline)
        return self._shortfall_of(places, 0, places.approaches, at_most_m, deadline)

    def _shortfall_of(
        self, places: ReachQuery, number: int, approaches: NDArray[np.int64], at_most_m: float, deadline: Deadline
    ) -> Shortfall | None:
        """Return the least shortfall of the place with a number, alone; None if it is within the comfort radius."""
        place = ReachQuery(places.arm, places.points[number], approaches)
        if self.from_anywhere(place).any():
            return None
        started = thread_time()
        found, queries = self._least_shortfall(place, at_most_m, deadline)
        self.memory.charge(thread_time() - started, queries)
        return replace(found, place=number)

    @abstractmethod
    def _least_shortfall(self, place: ReachQuery, at_most_m: float, deadline: Deadline) -> tuple[Shortfall, int]:
        """Return the least shortfall of a place that is not within the comfort radius, and the queries it took.

        The place is seen from each of the places where the base may stand, shape (n, 3).
        """

    @abstractmethod
    def _shortfall_together(self, places: ReachQuery, at_most_m: float, deadline: Deadline) -> Shortfall | None:
        """Return the worst of several places that one approach must reach, in the best approach for it."""
