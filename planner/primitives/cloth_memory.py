"""A cache of what garment and table alone decide: where the cloth rests, its grips, and the paths of its folds.

The same cloth comes up again and again: a drawing is planned quickly and then well, a search also looks at restricted
tasks, and trials of causes change one number at a time. So this is kept by value and shared by all contexts.
"""

from collections.abc import Hashable
from dataclasses import dataclass, field
from functools import lru_cache
from typing import NamedTuple

from planner.cloth.g_state import TableInArticle, Unrest
from planner.cloth.garment import Garment
from planner.cloth.grips import Cover, GripCovers
from planner.folds.fold_path import FoldPath
from planner.geometry.pose import FloatArray, Point2, Pose2
from planner.geometry.table import Table

_CLOTHS_KEPT = 12
"""Garments at a place on a table that are remembered, some 0.5 MB each."""

_HANDS_MAX = 500
"""Folds at places of which the hands stay known once a search has ended, some 3 kB each."""


class Hands(NamedTuple):
    """The grips and arms that may perform a fold, whatever their approaches.

    Attributes:
        cover: the points held, article frame (m).
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
    """A cache of the answers about one garment, placed on one table. May be shared between threads.

    Attributes:
        unrest: by folds done and place on the grid, why the cloth would not stay; None if it stays.
        tables: by place on the grid, the table seen from the article.
        extents: by folds done, the smallest and largest coordinates of the cloth before any drag.
        placed: by offset, the article's placement.
        drag_covers: by folds done, offset where it matters, direction and hands, the grips for a drag.
        hands: by all that they depend on, the hands that may perform a fold; see `fold_trials`.
    """

    unrest: dict[tuple[int, int, int], Unrest | None] = field(default_factory=dict)
    tables: dict[tuple[int, int], TableInArticle] = field(default_factory=dict)
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
    """Return the memory of a garment at a place on a table; all that its answers depend on tells it from others."""
    return ClothMemory()
