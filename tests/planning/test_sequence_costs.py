"""Sequence costs: they count where steps follow one another as charged, and nowhere else."""

from itertools import product
from random import Random

import pytest

from planner.planning.sequence_costs import START, SequenceCosts, Since, StepKey

STEPS: tuple[StepKey, ...] = tuple((kind, (), ()) for kind in "abc")  # type: ignore[misc]
A, B, C = STEPS


def charged(sequence_costs: SequenceCosts, steps: tuple[StepKey, ...]) -> tuple[Since, float]:
    since, total_s = sequence_costs.at_start, 0.0
    for step in steps:
        since, extra_s = sequence_costs.after(since, step)
        total_s += extra_s
    return since, total_s


def test_without_any_nothing_is_remembered() -> None:
    sequence_costs = SequenceCosts()
    assert not sequence_costs
    assert charged(sequence_costs, (A, B, A)) == ((), 0.0)


def test_a_sequence_is_charged_wherever_it_comes_and_only_whole() -> None:
    sequence_costs = SequenceCosts()
    assert not sequence_costs.charge((A, B), 0.5)
    assert sequence_costs and sequence_costs.charge((A, B), 0.5), "it is known by then"
    assert charged(sequence_costs, (B, A, A, B, C, A, B)) == ((), 1.0)
    assert charged(sequence_costs, (B, A, C, B, A)) == ((A,), 0.0)


def test_what_comes_first_may_be_charged_alone() -> None:
    sequence_costs = SequenceCosts()
    sequence_costs.charge((*START, B), 0.25)
    assert charged(sequence_costs, (B, B))[1] == 0.25
    assert charged(sequence_costs, (A, B))[1] == 0.0


def test_nothing_is_charged_for_what_takes_no_longer() -> None:
    sequence_costs = SequenceCosts()
    assert sequence_costs.charge((A, B), 0.0)
    assert not sequence_costs


@pytest.mark.parametrize("seed", range(5))
def test_all_paths_cost_what_their_parts_are_charged(seed: int) -> None:
    rng = Random(seed)
    extras_s = {tuple(rng.choices(STEPS, k=rng.randint(1, 4))): rng.choice((0.5, 1.0, 2.0)) for _ in range(6)}
    sequence_costs = SequenceCosts()
    for steps, extra_s in extras_s.items():
        sequence_costs.charge(steps, extra_s)
    for path in product(STEPS, repeat=6):
        parts = (path[begin:end] for end in range(1, 7) for begin in range(end))
        assert charged(sequence_costs, path)[1] == sum(extras_s.get(part, 0.0) for part in parts)
