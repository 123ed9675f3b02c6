"""The law of the Fold-DAG: every order that it allows leaves the same stack."""

from dataclasses import replace
from itertools import islice
from random import Random

import networkx as nx
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from planner.cloth.garment import Garment
from planner.cloth.garment_files import load_garment, shipped_garment_names
from planner.errors import FieldError
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.tolerance import LENGTH_M
from tests.builders import fold, garment, is_same_region, is_same_stack, rectangle_points
from tests.laws.drawings import folded
from tests.laws.fold_orders import orders, replayed
from tests.laws.law import law
from tests.laws.outlines import outlines

T_SHIRT = load_garment("t-shirt").outline
MOST_ORDERS = 24


def leads_elsewhere(sequence: FoldSequence, order: list[int]) -> bool:
    """Return whether an order ends in another stack, or cannot be folded at all."""
    try:
        return not is_same_stack(replayed(sequence, order), sequence.final)
    except FieldError:
        return True


@pytest.mark.parametrize("name", shipped_garment_names())
def test_every_allowed_order_of_a_shipped_garment_leaves_the_same_stack(name: str) -> None:
    sequence = FoldSequence.of(load_garment(name))
    for order in orders(sequence.dag):
        assert is_same_stack(replayed(sequence, order), sequence.final), order


@pytest.mark.parametrize("name", shipped_garment_names())
def test_no_edge_of_a_shipped_garment_is_needless(name: str) -> None:
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
def test_the_cloth_after_a_set_of_folds_is_the_same_whatever_their_order(name: str) -> None:
    sequence = FoldSequence.of(load_garment(name))
    for order in islice(orders(sequence.dag), 12):
        done = 0
        for count, index in enumerate(order, start=1):
            done |= 1 << index
            assert is_same_stack(replayed(sequence, order[:count]), sequence.cloth(done)), order[:count]


OUTLINES = st.one_of(st.just(T_SHIRT), st.just(rectangle_points(0.6, 0.4)), outlines(most=12))
GARMENTS = OUTLINES.flatmap(lambda outline: folded(outline, most_folds=5, least_folds=2))


# The last line meets the crease of the red fold at an angle of less than a degree.
SHARP = garment(
    ((0.2, 0.4), (0.45, 0.1), (0.2, 0.2)),
    fold((0.269, 0.172), (0.2, 0.241)),
    fold((0.3108811830920022, 0.26695818028959734), (0.2, 0.3756534258962093)),
    fold((0.48, 0.133), (0.395, 0.2), "red"),
    fold((0.395, 0.2), (0.2, 0.396)),
    fold((0.481, 0.133), (0.436, 0.167)),
)

# The red fold's part only touches what the blue one left.
TOUCHING = garment(T_SHIRT, fold((0.587, 0.503), (-0.129, 0.503)), fold((-0.027, 0.587), (0.559, 0.587), "red"))


@example(SHARP)
@example(TOUCHING)
@given(GARMENTS)
@law("geometry", short=40, long=2000)
def test_every_allowed_order_of_random_folds_leaves_the_same_stack(cloth: Garment) -> None:
    sequence = FoldSequence.of(cloth)
    for order in islice(orders(sequence.dag), MOST_ORDERS):
        assert is_same_stack(replayed(sequence, order), sequence.final), order


@given(GARMENTS, st.randoms(use_true_random=False))
@law("geometry", short=20, long=1000)
def test_folds_given_in_another_order_wait_for_the_same_ones(cloth: Garment, rng: Random) -> None:
    sequence = FoldSequence.of(cloth)
    order = rng.choice(list(islice(orders(sequence.dag), MOST_ORDERS)))
    lines = {fold.index: fold.line for fold in sequence.folds}
    drawn = [replace(cloth.folds[i], start=lines[i].start, end=lines[i].end) for i in order]
    other = FoldSequence.of(replace(cloth, folds=tuple(drawn)))
    renumbered = nx.DiGraph([(order[a], order[b]) for a, b in other.dag.edges])
    assert set(nx.transitive_closure(renumbered).edges) == set(
        nx.transitive_closure(nx.DiGraph(sequence.dag.edges)).edges
    )
    assert is_same_stack(other.final, sequence.final)


@example(SHARP)
@given(GARMENTS)
@law("geometry", short=20, long=1000)
def test_a_fold_moves_the_same_part_and_stays_within_the_same_extent_whatever_was_done_before(cloth: Garment) -> None:
    sequence = FoldSequence.of(cloth)
    low, high = sequence.covered.min(axis=0), sequence.covered.max(axis=0)
    for order in islice(orders(sequence.dag), MOST_ORDERS):
        done = 0
        for index in order:
            assert is_same_region(sequence.folded(done, index).moving, sequence.moving(index)), (order, index)
            done |= 1 << index
            covered = sequence.cloth(done).silhouette.coordinates
            assert (covered >= low - LENGTH_M).all() and (covered <= high + LENGTH_M).all(), (order, index)


def test_a_fold_whose_line_ends_on_an_earlier_crease_waits_for_it() -> None:
    # The brim's crease ends on the upper edge at x = 0.4. The ear's line begins on it 1 cm before that, 0.25 mm below
    # the upper edge. Before the brim is folded it would begin inside the cloth and part nothing.
    brim, ear = fold((0.0, 0.39), (0.4, 0.4)), fold((0.39, 0.4), (0.6, 0.3))
    sequence = FoldSequence.of(garment(rectangle_points(0.6, 0.4), brim, ear))
    for order in orders(sequence.dag):
        assert is_same_stack(replayed(sequence, order), sequence.final), order
