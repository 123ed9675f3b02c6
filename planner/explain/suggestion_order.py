"""Suggest another order of the same folds.

The planner already tries every order that the Fold-DAG allows; they all give the same stack. So only orders are worth
trying that give another DAG, hence other layers, and still the same outline in the end.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import combinations

from planner.cloth.garment import Garment
from planner.errors import FieldError
from planner.explain.suggestion_trial import Search, SuggestionTrial, each_cheaper
from planner.folds.fold_sequence import FoldSequence
from planner.geometry.region import Region
from planner.message import Message
from planner.task.task import Task
from planner.words.catalogue import worded

SWAPS_MAX = 3
"""Swaps of neighbours between the user's order and an order that is tried, at most."""

ORDERS_MAX = 60
"""Orders that are looked at."""

Chain = tuple[int, ...]
"""A blue fold and the red folds that follow it, by their indices."""


@dataclass(frozen=True, slots=True)
class _Order:
    """An order of a garment's folds, in which chains of red folds stay whole.

    Attributes:
        chains: the folds, numbered as the user drew them.
        swaps: the number of swaps of neighbours from the user's order.
    """

    chains: tuple[Chain, ...]
    swaps: int

    @property
    def folds(self) -> tuple[int, ...]:
        return tuple(fold for chain in self.chains for fold in chain)

    def neighbours(self) -> Iterator["_Order"]:
        for i in range(len(self.chains) - 1):
            first, second = self.chains[i : i + 2]
            yield _Order((*self.chains[:i], second, first, *self.chains[i + 2 :]), self.swaps + 1)


def orders(task: Task) -> Search:
    """Look for another order that gives a plan, the fewest swaps first; then for cheaper ones."""
    return each_cheaper(_trial(task, order, garment) for order, garment in _other_orders(task.garment))


def _trial(task: Task, order: _Order, garment: Garment) -> SuggestionTrial:
    says = _in_words(task.garment, order)
    return SuggestionTrial("order", says, {"garment": garment.to_dict()}, order.swaps, replace(task, garment=garment))


def _other_orders(garment: Garment) -> Iterator[tuple[_Order, Garment]]:
    """Yield legal orders with the same outline in the end, one for each other DAG."""
    sequence = FoldSequence.of(garment)
    wanted = sequence.final.silhouette
    seen_dags = {frozenset(sequence.dag.edges)}
    for order in _by_swaps(sequence.dag.chains):
        changed = replace(garment, folds=tuple(garment.folds[i] for i in order.folds))
        found = _replayed(changed)
        if found is None:
            continue
        edges = frozenset((order.folds[a], order.folds[b]) for a, b in found.dag.edges)
        if edges not in seen_dags and _is_same(wanted, found.final.silhouette):
            seen_dags.add(edges)
            yield order, changed


def _by_swaps(chains: Sequence[Chain]) -> Iterator[_Order]:
    """Yield orders by the number of swaps, without the user's own."""
    front = [_Order(tuple(chains), 0)]
    seen = {front[0].chains}
    while front and len(seen) <= ORDERS_MAX:
        order = front.pop(0)
        for other in order.neighbours():
            if other.chains not in seen and other.swaps <= SWAPS_MAX:
                seen.add(other.chains)
                front.append(other)
                yield other


def _replayed(garment: Garment) -> FoldSequence | None:
    try:
        return FoldSequence.of(garment)
    except FieldError:
        return None


def _is_same(one: Region, other: Region) -> bool:
    return one.difference(other).is_sliver and other.difference(one).is_sliver


def _in_words(garment: Garment, order: _Order) -> Message:
    turned = [(later, earlier) for later, earlier in combinations(order.folds, 2) if later > earlier]
    if len(turned) == 1:
        later, earlier = turned[0]
        return worded("fold_before", {"fold": later, "before": earlier}, garment.folds)
    return worded("fold_in_order", {"folds": list(order.folds)}, garment.folds)
