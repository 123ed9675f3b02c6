"""The orders that a Fold-DAG allows, and folding in one of them."""

from collections.abc import Iterator, Sequence

import networkx as nx

from planner.cloth.cloth_state import ClothState
from planner.folds.fold_cloth import fold_cloth
from planner.folds.fold_dag import FoldDag
from planner.folds.fold_sequence import FoldSequence


def orders(dag: FoldDag, edges: Sequence[tuple[int, int]] | None = None) -> Iterator[list[int]]:
    """Yield every order of the folds that keeps the edges and never interrupts a chain."""
    of_chain = {fold: number for number, chain in enumerate(dag.chains) for fold in chain}
    graph = nx.DiGraph()
    graph.add_nodes_from(range(len(dag.chains)))
    pairs = ((of_chain[a], of_chain[b]) for a, b in (dag.edges if edges is None else edges))
    graph.add_edges_from((a, b) for a, b in pairs if a != b)
    for order in nx.all_topological_sorts(graph):
        yield [fold for number in order for fold in dag.chains[number]]


def replayed(sequence: FoldSequence, order: list[int]) -> ClothState:
    """Return the stack after the folds in an order, each folded anew."""
    cloth = ClothState.spread_out(sequence.garment.pattern)
    for index in order:
        fold = sequence.folds[index]
        crease = sequence.folds[index - 1].line if fold.is_red else None
        cloth = fold_cloth(cloth, fold.line, fold.kind, crease).cloth
    return cloth
