import pytest

from planner import Plan
from planner.robots.card import RobotCard
from planner.robots.load_robot import load_robot
from tests.small_plan import napkin_plan


@pytest.fixture(scope="session")
def plan() -> Plan:
    return napkin_plan()


@pytest.fixture(scope="session")
def card() -> RobotCard:
    return load_robot("so101-pair").card
