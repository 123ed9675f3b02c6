"""The Fold-DAG: the order that folds impose on each other."""

import pytest

from planner.cloth.garment_files import load_garment, shipped_garment_names
from planner.folds.fold_dag import FoldDag, overlap_graph, reduced
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.region import Region
from tests.builders import fold, garment, rectangle, rectangle_points


def dag(*parts: Region, red: tuple[int, ...] = ()) -> FoldDag:
    reds = [i in red for i in range(len(parts))]
    return reduced(overlap_graph(parts, reds), reds)


def test_the_t_shirt_of_figure_2_has_the_edges_of_the_paper() -> None:
    found = FoldSequence.of(load_garment("t-shirt")).dag
    assert found.edges == ((0, 2), (1, 3), (2, 4), (3, 4))
    assert found.folds == 5


@pytest.mark.parametrize("name", ["jeans", "tie", "scarf", "vest", "skirt", "big-towel", "hand-towel"])
def test_halvings_one_after_another_are_a_chain(name: str) -> None:
    found = FoldSequence.of(load_garment(name)).dag
    assert found.edges == tuple((i, i + 1) for i in range(found.folds - 1))


def test_the_sleeves_of_the_shirt_cross_so_the_right_one_waits_for_the_left_side() -> None:
    assert (2, 4) in FoldSequence.of(load_garment("shirt")).dag.edges


def test_folds_apart_wait_for_nothing() -> None:
    found = dag(rectangle(0.1, 0.1), rectangle(0.1, 0.1, 0.5), rectangle(0.1, 0.1, 1.0))
    assert found.edges == ()
    assert found.available(0) == (0, 1, 2)
    assert found.available(0b010) == (0, 2)


def test_folds_that_merely_touch_do_not_wait() -> None:
    assert dag(rectangle(0.1, 0.1), rectangle(0.1, 0.1, 0.1)).edges == ()


def test_a_redundant_edge_is_left_out() -> None:
    found = dag(rectangle(0.3, 0.1), rectangle(0.3, 0.1, 0.1), rectangle(0.3, 0.1, 0.2))
    # All three overlap; 0 -> 2 follows from 0 -> 1 -> 2.
    assert found.edges == ((0, 1), (1, 2))


def test_a_fold_is_available_when_all_that_it_waits_for_is_done() -> None:
    found = FoldDag(chains=((0,), (1,), (2,)), edges=((0, 2), (1, 2)))
    assert found.available(0b000) == (0, 1)
    assert found.available(0b001) == (1,)
    assert found.available(0b011) == (2,)
    assert found.available(0b111) == ()


def test_a_chain_that_is_begun_lets_nothing_else_in() -> None:
    # Fold 1 is red on fold 0; fold 2 is far away and could come at any other time.
    found = dag(rectangle(0.2, 0.1), rectangle(0.1, 0.1), rectangle(0.1, 0.1, 1.0), red=(1,))
    assert found.chains == ((0, 1), (2,))
    assert found.available(0b000) == (0, 2)
    assert found.available(0b001) == (1,)
    assert found.available(0b011) == (2,)
    assert found.available(0b100) == (0,)
    assert found.follows_at_once(0) and not found.follows_at_once(1) and not found.follows_at_once(2)


def test_a_chain_waits_for_what_any_of_its_folds_waits_for() -> None:
    # Fold 2 is red on fold 1 and overlaps fold 0, fold 1 itself does not.
    found = dag(rectangle(0.1, 0.1), rectangle(0.1, 0.1, 0.5), rectangle(0.1, 0.1, 0.05), red=(2,))
    assert (0, 2) in found.edges
    assert found.available(0b000) == (0,)
    assert found.available(0b001) == (1,)


def test_a_red_fold_depends_on_the_one_before_it_even_if_their_parts_are_apart() -> None:
    assert dag(rectangle(0.1, 0.1), rectangle(0.1, 0.1, 1.0), red=(1,)).edges == ((0, 1),)


@pytest.mark.parametrize(("tilt", "edges"), [(2e-4, ()), (1e-3, ((0, 1),))])
def test_a_fold_waits_for_one_without_which_its_line_would_be_snapped_elsewhere(
    tilt: float, edges: tuple[tuple[int, int], ...]
) -> None:
    # A strip 1 cm wide is folded over a line that leans to the left by the tilt, and lands twice the tilt askew: at the
    # upper edge it sticks out by 2 x tilt x 1 cm, 4 um or 20 um. There the line that folds the other corner begins, on
    # the boundary of what is there by then. Without the strip it would begin beside the edge: 10 um do not matter.
    strip, corner = fold((0.01 + 0.25 * tilt, 0.0), (0.01 - 0.25 * tilt, 0.5)), fold((0.019, 0.5), (0.1, 0.424))
    assert FoldSequence.of(garment(rectangle_points(0.1, 0.5), strip, corner)).dag.edges == edges


@pytest.mark.parametrize("name", shipped_garment_names())
def test_an_edge_leads_from_an_earlier_fold_to_a_later_one(name: str) -> None:
    assert all(a < b for a, b in FoldSequence.of(load_garment(name)).dag.edges)


def test_a_garment_without_folds_has_nothing_to_wait_for() -> None:
    sequence = FoldSequence.of(garment(rectangle_points(0.4, 0.3)))
    assert sequence.dag == FoldDag((), ())
    assert sequence.dag.available(0) == ()


def test_the_cloth_after_a_set_of_folds_is_kept() -> None:
    two = garment(rectangle_points(0.4, 0.3), fold((0.1, 0.0), (0.1, 0.3)), fold((0.3, 0.3), (0.3, 0.0)))
    sequence = FoldSequence.of(two)
    assert sequence.cloth(0b10) is sequence.cloth(0b10)
    assert len(sequence.cloth(0b10).layers) == 2 and len(sequence.cloth(0b11).layers) == 3
