"""The cloth on the table during a transit, which the arms must neither touch nor sweep along."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache

import numpy as np

from planner.geometry.pose import BoolArray, FloatArray, Pose2
from planner.geometry.region import convex_pieces
from planner.geometry.tolerance import grid_key
from planner.motion.opened_collisions import OpenedCollisions
from planner.primitives.context import Context
from planner.primitives.state import State
from planner.robots.card import OPENING_M
from planner.robots.collision.collisions import Clearance, Collisions

OVER_CLOTH_M = 0.032
"""The height above the table that empty arms keep over cloth at the waypoints tested, more over high stacks (m).

It is 3 cm and a reserve for what may be lost between two tests.
"""

NEAR_GRIP_M = 0.07
"""The way from its grip within which a hand may be lower (m): 8 cm, less one step of at most 1 cm."""


_CLEARANCES_KEPT = 32
"""Size of the cache of clearances, some 45 kB each. While three garments are drawn, more save nothing (measured)."""


@dataclass(frozen=True, slots=True)
class LyingCloth:
    """Cloth that lies on the table.

    It is light, since caches hold it by the hundred: what arms are compared with is kept elsewhere, for a while.

    Attributes:
        key: identifies the cloth and its place.
        over_m: the height that empty arms keep above it (m).
    """

    key: bytes
    _pieces: tuple[FloatArray, ...] = field(compare=False, repr=False)
    _collisions: OpenedCollisions = field(compare=False, repr=False)
    over_m: float = OVER_CLOTH_M

    def arm_clear(
        self,
        arm: int,
        bases: Pose2 | FloatArray,
        joints: FloatArray,
        *,
        opening_m: float = OPENING_M,
    ) -> BoolArray:
        """Return at which joints of an empty arm the whole arm is high enough above the cloth, shape (n,).

        Args:
            arm: the arm.
            bases: the base's pose.
            joints: the arm's joints (rad), a row each.
            opening_m: how far its fingers are open at most (m).
        """
        clearance = _clearance(_Above(self.key, self.over_m, self._collisions.up_to(opening_m), self._pieces))
        return clearance.arm_clear(arm, bases, joints)


@dataclass(frozen=True, slots=True)
class _Above:
    """The space above cloth, which depends on the cloth, the table and the robot."""

    key: bytes
    over_m: float
    collisions: Collisions
    pieces: tuple[FloatArray, ...] = field(compare=False)


@lru_cache(_CLEARANCES_KEPT)
def _clearance(above: _Above) -> Clearance:
    return above.collisions.over_cloth(above.pieces, above.over_m)


class LyingCloths:
    """The cloth of one task in each of its states."""

    def __init__(self, context: Context, collisions: OpenedCollisions) -> None:
        self._context = context
        self._collisions = collisions
        self._known: dict[tuple[int, int, int], LyingCloth] = {}
        self._whole: dict[int, tuple[FloatArray, ...]] = {}  # a cached method would keep all this until a collection

    def of(self, state: State) -> LyingCloth:
        """Return the cloth as it lies in a state once nothing is held, without what hangs over the table's edges."""
        key = (state.done, grid_key(state.offset[0]), grid_key(state.offset[1]))
        if key not in self._known:
            placement = self._context.placed(state.offset)
            pieces = tuple(placement.to_outer(piece) for piece in self._pieces(state))
            name = b"".join(np.round(piece, 6).tobytes() + b"|" for piece in pieces)
            over_m = OVER_CLOTH_M + self._context.sequence.rests(state.done).raised_m
            self._known[key] = LyingCloth(name, pieces, self._collisions, over_m)
        return self._known[key]

    def _pieces(self, state: State) -> Sequence[FloatArray]:
        context = self._context
        if context.is_all_on_table(state.done, state.offset):
            return self._whole_pieces(state.done)
        top = context.table_in_garment(state.offset).region
        return convex_pieces(context.sequence.cloth(state.done).silhouette.intersection(top))

    def _whole_pieces(self, done: int) -> tuple[FloatArray, ...]:
        if done not in self._whole:
            self._whole[done] = convex_pieces(self._context.sequence.cloth(done).silhouette)
        return self._whole[done]
