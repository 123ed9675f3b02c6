"""Joints for an arm whose tool follows a path: continuous, within limits, free of collision.

The dynamic programme of `planner.robots.joint_chain` runs on every few poses of the path. Collisions are checked
lazily: only where the chain found collides are all samples of those poses checked, the colliding ones rejected, and the
chain is searched again, until it is free or no chain is left. Between its poses the joints keep near to the smoothed
chain and are solved for, so the tool is exactly on its path at every pose.
"""

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.robots.joint_chain import cheapest_chain
from planner.robots.tool_path import LEAP_RAD, IsFree, NoPath, PathArm, ToolPath, joints_along

_JUMP_RAD = 0.8
"""Largest movement of a joint from link to link of a chain (rad; m where it slides)."""

_SMOOTHINGS = 6
"""Passes of the filter that rounds the corners of the chain."""

_TRIES_MAX = 16
"""Chains tried before the search gives up."""

_TESTED_OF = {1: 3, 2: 1}
"""By try, the stride over the links whose samples are checked: a few links soon show that there is no path."""


class ArmSearch:
    """The search for one arm's path.

    Attributes:
        jump: the movement of a joint from which a link is a jump (rad; m where it slides).
        links: the poses at which the chain has a link, shape (l,).
        samples: joints that bring the tool there (rad; m where they slide), shape (l, m, joints).
        costs: the samples' costs, shape (l, m); infinite where there is no sample or it was rejected.
        speeds: the joints' top speeds (rad/s; m/s), shape (joints,).
        periods: what the joints may be off without any difference (rad), shape (joints,).
        stride: poses of the path from one link of the arm's own chain to the next.
        spans: the longest duration wanted for each link (s), shape (l - 1,).
        core: the first of the poses that matter, and the one after their last.
        chain: the sample taken at each link, shape (l,); the cheapest chain of those not rejected.
        has_dropped: whether collision-free samples were rejected because no path could be made of them.
    """

    def __init__(
        self, arm: PathArm, speeds: FloatArray, path: ToolPath, torso_m: float, floor_m: float, is_free: IsFree
    ) -> None:
        """Prepare the search.

        Args:
            arm: the arm.
            speeds: the joints' top speeds (rad/s; m/s), shape (joints,).
            path: the tool's path.
            torso_m: how far the torso is raised (m).
            floor_m: the height over which elbows should preferably stay, base frame (m).
            is_free: the check of which joints are collision-free.
        """
        self._arm = arm
        self._path = path
        self._torso_m = torso_m
        self._floor_m = floor_m
        self._is_free = is_free
        self.core = path.core
        self.speeds, self.periods, self.stride = speeds, arm.periods, arm.stride
        self.jump, self.links = 0.0, np.empty(0, dtype=np.int64)
        self.samples, self.costs = np.empty((0, 0, len(speeds))), np.empty((0, 0))
        self.chain, self.spans = np.empty(0, dtype=np.int64), np.empty(0)
        self._is_tested = np.empty(0, dtype=bool)
        self.has_dropped = False

    def found(self, stride: int | None = None) -> FloatArray | NoPath:
        """Return the joints of least movement that keep the tool on the path, shape (n, joints), or why there are none.

        Joints that turn without end are unwound.

        Args:
            stride: poses of the path from one link of the chain to the next; None: as the arm has it.
        """
        count = len(self._path.positions)
        stride = stride or self.stride
        self.jump = min(_JUMP_RAD, stride * LEAP_RAD)
        self.links = np.unique(np.append(np.arange(0, count, stride), count - 1))
        self.spans = np.add.reduceat(np.append(self._path.spans_s, 0.0), self.links)[:-1]
        self._is_tested = np.zeros(len(self.links), dtype=bool)
        places, axes = self._path.positions[self.links], self._path.rotations[self.links]
        self.samples, self.costs = self._arm.samples(places, axes, self._torso_m, self._floor_m)
        for number in range(_TRIES_MAX):
            self.chain = cheapest_chain(self.samples, self.costs, self.speeds, self.periods, self.jump, self.spans)
            if not len(self.chain):
                break
            guides = self.guides(self.chain)
            bad = self.links[~self.are_free(guides)]
            if not len(bad):
                joints, bad = self.followed(guides)
            if not len(bad):
                return self.smoothed(guides, joints)
            self._strike(self.chain, bad, number)
        return self._none()

    def guides(self, chain: NDArray[np.int64]) -> FloatArray:
        """Return the chain's joints, those that turn without end unwound, shape (l, joints)."""
        return self._arm.unwound(self.samples[np.arange(len(chain)), chain])

    def are_free(self, guides: FloatArray) -> BoolArray:
        """Return at which links the arm does not collide, shape (l,)."""
        return self._is_free(self.links, guides)

    def followed(self, guides: FloatArray) -> tuple[FloatArray, NDArray[np.int64]]:
        """Return the joints along the whole path, shape (n, joints), and the poses at which they are not valid."""
        everywhere = np.arange(len(self._path.positions))
        between = np.column_stack([np.interp(everywhere, self.links, column) for column in guides.T])
        return joints_along(self._arm, self._path, self._torso_m, between, self._is_free)

    def smoothed(self, guides: FloatArray, joints: FloatArray) -> FloatArray:
        """Return the path with the chain's corners rounded, or unchanged where that makes it invalid."""
        calmer = guides.copy()
        for _ in range(_SMOOTHINGS):
            calmer[1:-1] = 0.25 * calmer[:-2] + 0.5 * calmer[1:-1] + 0.25 * calmer[2:]
        smooth, bad = self.followed(calmer)
        return joints if len(bad) else smooth

    def able(self, link: int) -> tuple[NDArray[np.int64], FloatArray]:
        """Return the samples at a link that do not collide: indices, shape (k,), and joints, (k, joints)."""
        self._test(np.array([link])[~self._is_tested[[link]]])
        which = np.flatnonzero(np.isfinite(self.costs[link]))
        return which, self.samples[link, which]

    def _none(self) -> NoPath:
        inside = links_inside(self.links, self.core)
        blocked = self.links[inside[np.isinf(self.costs[inside]).all(axis=1)]] - self.core[0]
        part = slice(inside[0], inside[-1] + 1)
        spans = self.spans[part][:-1]
        chain = cheapest_chain(self.samples[part], self.costs[part], self.speeds, self.periods, self.jump, spans)
        return NoPath(blocked, is_core=not (len(chain) or self.has_dropped))

    def _strike(self, chain: NDArray[np.int64], bad: NDArray[np.int64], number: int) -> None:
        """Check all samples beside invalid poses, at some tries more of them, and reject those that collide.

        Where none of the chain's samples collides, reject the chain's, so that the search moves on. A lack of any path
        mostly shows at a few links, so some links are checked before the others.
        """
        beside = links_beside(self.links, bad)
        everywhere = np.arange(len(chain))
        taken = everywhere if number in _TESTED_OF else beside
        for tested in (everywhere[:: _TESTED_OF[number]], everywhere) if number in _TESTED_OF else (beside,):
            self._test(np.asarray(tested[~self._is_tested[tested]], dtype=np.int64))
            if np.isinf(self.costs[taken, chain[taken]]).any():
                return
        self.has_dropped = True
        self.costs[taken, chain[taken]] = np.inf

    def _test(self, links: NDArray[np.int64]) -> None:
        rows, columns = np.nonzero(np.isfinite(self.costs[links]))
        tested = links[rows]
        self._is_tested[links] = True
        is_bad = ~self._is_free(self.links[tested], self.samples[tested, columns])
        self.costs[tested[is_bad], columns[is_bad]] = np.inf


def links_inside(links: NDArray[np.int64], core: tuple[int, int]) -> NDArray[np.int64]:
    """Return the indices of the links from the core's first pose to before its end."""
    return np.flatnonzero((links >= core[0]) & (links < core[1]))


def links_beside(links: NDArray[np.int64], poses: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the indices of the links next to the given poses."""
    return np.unique(np.clip(np.searchsorted(links, poses)[:, None] - [0, 1], 0, None))
