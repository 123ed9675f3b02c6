"""The calmest collision-free pair of joint paths for two arms whose tools follow paths.

Planning one arm first and the other round it is short-sighted: the calmest path of the first may take the room that the
second needs. So the dynamic programme of `planner.robots.joint_chain` runs on pairs of samples. The costs of pairs and
of links are sums over the arms; so the arms can take a link one after the other, and with m samples each that is 2 m^3
sums, not m^4.
"""

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.kernels import kernel
from planner.robots.joint_chain import link_costs


@kernel
def cheapest_chain_pair(
    joints: FloatArray,
    costs: FloatArray,
    is_allowed: BoolArray,
    speeds: FloatArray,
    periods: FloatArray,
    jump: float,
    spans: FloatArray,
) -> NDArray[np.int64]:
    """Return the cheapest way through pairs of samples, one pair at each pose.

    Args:
        joints: each arm's samples (rad), shape (2, n, m, k).
        costs: the samples' costs, shape (2, n, m); infinite where a sample must not be taken.
        is_allowed: which samples may be taken together, shape (n, m, m).
        speeds: the joints' top speeds (rad/s), shape (2, k).
        periods: what each joint may be off without any difference, shape (2, k); see `link_costs`.
        jump: the movement of a joint from which a link is a jump.
        spans: the longest duration wanted for each link (s), shape (2, n - 1); infinite where time does not matter.

    Returns:
        Each arm's sample at each pose, shape (2, n); shape (2, 0) if there is no way.
    """
    _, count, size = costs.shape
    totals = np.zeros((size, size))
    parents = np.empty((2, count, size, size), dtype=np.int16)
    for i in range(count):
        if i > 0:
            for arm in range(2):
                part = slice(i - 1, i + 1)
                links = _links(joints[arm, part], costs[arm, part], speeds[arm], periods[arm], jump, spans[arm, i - 1])
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


@kernel
def _links(
    joints: FloatArray, costs: FloatArray, speeds: FloatArray, periods: FloatArray, jump: float, span: float
) -> FloatArray:
    """Return the costs of the links from an arm's samples at a pose to those at the next, shape (m, m)."""
    size = costs.shape[1]
    links, columns, found = np.full((size, size), np.inf), joints[0].T.copy(), np.empty((2, size))
    for after in range(size):
        if costs[1, after] < np.inf:
            link_costs(columns, size, joints[1, after], speeds, periods, jump, span, found)
            for before in range(size):
                links[before, after] = found[0, before] if costs[0, before] < np.inf else np.inf
    return links


@kernel
def _linked(totals: FloatArray, links: FloatArray, parents: NDArray[np.int16]) -> FloatArray:
    """Return the least totals, shape (m, m), after a link of the rows' arm; set `parents` to the row each came from."""
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
