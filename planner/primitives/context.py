"""The planning context: what all primitives of one task share.

It holds the garment's folds, the scene, the robot's reach and the garment's placement. The *standoff* (`standoff` in
names) is how far the base stands back from its station; the search knows it in steps of a grid.
"""

import math
from collections.abc import Callable, Hashable
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from typing import Any, NamedTuple, TypeVar, cast

import numpy as np

from planner.cloth.g_state import StabilityViolation, TableInGarment, stability_violation_at
from planner.cloth.garment import Garment
from planner.cloth.grips import Cover, GripCovers
from planner.deadline import ENDLESS, Deadline
from planner.folds.fold_path import FoldPath
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.driving import STANDOFFS_PER_M
from planner.geometry.pose import FloatArray, Point2, Pose2
from planner.geometry.table import Table
from planner.geometry.tolerance import LENGTH_M, grid_key
from planner.primitives.drive_time import ACCELERATION_M_S2, DriveTime
from planner.primitives.obstacle import Obstacles
from planner.primitives.reach import Reach
from planner.primitives.state import UNDRAGGED, State
from planner.task.scene import Scene
from planner.task.world_state import BaseStop

_CLOTHS_KEPT = 12
"""Garments at a place on a table that are remembered, some 0.5 MB each."""

_HANDS_MAX = 500
"""Folds at places of which the hands stay known once a search has ended, some 3 kB each."""


class Hands(NamedTuple):
    """The grips and arms that may perform a fold, whatever their approaches.

    Attributes:
        cover: the points held, garment frame (m).
        arms: the arm that holds each point.
        path: the fold's path, table frame.
        points: the grips in the table frame's unrolled plane, shape (grips, 2), m.
        sweeps: the waypoints, as sweeps.
        tools: each grip's tool path in the table frame, shape (grips, waypoints, 3), m.
    """

    cover: Cover
    arms: tuple[int, ...]
    path: FoldPath
    points: FloatArray
    sweeps: FloatArray
    tools: FloatArray


@dataclass(frozen=True, slots=True, eq=False)
class ClothMemory:
    """A cache of the answers about one garment, placed on one table: what these alone decide.

    The same cloth comes up again and again: a drawing is planned quickly and then well, a search also looks at
    restricted tasks, and trials of causes change one number at a time. So this is kept by value and shared by all
    contexts, between threads, too.

    Attributes:
        stability_violation: by folds done and place on the grid, why the cloth would not stay; None if it stays.
        tables: by place on the grid, the table seen from the garment.
        extents: by folds done, the smallest and largest coordinates of the cloth before any drag.
        placed: by offset, the garment's placement.
        drag_covers: by folds done, offset where it matters, direction and hands, the grips for a drag.
        hands: by all that they depend on, the hands that may perform a fold; see `fold_trials`.
    """

    stability_violation: dict[tuple[int, int, int], StabilityViolation | None] = field(default_factory=dict)
    tables: dict[tuple[int, int], TableInGarment] = field(default_factory=dict)
    extents: dict[int, tuple[FloatArray, FloatArray]] = field(default_factory=dict)
    placed: dict[Point2, Pose2] = field(default_factory=dict)
    drag_covers: dict[tuple[int, Point2 | None, Point2, int], GripCovers] = field(default_factory=dict)
    hands: dict[Hashable, tuple[Hands, ...]] = field(default_factory=dict)

    def trim(self) -> None:
        """Drop what takes much memory after a long search."""
        if len(self.hands) > _HANDS_MAX:
            self.hands.clear()


@lru_cache(_CLOTHS_KEPT)
def cloth_memory(
    _garment: Garment, _placement: Pose2, _table: Table, _friction: float, _support_angle_rad: float
) -> ClothMemory:
    """Return the memory of a garment at a place on a table; its key is all that its answers depend on."""
    return ClothMemory()


T = TypeVar("T")

GRIPS_APART_M = 0.10
"""The default smallest distance between two grips (m)."""

DRAGS_PER_M = 10
"""The resolution of the grid of drag distances: one every 10 cm (1/m)."""

_RANK_M = 1e-4
"""The resolution at which folds are ordered by where they are (m): another frame moves them by less."""

_START = State(0, UNDRAGGED, 0, 0)
"""The usual start: no fold done, nothing dragged, the base at the first station."""


