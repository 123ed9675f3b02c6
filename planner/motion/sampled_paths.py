"""Find paths round what is in the way by sampling: RRT-Connect (Kuffner and LaValle, 2000), then shortcuts.

Two trees of configurations grow from start and goal. In turns, one goes towards a random configuration, the other
towards where that one came to; where they meet there is a path. The random numbers have a fixed seed and the
configurations that are tried are counted, so the same question always has the same answer, after bounded work. The
mirror image of a question has the mirror image of its answer.
"""

from collections.abc import Callable
from functools import lru_cache
from itertools import pairwise

import numpy as np

from planner.geometry.pose import FloatArray

TESTED_MAX = 4_000
"""The most configurations tested for one path, those for its shortcuts apart."""

_SHORTCUT_TESTED_MAX = 5_000
"""The most configurations tested for shortcuts."""

_STRIDE_RAD = 1.0
"""The farthest that a tree grows at once: the largest turn of a joint (rad)."""

_ROUND_RAD, _NEAR_SHARE = 0.8, 0.25
"""How far round the straight line some random configurations are at most, in each joint (rad), and which share of them:
most detours are short, and the box of all configurations is wide."""

_PART = 8
"""Lines count in parts of so many configurations: most of those into an obstacle end within a few."""

_SHORTCUTS = 60
"""Shortcuts tried."""

_SEED = 1

_DIGITS = 6
"""Decimal places to which turns of joints are compared (rad)."""

FreeUntil = Callable[[FloatArray], int]
"""The number of configurations, shape (n, joints), before the first one at which something is in the way."""

Mirror = Callable[[FloatArray], FloatArray]
"""The mirror image of configurations, shape (n, joints): arms exchanged, joints turned the other way where need be."""


