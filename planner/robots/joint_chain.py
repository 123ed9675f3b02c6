"""The calmest joint path of an arm whose tool follows a path, or of two arms at once, free of collision.

At every pose of a tool path the arm has many solutions: of seven joints, a curve of them. Taking the solution nearest
to the one before, pose after pose, is short-sighted: the arm runs into a joint's limit, or through the table, and must
jump. So the solutions are sampled at every pose, and dynamic programming finds the cheapest chain through the samples.
A link costs the squared time that the slowest joints need for it; a sample costs more the nearer a joint is to its
limit and the lower the elbow hangs. Links that would be jumps are none.

The samples come from the closed form (`planner.robots.pr2.closed_form_samples`) or from a reach map
(`planner.robots.posture_samples`).

Planning one arm first and the other round it is short-sighted: the calmest path of the first may take the room that the
second needs. So for two arms the same runs on pairs of samples. The costs of pairs and of links are sums over the arms;
so the arms can take a link one after the other, and with m samples each that is 2 m^3 sums, not m^4.
"""

import math

import numpy as np
from numpy.typing import NDArray

from planner.geometry.pose import BoolArray, FloatArray
from planner.kernels import compiled, kernel

LIMIT_COST, NEAR_LIMIT = 0.05, 0.15
"""Cost of a sample with a joint at its limit, and the slack from which it costs nothing."""

ELBOW_COST, ELBOW_CLEAR_M = 2.0, 0.12
"""Cost of an elbow at the floor's height, and the height above it from which it costs nothing (m)."""

_LATE_COST = 100.0
"""Cost of each second that a link exceeds its span."""


@compiled(error_model="numpy")
def link_costs(
    before: FloatArray,
    count: int,
    after: FloatArray,
    speeds: FloatArray,
    periods: FloatArray,
    jump: float,
    span: float,
    costs: FloatArray,
) -> None:
    """Set the summed squared times (s2) that the joints need from each of some samples to another; infinite for a jump.

    Where the slowest joint exceeds the span, the excess costs much more. The loops over samples have no branches, so
    that they are compiled to vector instructions.

    Args:
        before: the samples, one in each column (rad), shape (k, m).
        count: how many of the columns are wanted.
        after: the other sample (rad), shape (k,).
        speeds: the joints' top speeds (rad/s), shape (k,).
        periods: what a joint may be off without any difference (rad), 0 where there is no such; shape (k,).
        jump: the movement of a joint from which a link is a jump (rad; m where it slides).
        span: the longest duration wanted (s).
        costs: overwritten with the costs, shape (2, m); its second row is scratch space.
    """
    cost, slowest = costs[0], costs[1]
    cost[:count] = 0.0
    slowest[:count] = 0.0
    for k in range(len(after)):
        slowness, there, whole = 1.0 / speeds[k], after[k], periods[k]
        for a in range(count):
            turn = there - before[k, a]
            turn = abs(turn - whole * np.floor(turn * (1.0 / math.tau) + 0.5))
            needed = turn * slowness
            slowest[a] = max(slowest[a], needed)
            cost[a] += needed * needed if turn <= jump else math.inf
    for a in range(count):
        cost[a] += _LATE_COST * max(slowest[a] - span, 0.0)


@compiled(error_model="numpy")
def cheapest_chain(
    joints: FloatArray, costs: FloatArray, speeds: FloatArray, periods: FloatArray, jump: float, spans: FloatArray
) -> NDArray[np.int64]:
    """Return the cheapest way through samples, one from each pose.

    Of equally cheap ways to a sample, the one that was cheaper so far is taken.

    Args:
        joints: the samples, shape (n, m, k).
        costs: the samples' costs, shape (n, m); infinite where a sample must not be taken.
        speeds: the joints' top speeds (rad/s), shape (k,).
        periods: what each joint may be off without any difference, see `link_costs`.
        jump: the movement of a joint from which a link is a jump.
        spans: the longest duration wanted for each link (s), shape (n - 1,); infinite where time does not matter.

    Returns:
        The sample at each pose, shape (n,); empty if there is no way.
    """
    count, size = costs.shape
    best, parents = costs[0].copy(), np.full((count, size), -1, dtype=np.int64)
    able, columns, links = np.empty(size, dtype=np.int64), np.empty((joints.shape[2], size)), np.empty((2, size))
    for i in range(1, count):
        so_far, found = best.copy(), 0
        for a in range(size):
            if so_far[a] < np.inf:
                able[found], columns[:, found] = a, joints[i - 1, a]
                found += 1
        best[:] = np.inf
        for b in range(size):
            if costs[i, b] < np.inf:
                link_costs(columns, found, joints[i, b], speeds, periods, jump, spans[i - 1], links)
                for number in range(found):
                    a = able[number]
                    total = so_far[a] + costs[i, b] + links[0, number]
                    if total < best[b] or (total == best[b] < np.inf and so_far[a] < so_far[parents[i, b]]):
                        best[b], parents[i, b] = total, a
    last = int(np.argmin(best))
    if best[last] == np.inf:
        return np.empty(0, dtype=np.int64)
    chain = np.empty(count, dtype=np.int64)
    for i in range(count - 1, -1, -1):
        chain[i] = last
        last = parents[i, last]
    return chain


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