@dataclass(frozen=True)
class Context:
    """The data that all primitives of one task share.

    Attributes:
        sequence: the garment and its legal folds.
        scene: table, stations, costs.
        reach: the robot's reach.
        placement: the garment frame in the table frame at the start.
        circle_m: radius of the circle round the base that must clear the table when it turns (m).
        behind_max_m: how far the part that a fold moves may reach behind its line's extension (m).
        grips_apart_m: the smallest distance between two grips that two hands can take (m).
        start: the state before the first primitive.
        obstacles: why primitives were not possible, collected for the reasons.
        deadline: when the time for the answer is up.
        is_fixed: whether the base cannot drive at all: then there is one station and no standoff.
        is_firm: whether hands hold firmly wherever they can.
        base_acceleration_m_s2: the base's top acceleration.
    """

    sequence: FoldSequence
    scene: Scene
    reach: Reach
    placement: Pose2
    circle_m: float
    behind_max_m: float = 0.0
    grips_apart_m: float = GRIPS_APART_M
    start: State = _START
    obstacles: Obstacles = field(default_factory=Obstacles)
    deadline: Deadline = ENDLESS
    is_fixed: bool = False
    is_firm: bool = False
    base_acceleration_m_s2: float = ACCELERATION_M_S2
    _bases: dict[tuple[int, float], Pose2] = field(default_factory=dict, init=False)
    _kept: dict[Callable[["Context"], object], object] = field(default_factory=dict, init=False)
    _available: dict[int, tuple[int, ...]] = field(default_factory=dict, init=False)

    def anew(self, **changes: Any) -> "Context":  # noqa: ANN401
        """Return this context with some of its attributes changed, with no obstacles met and nothing computed yet."""
        return replace(self, obstacles=Obstacles(), **changes)

    def kept(self, kind: "Callable[[Context], T]") -> T:
        """Return the context's one shared value of a kind, made at the first request."""
        if kind not in self._kept:
            self._kept[kind] = kind(self)
        return cast("T", self._kept[kind])

    def forget(self) -> None:
        """Drop everything but the obstacles: caches of a few megabytes, which later requests fill again."""
        for kept in (self._bases, self._kept, self._available):
            kept.clear()
        self.cloth.trim()
        vars(self).pop("cloth", None)
        self.reach.memory.forget()

    @cached_property
    def cloth(self) -> ClothMemory:
        """The cache of answers about the cloth, shared with other contexts in which it is the same."""
        scene = self.scene
        return cloth_memory(self.sequence.garment, self.placement, scene.table, scene.friction, scene.support_angle_rad)

    def allowed(self, covers: GripCovers) -> tuple[Cover, ...]:
        """Return the sets of grips that hands may take of those that hold some cloth."""
        return covers.firm if self.is_firm else covers.every

    @cached_property
    def standoffs(self) -> int:
        """The number of standoffs on the grid."""
        return math.floor(self.scene.back_off_max_m * STANDOFFS_PER_M + LENGTH_M) + 1

    def available(self, done: int) -> tuple[int, ...]:
        """Return the folds that can come next, sorted by where they are, however they are given.

        Of equally quick plans the search takes the first that it meets.
        """
        if done not in self._available:
            self._available[done] = tuple(sorted(self.sequence.dag.available(done), key=self._fold_ranks.__getitem__))
        return self._available[done]

    @cached_property
    def _fold_ranks(self) -> tuple[tuple[int, ...], ...]:
        """The sort key of each fold: its line as the robot sees it from the first station.

        Mirror images have the same keys, but for the last number.
        """
        keys = []
        for fold in self.sequence.folds:
            line = self.placement.to_outer(np.array([fold.line.start, fold.line.end]))
            start, end = self.station_pose(0).to_inner(line)
            (x, y), length_m = (start + end) / 2.0, float(np.linalg.norm(end - start))
            keys.append(tuple(round(float(value) / _RANK_M) for value in (x, abs(y), length_m, y)))
        return tuple(keys)

    def placed(self, offset: Point2) -> Pose2:
        """Return the garment's placement after drags by `offset`."""
        found = self.cloth.placed.get(offset)
        if found is None:
            found = self.cloth.placed[offset] = self.placement.moved(*offset)
        return found

    def station_pose(self, station: int) -> Pose2:
        """Return a station's base pose, table frame."""
        return self.scene.stations[station][1]

    def base_pose(self, station: int, standoff: float) -> Pose2:
        """Return the base's pose at a station and a standoff (grid steps), table frame."""
        key = (station, standoff)
        if key not in self._bases:
            self._bases[key] = self.station_pose(station).ahead(-standoff / STANDOFFS_PER_M)
        return self._bases[key]

    def base_stop(self, state: State) -> BaseStop:
        """Return where the base stands in a state; the stop of an unnamed station has no name."""
        name, pose = self.scene.stations[state.station]
        return BaseStop.at(name or None, pose, state.standoff / STANDOFFS_PER_M)

    @property
    def drive_time(self) -> DriveTime:
        """The time of a base that drives from rest to rest."""
        return DriveTime(self.scene.base_speed_m_s, self.scene.base_turn_rad_s, self.base_acceleration_m_s2)

    def drive_s(self, steps: float) -> float:
        """Return the time to drive a number of steps of the grid of standoffs at top speed (s)."""
        return steps / STANDOFFS_PER_M / self.scene.base_speed_m_s

    def drag_s(self, steps: int) -> float:
        """Return the time to drive a number of steps of the grid of standoffs from rest to rest, as in a drag (s)."""
        return self.drive_time.driving_s(steps / STANDOFFS_PER_M)

    def in_base(self, station: int, points: FloatArray) -> FloatArray:
        """Return tool points of the table frame, shape (n, 3), in the base frame at standoff 0 (m)."""
        above_floor = points + np.array([0.0, 0.0, self.scene.table.height_m])
        return self.station_pose(station).to_inner(above_floor)

    def table_in_garment(self, offset: Point2) -> TableInGarment:
        """Return the table top in the garment frame after drags by `offset`."""
        key = (grid_key(offset[0]), grid_key(offset[1]))
        found = self.cloth.tables.get(key)
        if found is None:
            found = self.cloth.tables[key] = TableInGarment.seen_from(self.placed(offset), self.scene.table)
        return found

    def is_on_table(self, point: Point2, offset: Point2) -> bool:
        """Return whether a point of the garment, in its frame, is over the table top after drags by `offset`."""
        return self._is_over_top(self.placement.to_outer(np.array(point)), offset)

    def is_all_on_table(self, done: int, offset: Point2) -> bool:
        """Return whether all cloth lies on the table after some folds (bit mask) and drags by `offset`."""
        if all(self._is_over_top(corner, offset) for corner in self._extent_of_all):
            return True
        extent = self.cloth.extents.get(done)
        if extent is None:
            extent = self.cloth.extents[done] = self._extent(self.sequence.cloth(done).silhouette.coordinates)
        return all(self._is_over_top(corner, offset) for corner in extent)

    def may_be_on_table(self, offset: Point2) -> bool:
        """Return whether any cloth, folded or not, may lie on the table top after drags by `offset`."""
        (x0, y0), (x1, y1) = (corner + offset for corner in self._extent_of_all)
        table = self.scene.table
        return bool(x0 < table.depth_m / 2 and -table.depth_m / 2 < x1) and bool(
            y0 < table.width_m / 2 and -table.width_m / 2 < y1
        )

    @cached_property
    def _extent_of_all(self) -> tuple[FloatArray, FloatArray]:
        """The smallest and largest coordinates of all places to which folds carry cloth.

        Found without folding, which takes longer.
        """
        return self._extent(self.sequence.covered)

    def _extent(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        placed = self.placement.to_outer(points)
        return placed.min(axis=0), placed.max(axis=0)

    def _is_over_top(self, point: FloatArray, offset: Point2) -> bool:
        """Return whether a point is over the table top after drags by `offset`; table frame before any drag."""
        x, y = float(point[0]) + offset[0], float(point[1]) + offset[1]
        table = self.scene.table
        return abs(x) <= table.depth_m / 2 + LENGTH_M and abs(y) <= table.width_m / 2 + LENGTH_M

    def stability_violation(self, done: int, offset: Point2) -> StabilityViolation | None:
        """Return why the cloth would not stay at a placement after some folds; None if it is in a g-state."""
        key, known = (done, grid_key(offset[0]), grid_key(offset[1])), self.cloth.stability_violation
        if key not in known:
            scene = self.scene
            at = (self.placed(offset), scene.table, scene.friction, scene.support_angle_rad)
            hangs = not self.is_all_on_table(done, offset)
            known[key] = stability_violation_at(self.sequence.cloth(done), *at) if hangs else None
        return known[key]

    def stays(self, done: int, offset: Point2) -> bool:
        """Return whether the cloth stays at a placement after some folds; why it would not is noted as an obstacle."""
        found = self.stability_violation(done, offset)
        self.obstacles.note_violation(found)
        return found is None
