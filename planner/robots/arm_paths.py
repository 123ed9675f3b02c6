"""Joints for arms whose tools follow a path each: continuous, within limits, free of collision.

Each arm's path is first found on its own (`planner.robots.arm_path`). Where two arms collide,
`planner.robots.joint_chain` searches for both at once. It starts by allowing every pair of samples; where the
chains found collide, the pairs of those poses are checked, at a few of the poses first, and the search is repeated.
Of three arms and more that collide, one pair after the other is led apart.
"""

from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.robots.arm_path import ArmSearch, links_beside, links_inside
from planner.robots.card import RobotCard
from planner.robots.joint_chain import cheapest_chain_pair
from planner.robots.tool_path import IsFree, NoPath, PathArm, ToolPath

_TRIES_MAX = 24
"""Pairs of chains tried before the search gives up."""

_TESTED_OF = (4, 2, 1)
"""Strides over the poses to be checked: few are checked first, the others only if that changes nothing."""


class Together(Protocol):
    """A check of whether arms collide with each other. Joints are in rad."""

    def arms_apart(self, arms: tuple[int, ...], joints: FloatArray) -> BoolArray:
        """Return in which of some arms' postures these do not touch, shape (m,).

        A posture is one row: the joints of these arms, one arm after the other.
        """
        ...

    def postures_apart(self, arms: tuple[int, int], first: FloatArray, second: FloatArray) -> BoolArray:
        """Return which of k postures of the first arm are clear of which of l of the second, shape (k, l).

        In all postures of an arm its tool is in the same pose.
        """
        ...


def arm_searches(
    arms: Sequence[PathArm],
    card: RobotCard,
    paths: Mapping[int, ToolPath],
    torso_m: float,
    floor_m: float,
    are_free: Mapping[int, IsFree],
) -> dict[int, ArmSearch]:
    """Return the search for the path of each arm that has one; for the arguments see `ArmedRobot.arm_paths`."""
    return {
        arm: ArmSearch(arms[arm], np.array(card.arms[arm].speeds_rad_s), path, float(torso_m), floor_m, are_free[arm])
        for arm, path in paths.items()
    }


def arm_paths(searches: Mapping[int, ArmSearch], together: Together) -> FloatArray | NoPath:
    """Return the joints of least movement that keep all tools on their paths, which have equally many poses.

    Args:
        searches: the search for each arm's path, in rising order of the arms.
        together: the check of whether arms collide with each other.

    Returns:
        Joints (rad), one arm after the other, shape (n, joints), those that turn without end unwound; or that there
        are none.
    """
    stride = min(search.stride for search in searches.values())  # chains are searched in pairs, link by link
    joints: dict[int, FloatArray] = {}
    none: NoPath | None = None
    for arm, search in searches.items():
        found = search.found(stride)
        if not isinstance(found, NoPath):
            joints[arm] = found
        elif none is None or len(found.blocked) < len(none.blocked):
            none = found
        if none is not None and not len(none.blocked):
            return none  # no other arm's answer could say less
    if none is not None:
        return none
    for pair in combinations(searches, 2):
        if not together.arms_apart(pair, np.hstack([joints[arm] for arm in pair])).all():
            first, second = (searches[arm] for arm in pair)
            found = _PairSearch(pair, (first, second), together).found()
            if isinstance(found, NoPath):
                return found
            joints |= zip(pair, np.split(found, [joints[pair[0]].shape[1]], axis=1), strict=True)
    every = np.hstack([*joints.values()])
    if len(joints) > 2 and not together.arms_apart(tuple(joints), every).all():
        return NoPath(np.empty(0, dtype=np.int64), is_core=False)
    return every


