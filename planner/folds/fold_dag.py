"""The Fold-DAG: the order in which folds must precede each other (paper, section 5.1)."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import networkx as nx

from planner.geometry.region import Region

_FEW_SETS = 64
"""The number of sets of folds done up to which a search can visit all, wherever cloth and robot are."""


@dataclass(frozen=True)
class FoldDag:
    """The order of folds: a fold waits for every earlier fold whose folded part its own overlaps.

    A blue fold and the red folds that follow it form a chain that nothing interrupts.

    Attributes:
        chains: each chain's folds in order; every fold is in one.
        edges: pairs (a, b), a before b, without redundant ones, in ascending order.
    """

    chains: tuple[tuple[int, ...], ...]
    edges: tuple[tuple[int, int], ...]

    @property
    def folds(self) -> int:
        """The number of folds."""
        return sum(len(chain) for chain in self.chains)

    def to_dict(self) -> dict[str, Any]:
        """Return the DAG as JSON."""
        return {"folds": self.folds, "edges": [list(edge) for edge in self.edges]}

    def available(self, done: int) -> tuple[int, ...]:
        """Return the folds that may come next.

        Args:
            done: the folds finished, as a bit mask.
        """
        last = self.last_of_begun_chain(done)
        if last is not None:
            return (last + 1,)
        open_chains = (c for c in self.chains if not done >> c[0] & 1)
        return tuple(c[0] for c in open_chains if self._is_free(c, done))

    @cached_property
    def is_loose(self) -> bool:
        """Whether so few folds wait for others that many different sets of folds may be done first."""
        return self.sets_before(self.folds, _FEW_SETS) is None

    def sets_before(self, fold: int, at_most: int) -> tuple[int, ...] | None:
        """Return every set of finished folds, as a bit mask, after which a fold may come next.

        None if more than `at_most` sets were visited.
        """
        seen, front, found = {0}, [0], []
        while front:
            done = front.pop()
            available = self.available(done)
            if fold in available:
                found.append(done)
            for other in available:
                after = done | 1 << other
                if other != fold and after not in seen:
                    seen.add(after)
                    front.append(after)
            if len(seen) > at_most:
                return None
        return tuple(sorted(found))

    def before(self, fold: int) -> set[int]:
        """Return all folds that must precede one; a whole chain waits for whatever one of its folds waits for."""
        chain_of = {f: chain for chain in self.chains for f in chain}
        found: set[int] = set()
        front = [fold]
        while front:
            chain = chain_of[front.pop()]
            for earlier in (a for a, b in self.edges if b in chain and a not in chain and a not in found):
                found.update(chain_of[earlier])
                front.append(earlier)
        own = chain_of[fold]
        return found | set(own[: own.index(fold)])

    def last_of_begun_chain(self, done: int) -> int | None:
        """Return the last fold done of an unfinished chain; None if there is no such chain."""
        for chain in self.chains:
            finished = [i for i in chain if done >> i & 1]
            if 0 < len(finished) < len(chain):
                return finished[-1]
        return None

    def follows_at_once(self, fold: int) -> bool:
        """Return whether a red fold comes directly after this one."""
        return any(fold in chain[:-1] for chain in self.chains)

    def _is_free(self, chain: tuple[int, ...], done: int) -> bool:
        before = (a for a, b in self.edges if b in chain and a not in chain)
        return all(done >> a & 1 for a in before)


def overlap_graph(folded_parts: Sequence[Region], red: Sequence[bool]) -> "nx.DiGraph[int]":
    """Return the folds' dependencies: overlapping parts, and red folds that follow at once.

    Args:
        folded_parts: for each fold the region that its part covers before and after it moves, garment frame.
        red: for each fold whether it is red.
    """
    graph: nx.DiGraph[int] = nx.DiGraph()
    graph.add_nodes_from(range(len(folded_parts)))
    for b, part in enumerate(folded_parts):
        if red[b]:
            graph.add_edge(b - 1, b)
        for a in range(b):
            if not part.intersection(folded_parts[a]).is_sliver:
                graph.add_edge(a, b)
    return graph


def reduced(graph: "nx.DiGraph[int]", red: Sequence[bool]) -> FoldDag:
    """Return the Fold-DAG of a graph of dependencies, without redundant ones."""
    return FoldDag(_chains(red), tuple(sorted(nx.transitive_reduction(graph).edges)))


def _chains(red: Sequence[bool]) -> tuple[tuple[int, ...], ...]:
    chains: list[list[int]] = []
    for index, is_red in enumerate(red):
        if is_red:
            chains[-1].append(index)
        else:
            chains.append([index])
    return tuple(tuple(chain) for chain in chains)
