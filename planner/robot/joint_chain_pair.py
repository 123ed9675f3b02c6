"""Two arms along the paths of their tools: of all pairs of joint paths that keep clear of each other, the calmest.

To lead one arm first and the other round it is short-sighted: the calmest path of the first may take the room that the
second cannot do without. So the dynamic programme of `planner.robot.joint_chain` runs on pairs of samples. What a pair
costs is the sum over its arms, as is what a link costs; so the arms can take a link one after the other, and with m
samples each that is 2 m^3 sums, not m^4.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.robot.joint_chain import link_cost


@njit(cache=True, nogil=True)
def cheapest_chain_pair(
    joints: FloatArray, costs: FloatArray, is_allowed: BoolArray, speeds: FloatArray, spans: FloatArray
) -> NDArray[np.int64]:
    """The cheapest way through pairs of samples, one pair at each pose.

    Args:
        joints: each arm's samples (rad), shape (2, n, m, 7).
        costs: what each costs, shape (2, n, m); infinite where it must not be taken.
        is_allowed: which may be taken together, shape (n, m, m).
        speeds: how fast each joint turns (rad/s), shape (2, 7).
        spans: how long each link may take (s), shape (2, n - 1); infinite where time does not press.

    Returns:
        Each arm's sample at each pose, shape (2, n); shape (2, 0) if there is no way.
    """
    _, count, size = costs.shape
    totals = np.zeros((size, size))
    parents = np.empty((2, count, size, size), dtype=np.int16)
    for i in range(count):
        if i > 0:
            for arm in range(2):
                links = _links(joints[arm, i - 1 : i + 1], costs[arm, i - 1 : i + 1], speeds[arm], spans[arm, i - 1])
                totals = _linked(totals, links, parents[arm, i]).T.copy()
        for a in range(size):
            for b in range(size):
                totals[a, b] += costs[0, i, a] + costs[1, i, b] if is_allowed[i, a, b] else np.inf
    last = int(np.argmin(totals))
    a, b = last // size, last % size
    if totals[a, b] == np.inf:
        return np.empty((2, 0), dtype=np.int64)
    chains = np.empty((2, count), dtype=np.int64)
    for i in range(count - 1, -1, -1):
        chains[0, i], chains[1, i] = a, b
        if i > 0:
            b = parents[1, i, b, a]
            a = parents[0, i, a, b]
    return chains


@njit(cache=True, nogil=True)
def _links(joints: FloatArray, costs: FloatArray, speeds: FloatArray, span: float) -> FloatArray:
    """What the links from an arm's samples at a pose to those at the next cost, shape (m, m)."""
    size = costs.shape[1]
    links = np.full((size, size), np.inf)
    for before in range(size):
        for after in range(size):
            if costs[0, before] < np.inf and costs[1, after] < np.inf:
                links[before, after] = link_cost(joints[0, before], joints[1, after], speeds, span)
    return links


@njit(cache=True, nogil=True)
def _linked(totals: FloatArray, links: FloatArray, parents: NDArray[np.int16]) -> FloatArray:
    """The least totals, shape (m, m), once the arm of the rows has taken a link; from which row each came is noted."""
    size = len(links)
    found = np.full((size, size), np.inf)
    for before in range(size):
        for after in range(size):
            link = links[before, after]
            if link < np.inf:
                for other in range(size):
                    total = totals[before, other] + link
                    if total < found[after, other]:
                        found[after, other] = total
                        parents[after, other] = before
    return found
