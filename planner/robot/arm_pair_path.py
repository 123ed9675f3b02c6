"""Joints for two arms whose tools follow a path each: continuous, within limits, free of collision.

Each arm is led by itself first (`planner.robot.arm_path`). Where the two come into each other's way they are led
together: by the dynamic programme of `planner.robot.joint_chain_pair`, which knows at first of no pair of samples that
they touch. The pairs are asked where the chains found touch, all of a pose at once, but of a few poses first, and the
chains are found anew.
"""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.robot.arm_path import ArmSearch, links_beside, links_inside
from planner.robot.joint_chain_pair import cheapest_chain_pair
from planner.robot.tool_path import NoPath

_TRIES_MAX = 24

_ASKED_OF = (4, 2, 1)
"""Of the poses to be asked every so many are asked first, those between them if that changes nothing."""


class BothArms(Protocol):
    """What knows whether the arms are in each other's way."""

    def arms_apart(self, joints: FloatArray) -> BoolArray:
        """In which postures, shape (m, 2, 7), no arm touches the other; shape (m,)."""
        ...

    def postures_apart(self, left: FloatArray, right: FloatArray) -> BoolArray:
        """Which postures of the left arm, (k, 7), certainly touch none of which of the right, (l, 7); shape (k, l).

        In all postures of an arm its tool is in the same pose.
        """
        ...


def arm_pair_path(left: ArmSearch, right: ArmSearch, both_arms: BothArms) -> FloatArray | NoPath:
    """The calmest joints that keep both tools on their paths, each as long as the other.

    Args:
        left: the search for the left arm's path.
        right: that for the right arm's.
        both_arms: knows whether the arms are in each other's way.

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
    """The search for the paths of two arms that are in each other's way."""

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
        """The cheapest chains through a part of the links."""
        samples = np.ascontiguousarray(self._samples[:, part])
        costs = np.stack([arm.costs[part] for arm in self._arms])
        spans = np.ascontiguousarray(self._spans[:, part][:, : costs.shape[1] - 1])
        return cheapest_chain_pair(samples, costs, self._is_allowed[part], self._speeds, spans)

    def _followed(self, guides: list[FloatArray]) -> tuple[FloatArray, NDArray[np.int64]]:
        """Both arms' joints along the whole path, shape (n, 2, 7), and the poses at which they will not do."""
        pairs = list(zip(self._arms, guides, strict=True))
        at_links = np.stack([arm.joints(guide) for arm, guide in pairs], axis=1)
        are_free = np.all([arm.are_free(guide) for arm, guide in pairs], axis=0)
        if not (are_free := are_free & self._both_arms.arms_apart(at_links)).all():
            return at_links, self._links[~are_free]
        joints, bad = zip(*(arm.followed(guide) for arm, guide in pairs), strict=True)
        both = np.stack(joints, axis=1)
        return both, np.concatenate(bad) if any(map(len, bad)) else np.flatnonzero(~self._both_arms.arms_apart(both))

    def _strike(self, chains: NDArray[np.int64], bad: NDArray[np.int64]) -> bool:
        """Ask the pairs beside bad poses until some that were taken touch; false once no pair is left somewhere.

        Where none of those that were taken touches they are dropped.
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
        """Ask all pairs of samples at a link, once; whether there is one that does not touch."""
        if not self._is_asked[link]:
            self._is_asked[link] = True
            (rows, left), (columns, right) = (arm.able(link) for arm in self._arms)
            allowed = np.zeros_like(self._is_allowed[link])
            allowed[np.ix_(rows, columns)] = self._both_arms.postures_apart(left, right)
            self._is_allowed[link] = allowed
        return bool(self._is_allowed[link].any())

    def _smoothed(self, guides: list[FloatArray], joints: FloatArray) -> FloatArray:
        """The same paths with the pans' corners rounded, where that keeps the arms apart."""
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
