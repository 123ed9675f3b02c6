"""The law of the Fold-DAG: every order that it allows leaves the same stack."""

import random
from collections.abc import Iterator, Sequence
from itertools import islice

import networkx as nx
import pytest
from hypothesis import given
from hypothesis import strategies as st

from planner.cloth.cloth_state import ClothState
from planner.cloth.garment import DrawnFold, Garment
from planner.cloth.garment_files import load_garment, shipped_garment_names
from planner.errors import FieldError
from planner.folds.fold_cloth import flap_silhouette, fold_cloth
from planner.folds.fold_dag import FoldDag
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.segment import Segment
from tests.builders import fold, garment, is_same_stack, rectangle_points

T_SHIRT = load_garment("t-shirt").outline
MOST_ORDERS = 60


def orders(dag: FoldDag, edges: Sequence[tuple[int, int]] | None = None) -> Iterator[list[int]]:
    """Every order of the folds that keeps the edges and never interrupts a chain."""
    of_chain = {fold: number for number, chain in enumerate(dag.chains) for fold in chain}
    graph = nx.DiGraph()
    graph.add_nodes_from(range(len(dag.chains)))
    pairs = ((of_chain[a], of_chain[b]) for a, b in (dag.edges if edges is None else edges))
    graph.add_edges_from((a, b) for a, b in pairs if a != b)
    for order in nx.all_topological_sorts(graph):
        yield [fold for number in order for fold in dag.chains[number]]


def replayed(sequence: FoldSequence, order: list[int]) -> ClothState:
    """The stack after the folds in an order, each folded anew."""
    cloth = ClothState.spread_out(sequence.garment.pattern)
    for index in order:
        fold = sequence.folds[index]
        crease = sequence.folds[index - 1].line if fold.is_red else None
        cloth = fold_cloth(cloth, fold.line, is_red=fold.is_red, crease=crease).cloth
    return cloth


def leads_elsewhere(sequence: FoldSequence, order: list[int]) -> bool:
    """Whether an order ends in another stack, or cannot be folded at all."""
    try:
        return not is_same_stack(replayed(sequence, order), sequence.final)
    except FieldError:
        return True


@pytest.mark.parametrize("name", shipped_garment_names())
def test_every_allowed_order_of_a_shipped_garment_leaves_the_same_stack(name: str):
    sequence = FoldSequence.of(load_garment(name))
    for order in orders(sequence.dag):
        assert is_same_stack(replayed(sequence, order), sequence.final), order


@pytest.mark.parametrize("name", shipped_garment_names())
def test_no_edge_of_a_shipped_garment_is_needless(name: str):
    sequence = FoldSequence.of(load_garment(name))
    for edge in sequence.dag.edges:
        if any({*edge} <= {*chain} for chain in sequence.dag.chains):
            continue
        # Without this edge alone: what it implied by way of others stays.
        whole = nx.transitive_closure_dag(nx.DiGraph(sequence.dag.edges))
        rest = [pair for pair in whole.edges if pair != edge]
        others = orders(sequence.dag, rest)
        assert any(leads_elsewhere(sequence, order) for order in others), f"{edge} could go"


@pytest.mark.parametrize("name", shipped_garment_names())
def test_the_cloth_after_a_set_of_folds_is_the_same_whatever_their_order(name: str):
    sequence = FoldSequence.of(load_garment(name))
    for order in islice(orders(sequence.dag), 12):
        done = 0
        for count, index in enumerate(order, start=1):
            done |= 1 << index
            assert is_same_stack(replayed(sequence, order[:count]), sequence.cloth(done)), order[:count]


def drawn_at_random(rng: random.Random, folds: int) -> Garment:
    """A towel or a T-shirt with legal folds from somewhere on the silhouette to somewhere else, some of them red."""
    outline = rng.choice([T_SHIRT, rectangle_points(0.6, 0.4)])
    chosen: list[DrawnFold] = []
    for _ in range(12 * folds):
        if len(chosen) == folds:
            break
        cloth = FoldSequence.of(garment(outline, *chosen)).final
        is_red = bool(chosen) and rng.random() < 0.25
        line = chord(rng, cloth, is_red=is_red)
        if line is None:
            continue
        attempt = [*chosen, fold(line.start, line.end, "red" if is_red else "blue")]
        try:
            FoldSequence.of(garment(outline, *attempt))
        except FieldError:
            continue
        chosen = attempt
    return garment(outline, *chosen)


def chord(rng: random.Random, cloth: ClothState, *, is_red: bool) -> Segment | None:
    """A line across the silhouette whose left part is the smaller one more often than not."""
    shape = flap_silhouette(cloth, is_red=is_red).shape
    if shape.geom_type != "Polygon":
        return None
    start = rng.random()
    shares = (start, (start + rng.uniform(0.05, 0.5)) % 1.0)
    ends = [shape.exterior.interpolate(share, normalized=True).coords[0] for share in shares]
    return Segment(*ends) if ends[0] != ends[1] else None


@given(st.integers(0, 10_000))
def test_every_allowed_order_of_random_folds_leaves_the_same_stack(seed: int):
    sequence = FoldSequence.of(drawn_at_random(random.Random(seed), 4))
    for order in islice(orders(sequence.dag), MOST_ORDERS):
        assert is_same_stack(replayed(sequence, order), sequence.final), order


def test_a_fold_whose_line_ends_on_an_earlier_crease_waits_for_it():
    # The brim's crease ends on the upper edge at x = 0.4. The ear's line begins on it 1 cm before that, 0.25 mm below
    # the upper edge. Before the brim is folded it would begin inside the cloth and part nothing.
    brim, ear = fold((0.0, 0.39), (0.4, 0.4)), fold((0.39, 0.4), (0.6, 0.3))
    sequence = FoldSequence.of(garment(rectangle_points(0.6, 0.4), brim, ear))
    for order in orders(sequence.dag):
        assert is_same_stack(replayed(sequence, order), sequence.final), order
