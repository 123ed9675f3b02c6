"""A plan adapted to a scene in which the robot may not stand where it did."""

from dataclasses import replace

import pytest

from planner import Plan, Scene, adapt_plan, load_garment, make_plan

JEANS, SHIRT = load_garment("jeans"), load_garment("t-shirt")


@pytest.fixture(scope="module")
def driving() -> Plan:
    """A plan that drives to another station."""
    plan = make_plan(JEANS, time_limit_s=60.0)
    assert any(p.kind == "move" for p in plan.primitives)
    return plan


def test_without_the_station_that_it_drives_to_a_plan_cannot_be_adapted(driving: Plan):
    gone_to = {p.base.station for p in driving.primitives if p.kind == "move"}
    without = tuple(station for station in Scene().stations if station[0] not in gone_to)
    assert len(without) < len(Scene().stations)
    assert adapt_plan(driving, JEANS, Scene(stations=without)) is None


def test_a_station_is_known_by_its_name_wherever_it_is_in_the_list(driving: Plan):
    turned = Scene(stations=tuple(reversed(Scene().stations)))
    found = adapt_plan(driving, JEANS, turned)
    assert found is not None
    assert [p.base.station for p in found.primitives] == [p.base.station for p in driving.primitives]
    assert found.cost_s == pytest.approx(driving.cost_s)


def test_where_the_base_may_not_back_off_so_far_a_plan_cannot_be_adapted():
    plan = make_plan(SHIRT, time_limit_s=60.0)
    furthest_m = max(p.base.back_off_m for p in plan.primitives)
    assert furthest_m > 0.0
    assert adapt_plan(plan, SHIRT, replace(Scene(), back_off_max_m=0.0)) is None
    assert adapt_plan(plan, SHIRT, replace(Scene(), back_off_max_m=furthest_m)) is not None
