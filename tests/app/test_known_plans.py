"""What a document remembers of its plans: of each way the latest, the quickest first."""

from app.known_plans import KnownPlans
from planner import load_garment, make_plan


def test_the_latest_plan_of_each_way_is_known_and_the_quickest_comes_first() -> None:
    cloth = load_garment("hand-towel")
    front, again = make_plan(cloth), make_plan(cloth)
    left = make_plan(cloth, start_station="left")
    assert front.cost_s < left.cost_s, "the drive from the left comes on top"
    known = KnownPlans()
    for plan in (front, left, again):
        known.add(plan)
    assert known.by_cost() == [again, left]
    assert known.by_cost()[0] is again


def test_what_is_no_plan_is_not_known() -> None:
    known = KnownPlans()
    known.add(make_plan(load_garment("scarf-halved")))
    assert known.by_cost() == []


def test_ways_not_met_for_long_are_forgotten() -> None:
    plans = [make_plan(load_garment(name)) for name in ("hand-towel", "vest", "jeans", "skirt", "letter-towel")]
    known = KnownPlans()
    for plan in (*plans[:4], plans[0], plans[4]):
        known.add(plan)
    assert {plan.garment.name for plan in known.by_cost()} == {"hand-towel", "jeans", "skirt", "letter-towel"}
