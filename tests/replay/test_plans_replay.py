"""Every plan of a shipped garment replays in a checker that shares no code with the planner."""

import pytest

from tests.replay.checker import check
from tests.replay.planned import SOLVABLE, planned

each_solvable = pytest.mark.parametrize("name", SOLVABLE)


@each_solvable
def test_the_plan_of_a_shipped_garment_replays(name: str) -> None:
    case = planned(name)
    check(case.garment, case.scene, case.plan)
