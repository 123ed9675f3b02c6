"""Joints for two arms whose tools follow a path each: continuous, within limits, free of collision.

Each arm's path is first found on its own (`planner.robots.arm_path`). Where the arms collide,
`planner.robots.joint_chain_pair` searches for both at once. It starts by allowing every pair of samples; where the
chains found collide, the pairs of those poses are checked, at a few of the poses first, and the search is repeated.
"""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.robots.arm_path import ArmSearch, links_beside, links_inside
from planner.robots.joint_chain_pair import cheapest_chain_pair
from planner.robots.tool_path import NoPath

_TRIES_MAX = 24
"""Pairs of chains tried before the search gives up."""

_ASKED_OF = (4, 2, 1)
"""Strides over the poses to be checked: few are checked first, the others only if that changes nothing."""


class BothArms(Protocol):
    """A check of whether the arms collide with each other."""

    def arms_apart(self, joints: FloatArray) -> BoolArray:
        """Return in which postures, shape (m, 2, 7), the arms do not touch, shape (m,)."""
        ...

    def postures_apart(self, left: FloatArray, right: FloatArray) -> BoolArray:
        """Return which postures of the left arm, (k, 7), are certainly clear of which of the right, (l, 7): (k, l).

        In all postures of an arm its tool is in the same pose.
        """
        ...


def arm_pair_path(left: ArmSearch, right: ArmSearch, both_arms: BothArms) -> FloatArray | NoPath:
    """Return the calmest joints that keep both tools on their paths, which have equally many poses.

    Args:
        left: the search for the left arm's path.
        right: the search for the right arm's path.
        both_arms: the check of whether the arms collide with each other.

    Returns:
        Joints (rad), shape (n, 2, 7), forearm and wrist roll unwound; or that there are none.
    """
    alone = [left.found(), right.found()]
    joints = [found for found in alone if not isinstance(found, NoPath)]
    if len(joints) < len(alone):
        return min((found for found in alone if isinstance(found, NoPath)), key=lambda none: len(none.blocked))
    both = np.stack(joints, axis=1)
    return both if both_arms.arms_apart(both).all() else _PairSearch((left, right), both_arms).found()


class _PairSearch:
    """The search for the paths of two arms that collide on their separate paths."""

    def __init__(self, arms: tuple[ArmSearch, ArmSearch], both_arms: BothArms) -> None:
        self._arms = arms
        self._both_arms = both_arms
        self._links = arms[0].links
        self._samples = np.stack([arm.samples for arm in arms])
        self._speeds = np.stack([arm.speeds for arm in arms])
        self._spans = np.stack([arm.spans for arm in arms])
        count, size = arms[0].costs.shape
        self._is_allowed = np.ones((count, size, size), dtype=np.bool_)
        self._is_asked = np.zeros(count, dtype=bool)
        self._has_dropped = any(arm.has_dropped for arm in arms)

    def found(self) -> FloatArray | NoPath:
        chains = np.stack([arm.chain for arm in self._arms])
        for _ in range(_TRIES_MAX):
            guides = [arm.guides(chain) for arm, chain in zip(self._arms, chains, strict=True)]
            joints, bad = self._followed(guides)
            if not len(bad):
                return self._smoothed(guides, joints)
            if not self._strike(chains, bad):
                break
            chains = self._chains(slice(None))
            if not chains.size:
                break
        return self._none()

    def _chains(self, part: slice) -> NDArray[np.int64]:
        """Return the cheapest chains through a part of the links."""
        samples = np.ascontiguousarray(self._samples[:, part])
        costs = np.stack([arm.costs[part] for arm in self._arms])
        spans = np.ascontiguousarray(self._spans[:, part][:, : costs.shape[1] - 1])
        return cheapest_chain_pair(samples, costs, self._is_allowed[part], self._speeds, spans)

    def _followed(self, guides: list[FloatArray]) -> tuple[FloatArray, NDArray[np.int64]]:
        """Return both arms' joints along the whole path, shape (n, 2, 7), and the poses at which they are not valid."""
        pairs = list(zip(self._arms, guides, strict=True))
        at_links = np.stack([arm.joints(guide) for arm, guide in pairs], axis=1)
        are_free = np.all([arm.are_free(guide) for arm, guide in pairs], axis=0)
        if not (are_free := are_free & self._both_arms.arms_apart(at_links)).all():
            return at_links, self._links[~are_free]
        joints, bad = zip(*(arm.followed(guide) for arm, guide in pairs), strict=True)
        both = np.stack(joints, axis=1)
        return both, np.concatenate(bad) if any(map(len, bad)) else np.flatnonzero(~self._both_arms.arms_apart(both))

    def _strike(self, chains: NDArray[np.int64], bad: NDArray[np.int64]) -> bool:
        """Check the pairs beside invalid poses until a chosen pair is rejected; return false if a link has none left.

        Where every chosen pair passes the checks, reject them all the same, so that the search moves on.
        """
        beside = links_beside(self._links, bad)
        taken = (beside, chains[0, beside], chains[1, beside])
        for step in _ASKED_OF:
            if not all(self._ask(int(link)) for link in beside[::step]):
                return False
            if not self._is_allowed[taken].all():
                return True
        self._has_dropped = True
        self._is_allowed[taken] = False
        return True

    def _ask(self, link: int) -> bool:
        """Check all pairs of samples at a link, once; return whether a pair is collision-free."""
        if not self._is_asked[link]:
            self._is_asked[link] = True
            (rows, left), (columns, right) = (arm.able(link) for arm in self._arms)
            allowed = np.zeros_like(self._is_allowed[link])
            allowed[np.ix_(rows, columns)] = self._both_arms.postures_apart(left, right)
            self._is_allowed[link] = allowed
        return bool(self._is_allowed[link].any())

    def _smoothed(self, guides: list[FloatArray], joints: FloatArray) -> FloatArray:
        """Return the paths with the pans' corners rounded, or unchanged where that makes the arms collide."""
        each = [
            arm.smoothed(guide, joints[:, k]) for k, (arm, guide) in enumerate(zip(self._arms, guides, strict=True))
        ]
        smooth = np.stack(each, axis=1)
        return smooth if self._both_arms.arms_apart(smooth).all() else joints

    def _none(self) -> NoPath:
        first, last = zip(*(arm.core for arm in self._arms), strict=True)
        inside = links_inside(self._links, (min(first), max(last)))
        is_blocked = ~self._is_allowed[inside].any(axis=(1, 2))
        core = slice(inside[0], inside[-1] + 1)
        is_core = is_blocked.any() or not (self._has_dropped or self._chains(core).size)
        return NoPath(self._links[inside[is_blocked]] - min(first), bool(is_core))