class _PairSearch:
    """The search for the paths of two arms that collide on their separate paths."""

    def __init__(self, pair: tuple[int, int], arms: tuple[ArmSearch, ArmSearch], together: Together) -> None:
        self._pair = pair
        self._arms = arms
        self._together = together
        self._links = arms[0].links
        joints, self._size = max(len(arm.speeds) for arm in arms), max(arm.samples.shape[1] for arm in arms)
        self._samples = np.stack([_widened(arm.samples, (len(self._links), self._size, joints), 0.0) for arm in arms])
        self._speeds = np.stack([_widened(arm.speeds, (joints,), 1.0) for arm in arms])
        self._periods = np.stack([_widened(arm.periods, (joints,), 0.0) for arm in arms])
        self._spans = np.stack([arm.spans for arm in arms])
        count = len(self._links)
        self._is_allowed = np.ones((count, self._size, self._size), dtype=np.bool_)
        self._is_tested = np.zeros(count, dtype=bool)
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
        count = samples.shape[1]
        costs = np.stack([_widened(arm.costs[part], (count, self._size), np.inf) for arm in self._arms])
        spans = np.ascontiguousarray(self._spans[:, part][:, : count - 1])
        allowed, jump = self._is_allowed[part], self._arms[0].jump
        return cheapest_chain_pair(samples, costs, allowed, self._speeds, self._periods, jump, spans)

    def _followed(self, guides: list[FloatArray]) -> tuple[FloatArray, NDArray[np.int64]]:
        """Return both arms' joints along the whole path, shape (n, joints), and the poses at which they are invalid."""
        pairs = list(zip(self._arms, guides, strict=True))
        at_links = np.hstack(guides)
        are_free = np.all([arm.are_free(guide) for arm, guide in pairs], axis=0)
        if not (are_free := are_free & self._are_apart(at_links)).all():
            return at_links, self._links[~are_free]
        joints, bad = zip(*(arm.followed(guide) for arm, guide in pairs), strict=True)
        both = np.hstack(joints)
        return both, np.concatenate(bad) if any(map(len, bad)) else np.flatnonzero(~self._are_apart(both))

    def _are_apart(self, joints: FloatArray) -> BoolArray:
        return self._together.arms_apart(self._pair, joints)

    def _strike(self, chains: NDArray[np.int64], bad: NDArray[np.int64]) -> bool:
        """Check the pairs beside invalid poses until a chosen pair is rejected; return false if a link has none left.

        Where every chosen pair passes the checks, reject them all the same, so that the search moves on.
        """
        beside = links_beside(self._links, bad)
        taken = (beside, chains[0, beside], chains[1, beside])
        for step in _TESTED_OF:
            if not all(self._ask(int(link)) for link in beside[::step]):
                return False
            if not self._is_allowed[taken].all():
                return True
        self._has_dropped = True
        self._is_allowed[taken] = False
        return True

    def _ask(self, link: int) -> bool:
        """Check all pairs of samples at a link, once; return whether a pair is collision-free."""
        if not self._is_tested[link]:
            self._is_tested[link] = True
            (rows, left), (columns, right) = (arm.able(link) for arm in self._arms)
            allowed = np.zeros_like(self._is_allowed[link])
            allowed[np.ix_(rows, columns)] = self._together.postures_apart(self._pair, left, right)
            self._is_allowed[link] = allowed
        return bool(self._is_allowed[link].any())

    def _smoothed(self, guides: list[FloatArray], joints: FloatArray) -> FloatArray:
        """Return the paths with the chains' corners rounded, or unchanged where that makes the arms collide."""
        parts = np.split(joints, [len(self._arms[0].speeds)], axis=1)
        smooth = np.hstack(
            [arm.smoothed(guide, part) for arm, guide, part in zip(self._arms, guides, parts, strict=True)]
        )
        return smooth if self._are_apart(smooth).all() else joints

    def _none(self) -> NoPath:
        first, last = zip(*(arm.core for arm in self._arms), strict=True)
        inside = links_inside(self._links, (min(first), max(last)))
        is_blocked = ~self._is_allowed[inside].any(axis=(1, 2))
        core = slice(inside[0], inside[-1] + 1)
        is_core = is_blocked.any() or not (self._has_dropped or self._chains(core).size)
        return NoPath(self._links[inside[is_blocked]] - min(first), bool(is_core))


def _widened(values: FloatArray, shape: tuple[int, ...], fill: float) -> FloatArray:
    """Return values in an array of at least their shape: for samples and joints that an arm does not have."""
    more = [(0, size - own) for size, own in zip(shape, values.shape, strict=True)]
    return np.pad(values, more, constant_values=fill)
