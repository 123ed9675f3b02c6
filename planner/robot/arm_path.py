"""Joints for an arm whose tool follows a path: continuous, within limits, free of collision.

The dynamic programme of `planner.robot.joint_chain` runs on every few poses of the path. Whether a sample collides is
asked only where the chain found does: the samples of those poses are then asked, the colliding ones struck out, and the
chain is found anew, until it is free or none is left. Between its poses the joints keep to the pan of the chain,
smoothed, and follow in closed form, so the tool is exactly where it must be at every pose.
"""

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.robot.joint_chain import cheapest_chain, solutions
from planner.robot.sided_arm import SidedArm
from planner.robot.tool_path import IsFree, NoPath, ToolPath, joints_along

STRIDE = 3
"""Every so many poses the chain has a link."""

_SMOOTHINGS = 6
_TRIES_MAX = 16

_ASKED_OF = {1: 3, 2: 1}
"""At these tries the samples of every so many links are asked: whether there is no way at all soon shows in a few."""


class ArmSearch:
    """The search for one arm's path.

    Attributes:
        links: the poses at which the chain has a link, shape (l,).
        samples: joints that bring the tool there, as the left arm names them (rad), shape (l, m, 7).
        costs: what each costs, shape (l, m); infinite where there is none, and where one has been struck out.
        speeds: how fast the joints turn (rad/s), shape (7,).
        spans: how long each link should take at most (s), shape (l - 1,).
        core: the first of the poses that matter, and the one after their last.
        chain: the sample taken at each link, shape (l,); the cheapest chain of those not struck out.
        has_dropped: whether samples were struck out that do not collide, since no path could be made of them.
    """

    def __init__(
        self, arm: SidedArm, speeds: FloatArray, path: ToolPath, torso_m: float, floor_m: float, is_free: IsFree
    ) -> None:
        """Nothing has been looked for yet.

        Args:
            arm: the arm.
            speeds: how fast its joints turn (rad/s), shape (7,).
            path: where the tool must be.
            torso_m: how far the torso is raised (m).
            floor_m: the height over which elbows had better stay, base frame (m).
            is_free: which joints do not collide.
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
        """The calmest joints that keep the tool on the path (rad), shape (n, 7), or that there are none.

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
        """The chain's joints, continuous ones unwound, shape (l, 7)."""
        guides = self.samples[np.arange(len(chain)), chain]
        for joint in (4, 6):
            guides[:, joint] = np.unwrap(guides[:, joint])
        return guides

    def are_free(self, guides: FloatArray) -> BoolArray:
        """At which links the arm does not collide, shape (l,)."""
        return self._is_free(self.links, self.joints(guides), False)

    def joints(self, guides: FloatArray) -> FloatArray:
        """Guides as this arm names its joints, shape (l, 7)."""
        return self._arm.mirrored_joints(guides)

    def followed(self, guides: FloatArray) -> tuple[FloatArray, NDArray[np.int64]]:
        """The joints along the whole path, shape (n, 7), and the poses at which they will not do."""
        everywhere = np.arange(len(self._positions))
        between = np.column_stack([np.interp(everywhere, self.links, column) for column in guides.T])
        return joints_along(self._arm, self._positions, self._rotations, between, self._is_free)

    def smoothed(self, guides: FloatArray, joints: FloatArray) -> FloatArray:
        """The same path with the pan's corners rounded, as far as that keeps it possible."""
        calmer = guides.copy()
        for _ in range(_SMOOTHINGS):
            calmer[1:-1] = 0.25 * calmer[:-2] + 0.5 * calmer[1:-1] + 0.25 * calmer[2:]
        smooth, bad = self.followed(calmer)
        return joints if len(bad) else smooth

    def able(self, link: int) -> tuple[NDArray[np.int64], FloatArray]:
        """The samples at a link that certainly do not collide: which they are, shape (k,), and their joints (k, 7)."""
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
        """Ask all samples beside bad poses, at some tries more; where nothing collides drop the ones that were taken.

        Whether there is no way at all shows in a few links mostly, so some are asked before the others.
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
    """Of the poses that are links, the numbers of those from one pose on and before another."""
    return np.flatnonzero((links >= core[0]) & (links < core[1]))


def links_beside(links: NDArray[np.int64], poses: NDArray[np.int64]) -> NDArray[np.int64]:
    """Of the poses that are links, the numbers of those next to some poses."""
    return np.unique(np.clip(np.searchsorted(links, poses)[:, None] - [0, 1], 0, None))
