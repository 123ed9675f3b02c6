"""Laws of plans for random hoods, ponchos and jumpers with four to eight folds, many of them in a long run."""

from random import Random
from time import process_time

import pytest

from planner import deadline
from tests.laws.plan_laws import LAWS, differences
from tests.laws.wear import wear_task


@pytest.mark.long
@pytest.mark.parametrize("seed", range(100))
def test_a_hood_a_poncho_and_a_jumper_keep_the_laws_of_plans(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(deadline, "clock_s", process_time)  # work ends a search, however busy the machine is
    found = differences(wear_task(Random(seed)), seed, tuple(LAWS))
    assert not {name: broken for name, broken in found.by_law.items() if broken}


@pytest.mark.long
@pytest.mark.parametrize(
    ("seed", "law", "gap_s"),
    [
        pytest.param(522, "cone", 0.1, id="hands that go round the table's edge"),
        pytest.param(800, "cone", 5.0, id="ways home that only sampling finds"),
        pytest.param(800, "mirror", 5.0, id="the same, mirrored"),
    ],
)
def test_a_plan_keeps_a_law_where_most_ways_are_rejected(
    seed: int, law: str, gap_s: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(deadline, "clock_s", process_time)
    found = differences(wear_task(Random(seed)), seed, (law,))
    assert found.gap_s < gap_s and not found.by_law[law]


def test_the_garments_have_four_to_eight_folds_and_are_of_three_kinds() -> None:
    garments = [wear_task(Random(seed)).garment for seed in range(40)]
    assert {len(garment.folds) for garment in garments} <= set(range(4, 9))
    assert len({len(garment.outline) for garment in garments}) >= 3


def test_each_law_says_by_how_much_plans_differ() -> None:
    assert {"mirror", "turn", "redraw", "order", "tail", "h=0", "comfort", "friction", "stations"} <= LAWS.keys()
