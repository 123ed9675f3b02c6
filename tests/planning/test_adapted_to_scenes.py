"""Plans adapted to a scene in which the robot may not stand where it did."""

from dataclasses import replace

import pytest

from planner import Garment, Plan, Scene, Task, find_plan, load_garment, make_plan, quick_plan
from planner.planning.found_plan import FoundPlan
from tests.replay.planned import planned
from tests.required import required

JEANS, SHIRT = load_garment("jeans"), load_garment("t-shirt")


@pytest.fixture(scope="module")
def driving() -> FoundPlan:
    """Return a plan that drives to another station."""
    found = planned("jeans").found
    assert any(p.kind == "move" for p in found.plan.primitives)
    return found


def adapted(cloth: Garment, scene: Scene, known: FoundPlan) -> Plan | None:
    """Return the plan that is found quickly, from a known one."""
    found = quick_plan(Task.of(cloth, scene), like=[known])
    return None if found is None else found.plan


def test_without_the_station_that_it_drove_to_a_plan_goes_on_from_another(driving: FoundPlan) -> None:
    gone_to = {p.base.station for p in driving.plan.primitives if p.kind == "move"}
    # The station is gone, and another one is 2 cm behind it: the jeans cannot be folded from the four that are left.
    left = tuple(station for station in Scene().stations if station[0] not in gone_to)
    others = tuple((f"near_{name}", pose.ahead(-0.02)) for name, pose in Scene().stations if name in gone_to)
    without = Scene(stations=(*left, *others))
    assert len(left) < len(Scene().stations)
    found = adapted(JEANS, without, driving)
    assert found is not None and {p.base.station for p in found.primitives} <= {name for name, _ in without.stations}
    assert required(found.cost_s) >= required(make_plan(JEANS, without).cost_s) - 1e-9


def test_a_station_is_known_by_its_name_wherever_it_is_in_the_list(driving: FoundPlan) -> None:
    turned = Scene(stations=tuple(reversed(Scene().stations)))
    found = adapted(JEANS, turned, driving)
    assert found is not None
    assert [p.base.station for p in found.primitives] == [p.base.station for p in driving.plan.primitives]
    assert found.cost_s == pytest.approx(driving.plan.cost_s)


def test_where_the_base_may_not_back_off_so_far_a_plan_does_without() -> None:
    known = planned("t-shirt").found
    furthest_m = max(p.base.back_off_m for p in known.plan.primitives)
    assert furthest_m > 0.0
    enough = adapted(SHIRT, replace(Scene(), back_off_max_m=furthest_m), known)
    assert enough is not None and enough.cost_s == pytest.approx(known.plan.cost_s)
    still = adapted(SHIRT, replace(Scene(), back_off_max_m=0.0), known)
    assert still is None or all(p.base.back_off_m == 0.0 for p in still.primitives)


def test_the_statistics_of_an_adapted_plan_are_those_of_what_was_looked_at() -> None:
    known = planned("t-shirt").found
    task = Task.of(SHIRT, replace(Scene(), back_off_max_m=0.75))
    found = quick_plan(task, like=[known])
    assert found is not None
    told = found.plan.statistics
    # To do again what n primitives did, n states are looked at or more, and at least one step from each.
    assert told.expanded >= len(known.plan.primitives)
    assert told.explored >= told.expanded
    assert told.ik_queries > 0
    assert told.joint_time_s > 0.0
    proven = find_plan(task, known=found).plan.statistics
    assert proven.expanded >= told.expanded
    assert proven.ik_queries >= told.ik_queries
    assert proven.search_time_s > told.search_time_s
