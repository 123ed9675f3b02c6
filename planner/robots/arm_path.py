"""Joints for an arm whose tool follows a path: continuous, within limits, free of collision.

The dynamic programme of `planner.robots.joint_chain` runs on every few poses of the path. Collisions are checked
lazily: only where the chain found collides are all samples of those poses checked, the colliding ones rejected, and the
chain is searched again, until it is free or no chain is left. Between its poses the joints keep to the smoothed pan of
the chain and follow in closed form, so the tool is exactly on its path at every pose.
"""

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.robots.joint_chain import cheapest_chain, solutions
from planner.robots.sided_arm import SidedArm
from planner.robots.tool_path import IsFree, NoPath, ToolPath, joints_along

STRIDE = 3
"""Poses of the path for each link of the chain."""

_SMOOTHINGS = 6
"""Passes of the filter that rounds the corners of the chain."""

_TRIES_MAX = 16
"""Chains tried before the search gives up."""

_ASKED_OF = {1: 3, 2: 1}
"""By try, the stride over the links whose samples are checked: a few links soon show that there is no path."""


class ArmSearch:
    """The search for one arm's path.

    Attributes:
        links: the poses at which the chain has a link, shape (l,).
        samples: joints that bring the tool there, as the left arm's (rad), shape (l, m, 7).
        costs: the samples' costs, shape (l, m); infinite where there is no sample or it was rejected.
        speeds: the joints' top speeds (rad/s), shape (7,).
        spans: the longest duration wanted for each link (s), shape (l - 1,).
        core: the first of the poses that matter, and the one after their last.
        chain: the sample taken at each link, shape (l,); the cheapest chain of those not rejected.
        has_dropped: whether collision-free samples were rejected because no path could be made of them.
    """

    def __init__(
        self, arm: SidedArm, speeds: FloatArray, path: ToolPath, torso_m: float, floor_m: float, is_free: IsFree
    ) -> None:
        """Prepare the search.

        Args:
            arm: the arm.
            speeds: the joints' top speeds (rad/s), shape (7,).
            path: the tool's path.
            torso_m: how far the torso is raised (m).
            floor_m: the height over which elbows should preferably stay, base frame (m).
            is_free: the check of which joints are collision-free.
        """
        self._arm = arm
        self._is_free = is_free
        self.core = path.core
        shoulder = arm.shoulder(torso_m)
        self._positions = arm.mirrored_places(path.positions) - shoulder
        self._rotations = arm.mirrored_rotations(path.rotations)
        count = len(self._positions)
        self.speeds = speeds
        self.links = np.unique(np.append(np.arange(0, count, STRIDE), count - 1))
        self._floor = floor_m - float(shoulder[2])
        self.samples, self.costs = np.empty((len(self.links), 0, 7)), np.empty((len(self.links), 0))
        self.chain = np.empty(0, dtype=np.int64)
        self.spans = np.add.reduceat(np.append(path.spans_s, 0.0), self.links)[:-1]
        self._is_asked = np.zeros(len(self.links), dtype=bool)
        self.has_dropped = False

    def found(self) -> FloatArray | NoPath:
        """Return the calmest joints that keep the tool on the path (rad), shape (n, 7), or that there are none.

        Forearm and wrist roll are unwound.
        """
        places, axes = self._positions[self.links], self._rotations[self.links]
        self.samples, self.costs = solutions(self._arm.shape, places, axes, self._floor)
        for number in range(_TRIES_MAX):
            self.chain = cheapest_chain(self.samples, self.costs, self.speeds, self.spans)
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
        """Return the chain's joints, continuous ones unwound, shape (l, 7)."""
        guides = self.samples[np.arange(len(chain)), chain]
        for joint in (4, 6):
            guides[:, joint] = np.unwrap(guides[:, joint])
        return guides

    def are_free(self, guides: FloatArray) -> BoolArray:
        """Return at which links the arm does not collide, shape (l,)."""
        return self._is_free(self.links, self.joints(guides), False)

    def joints(self, guides: FloatArray) -> FloatArray:
        """Return guides as this arm's joints, shape (l, 7)."""
        return self._arm.mirrored_joints(guides)

    def followed(self, guides: FloatArray) -> tuple[FloatArray, NDArray[np.int64]]:
        """Return the joints along the whole path, shape (n, 7), and the poses at which they are not valid."""
        everywhere = np.arange(len(self._positions))
        between = np.column_stack([np.interp(everywhere, self.links, column) for column in guides.T])
        return joints_along(self._arm, self._positions, self._rotations, between, self._is_free)

    def smoothed(self, guides: FloatArray, joints: FloatArray) -> FloatArray:
        """Return the path with the pan's corners rounded, or unchanged where that makes it invalid."""
        calmer = guides.copy()
        for _ in range(_SMOOTHINGS):
            calmer[1:-1] = 0.25 * calmer[:-2] + 0.5 * calmer[1:-1] + 0.25 * calmer[2:]
        smooth, bad = self.followed(calmer)
        return joints if len(bad) else smooth

    def able(self, link: int) -> tuple[NDArray[np.int64], FloatArray]:
        """Return the samples at a link that certainly do not collide: their indices, shape (k,), and joints, (k, 7)."""
        self._ask(np.array([link])[~self._is_asked[[link]]])
        which = np.flatnonzero(np.isfinite(self.costs[link]))
        return which, self._arm.mirrored_joints(self.samples[link, which])

    def _none(self) -> NoPath:
        inside = links_inside(self.links, self.core)
        blocked = self.links[inside[np.isinf(self.costs[inside]).all(axis=1)]] - self.core[0]
        part = slice(inside[0], inside[-1] + 1)
        chain = cheapest_chain(self.samples[part], self.costs[part], self.speeds, self.spans[part][:-1])
        return NoPath(blocked, is_core=not (len(chain) or self.has_dropped))

    def _strike(self, chain: NDArray[np.int64], bad: NDArray[np.int64], number: int) -> None:
        """Check all samples beside invalid poses, at some tries more of them, and reject those that collide.

        Where none of the chain's samples collides, reject the chain's, so that the search moves on. A lack of any path
        mostly shows at a few links, so some links are checked before the others.
        """
        beside = links_beside(self.links, bad)
        everywhere = np.arange(len(chain))
        taken = everywhere if number in _ASKED_OF else beside
        for asked in (everywhere[:: _ASKED_OF[number]], everywhere) if number in _ASKED_OF else (beside,):
            self._ask(np.asarray(asked[~self._is_asked[asked]], dtype=np.int64))
            if np.isinf(self.costs[taken, chain[taken]]).any():
                return
        self.has_dropped = True
        self.costs[taken, chain[taken]] = np.inf

    def _ask(self, links: NDArray[np.int64]) -> None:
        rows, columns = np.nonzero(np.isfinite(self.costs[links]))
        asked = links[rows]
        self._is_asked[links] = True
        joints = self._arm.mirrored_joints(self.samples[asked, columns])
        is_bad = ~self._is_free(self.links[asked], joints, True)
        self.costs[asked[is_bad], columns[is_bad]] = np.inf


def links_inside(links: NDArray[np.int64], core: tuple[int, int]) -> NDArray[np.int64]:
    """Return the indices of the links from the core's first pose to before its end."""
    return np.flatnonzero((links >= core[0]) & (links < core[1]))


def links_beside(links: NDArray[np.int64], poses: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return the indices of the links next to the given poses."""
    return np.unique(np.clip(np.searchsorted(links, poses)[:, None] - [0, 1], 0, None))
