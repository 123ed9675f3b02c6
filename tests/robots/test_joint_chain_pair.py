"""The cheapest pair of chains, against a search through all pairs of samples."""

import math

import networkx as nx
import numpy as np
import pytest

from planner.robots.joint_chain import cheapest_chain, cheapest_chain_pair, link_costs

POSES, SAMPLES = 6, 5
SPEEDS = np.linspace(1.0, 2.0, 14).reshape(2, 7)
JUMP = 0.8
PERIODS = np.where(np.isin(np.arange(14).reshape(2, 7), [4, 6, 11, 13]), math.tau, 0.0)


def _link_cost(before: np.ndarray, after: np.ndarray, speeds: np.ndarray, span: float) -> float:
    costs = np.empty((2, 1))
    link_costs(before[:, None].copy(), 1, after, speeds, PERIODS[0], JUMP, span, costs)
    return float(costs[0, 0])


class ArmQuery:
    """Random samples, some of them forbidden, and some of their pairs."""

    def __init__(self, seed: int, share_allowed: float) -> None:
        rng = np.random.default_rng(seed)
        self.joints = rng.uniform(-0.5, 0.5, (2, POSES, SAMPLES, 7))
        self.costs = np.where(rng.random((2, POSES, SAMPLES)) < 0.2, np.inf, rng.random((2, POSES, SAMPLES)))
        self.is_allowed = rng.random((POSES, SAMPLES, SAMPLES)) < share_allowed
        self.spans = np.where(rng.random((2, POSES - 1)) < 0.5, np.inf, 0.3)

    def found(self) -> np.ndarray:
        return cheapest_chain_pair(self.joints, self.costs, self.is_allowed, SPEEDS, PERIODS, JUMP, self.spans)

    def cost_of(self, chains: np.ndarray) -> float:
        return sum(
            self.node_cost(pose, *chains[:, pose])
            + (self.step_cost(pose, *chains[:, pose - 1 : pose + 1]) if pose else 0)
            for pose in range(POSES)
        )

    def node_cost(self, pose: int, a: int, b: int) -> float:
        return self.costs[0, pose, a] + self.costs[1, pose, b] if self.is_allowed[pose, a, b] else math.inf

    def step_cost(self, pose: int, *ways: np.ndarray | tuple[int, int]) -> float:
        """Return the cost of both arms' motion to a pose from the one before."""
        return sum(
            _link_cost(
                self.joints[arm, pose - 1, before],
                self.joints[arm, pose, after],
                SPEEDS[arm],
                self.spans[arm, pose - 1],
            )
            for arm, (before, after) in enumerate(ways)
        )

    def least_cost(self) -> float:
        """Return the least cost by Dijkstra's search through all pairs."""
        graph = nx.DiGraph()
        graph.add_node("start")
        for pose in range(POSES):
            for a, b in np.ndindex(SAMPLES, SAMPLES):
                cost = self.node_cost(pose, a, b)
                if cost == math.inf:
                    continue
                if pose == 0:
                    graph.add_edge("start", (0, a, b), weight=cost)
                for x, y in np.ndindex(SAMPLES, SAMPLES) if pose else ():
                    step = self.step_cost(pose, (x, a), (y, b))
                    if graph.has_node((pose - 1, x, y)) and step < math.inf:
                        graph.add_edge((pose - 1, x, y), (pose, a, b), weight=cost + step)
                if pose == POSES - 1 and graph.has_node((pose, a, b)):
                    graph.add_edge((pose, a, b), "end", weight=0.0)
        if not graph.has_node("end") or not nx.has_path(graph, "start", "end"):
            return math.inf
        return float(nx.shortest_path_length(graph, "start", "end", weight="weight"))


@pytest.mark.parametrize("share_allowed", [0.2, 0.5, 1.0])
def test_no_pair_of_chains_is_cheaper(share_allowed: float) -> None:
    solved = 0
    for seed in range(12):
        query = ArmQuery(seed, share_allowed)
        chains, least = query.found(), query.least_cost()
        assert bool(chains.size) == (least < math.inf)
        if chains.size:
            assert query.cost_of(chains) == pytest.approx(least, abs=1e-9)
            solved += 1
    assert solved > 0


def test_where_all_pairs_are_allowed_each_chain_is_what_it_is_alone() -> None:
    for seed in range(12):
        query = ArmQuery(seed, 1.1)
        alone = [
            cheapest_chain(query.joints[k], query.costs[k], SPEEDS[k], PERIODS[k], JUMP, query.spans[k]) for k in (0, 1)
        ]
        if all(map(len, alone)):
            np.testing.assert_array_equal(query.found(), alone)


def test_without_a_pair_at_one_pose_there_is_no_way() -> None:
    query = ArmQuery(3, 1.1)
    assert query.found().shape == (2, POSES)
    query.is_allowed[2] = False
    assert query.found().shape == (2, 0)