class SampledPaths:
    """Finds one path between two configurations.

    Attributes:
        tested: how many configurations have been tested for the last path.
    """

    def __init__(
        self, free_until: FreeUntil, low: FloatArray, high: FloatArray, step_rad: float, mirror: Mirror | None = None
    ) -> None:
        """Keep the test and the box of the configurations that may be tried.

        Args:
            free_until: the test.
            low: the lowest value of each joint (rad), shape (joints,).
            high: the highest; one equal to the lowest stays as it is.
            step_rad: the largest turn of a joint from one tested configuration to the next (rad).
            mirror: the mirror image of configurations; None if there is none.
        """
        self.tested = 0
        self._mirror = mirror
        self._free_until, self._step_rad = free_until, step_rad
        self._middle, self._half = 0.5 * (low + high), 0.5 * (high - low)
        self._rng = np.random.default_rng(_SEED)

    def path(self, start: FloatArray, goal: FloatArray) -> FloatArray | None:
        """Return configurations from start to goal, shape (n, joints), between which lines are free.

        None if no path was found. Asked again, it samples on, and may return another path.
        """
        self.tested = 0
        if self._free(np.array([start, goal])) < 2:
            return None
        trees = _Tree(start), _Tree(goal)
        # Of a question and its image one takes the samples, the other their images. Joints that turn without end may
        # be whole turns away in one of them, so ends are not compared, but how far it is from one to the other.
        away = (goal - start).round(_DIGITS)[None]
        mirror = self._mirror if self._mirror and self._mirror(away).tolist() < away.tolist() else None
        low, high = self._middle - self._half, self._middle + self._half
        round_it = np.where(self._half > 0.0, 0.5 * np.abs(goal - start) + _ROUND_RAD, 0.0)
        turn = 0
        while self.tested < TESTED_MAX:
            one, other = trees[turn], trees[1 - turn]
            share, is_near = self._rng.uniform(-1.0, 1.0, len(start)), self._rng.random() < _NEAR_SHARE
            towards = share if mirror is None else mirror(share[None])[0]
            middle, half = (0.5 * (start + goal), round_it) if is_near else (self._middle, self._half)
            grown = self._grow(one, np.clip(middle + towards * half, low, high))
            if grown is not None and (met := self._connect(other, one.nodes[grown])) is not None:
                halves = one.way(grown), other.way(met)
                there = np.concatenate([halves[0], halves[1][::-1][1:]])
                return self._shortened(there if turn == 0 else there[::-1])
            turn = 1 - turn
        return None

    def _grow(self, tree: "_Tree", towards: FloatArray) -> int | None:
        """Grow a tree by at most one stride; return its new node, None if it is blocked."""
        near = tree.nearest(towards)
        away = towards - tree.nodes[near]
        stride = float(np.abs(away).max())
        reached = self._led(
            tree.nodes[near], tree.nodes[near] + away * min(1.0, _STRIDE_RAD / max(stride, _STRIDE_RAD))
        )
        return None if reached is None else tree.add(reached, near)

    def _connect(self, tree: "_Tree", place: FloatArray) -> int | None:
        """Grow a tree towards a configuration until it is there or stopped; return the node there, None if stopped."""
        while self.tested < TESTED_MAX:
            grown = self._grow(tree, place)
            if grown is None:
                return None
            if np.array_equal(tree.nodes[grown], place):
                return grown
        return None

    def _led(self, start: FloatArray, end: FloatArray) -> FloatArray | None:
        """Return the last configuration before a line is blocked, or its end; None if it is blocked at once."""
        line = sampled(start, end, self._step_rad)[1:]
        count = self._free(line)
        if count == len(line):
            return end
        return None if count == 0 else line[count - 1]

    def _shortened(self, way: FloatArray) -> FloatArray:
        """Return a shorter path: free lines between random pairs of its points replace the corners in between."""
        most = self.tested + _SHORTCUT_TESTED_MAX
        for _ in range(_SHORTCUTS):
            if len(way) < 3 or self.tested >= most:
                break
            lengths = np.append(0.0, np.cumsum([float(np.abs(b - a).max()) for a, b in pairwise(way)]))
            cuts = np.sort(self._rng.uniform(0.0, lengths[-1], 2))
            first, last = np.digitize(cuts, lengths).clip(1, len(way) - 1).tolist()
            if first == last:
                continue
            ends = np.column_stack([np.interp(cuts, lengths, column) for column in way.T])
            led = self._led(*ends)
            if led is not None and np.array_equal(ends[1], led):
                way = np.concatenate([way[:first], ends, way[last:]])
        return way

    def _free(self, joints: FloatArray) -> int:
        count = self._free_until(joints)
        self.tested += min((count // _PART + 1) * _PART, len(joints))
        return count


class _Tree:
    """Configurations, each with the one that it was reached from."""

    def __init__(self, root: FloatArray) -> None:
        self._rows, self._from = np.tile(root, (64, 1)), [0]

    @property
    def nodes(self) -> FloatArray:
        """The configurations, shape (n, joints)."""
        return self._rows[: len(self._from)]

    def nearest(self, joints: FloatArray) -> int:
        """Return the node nearest to a configuration."""
        return int(((self.nodes - joints) ** 2).sum(axis=1).argmin())

    def add(self, joints: FloatArray, near: int) -> int:
        """Add a node that was reached from another one, and return its number."""
        if len(self._from) == len(self._rows):
            self._rows = np.concatenate([self._rows, self._rows])
        self._rows[len(self._from)] = joints
        self._from.append(near)
        return len(self._from) - 1

    def way(self, node: int) -> FloatArray:
        """Return the configurations from the root to a node, shape (n, joints)."""
        numbers = [node]
        while numbers[-1] != 0:
            numbers.append(self._from[numbers[-1]])
        return np.asarray(self.nodes[numbers[::-1]])


def sampled(start: FloatArray, end: FloatArray, step_rad: float) -> FloatArray:
    """Return the straight line between two configurations, step by step, both included."""
    # Lines of a whole number of steps are frequent: rounding must not give their images one more.
    count = max(1, int(np.ceil(np.abs(end - start).max() / step_rad - 1e-9)))
    return np.asarray(start + _shares(count) * (end - start))


@lru_cache(256)
def _shares(count: int) -> FloatArray:
    """Return even shares from 0 to 1, shape (count + 1, 1)."""
    return np.linspace(0.0, 1.0, count + 1)[:, None]
