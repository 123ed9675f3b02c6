import pytest

from planner import Plan, make_plan
from planner.robots.card import RobotCard
from planner.robots.load_robot import load_robot
from tests.builders import fold, garment


@pytest.fixture(scope="session")
def plan() -> Plan:
    """Return the plan of a napkin that a pair of SO-101 folds twice."""
    outline = [(0.0, 0.0), (0.2, 0.0), (0.2, 0.16), (0.0, 0.16)]
    napkin = garment(outline, fold((0.1, 0.16), (0.1, 0.0)), fold((0.0, 0.08), (0.1, 0.08)))
    found = make_plan(napkin, robot="so101-pair", time_limit_s=60.0)
    assert found.is_solved and len(found.steps) >= 2
    return found


@pytest.fixture(scope="session")
def card() -> RobotCard:
    return load_robot("so101-pair").card
