"""The plans that a document remembers: the latest of each kind, the quickest first."""

import pytest

from app.live_planning import KnownPlans
from planner import load_garment
from tests.planning.found import found_plan
from tests.replay.planned import planned
from tests.required import required


def test_the_latest_plan_of_each_way_is_known_and_the_quickest_comes_first() -> None:
    cloth = load_garment("hand-towel")
    front, again = found_plan(cloth), found_plan(cloth)
    left = found_plan(cloth, start_station="left")
    assert required(front.plan.cost_s) < required(left.plan.cost_s), "the drive from the left comes on top"
    known = KnownPlans()
    for name, found in (("front", front), ("left", left), ("again", again)):
        known.add(name, found)
    assert known.by_cost() == [again, left]
    assert known.by_cost()[0] is again
    assert known.named("again") is again and known.named("left") is left
    assert known.named("front") is None, "another one took its place"


@pytest.mark.long
def test_what_is_no_plan_is_not_known() -> None:
    known = KnownPlans()
    known.add("none", planned("scarf-halved").found)
    assert known.by_cost() == []


def test_ways_not_met_for_long_are_forgotten() -> None:
    plans = [planned(name).found for name in ("hand-towel", "vest", "jeans", "skirt", "letter-towel")]
    known = KnownPlans()
    for number, found in enumerate((*plans[:4], plans[0], plans[4])):
        known.add(str(number), found)
    assert {found.plan.garment.name for found in known.by_cost()} == {"hand-towel", "jeans", "skirt", "letter-towel"}
