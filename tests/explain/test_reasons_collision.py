"""Arms that collide while they drag the cloth: the reason names the fold that the drag would serve."""

import math

import pytest

from planner import Plan, Scene
from planner.geometry.pose import FloatArray, Pose2
from planner.geometry.table import Table
from planner.planning import problem
from planner.primitives.obstacle import BlockingContact, Obstacle, Obstacles
from planner.primitives.state import State
from planner.robots.collision.collisions import Contact
from planner.robots.pr2.robot import Pr2
from planner.task.reason import Code
from tests.planning.test_motion_validator import (
    HALF,
    IDLE_S,
    STATIONS,
    BarredCollisions,
    BarredRobot,
    barred,
    napkin,
    planned,
)

FRONT_X = -0.95

JUST_TOO_FAR, FAR_TOO_FAR = -0.35, -0.22
"""Where the near edge of the napkin lies (m): at its far edge, 0.3 m further, the hands must lay it down. One drag
brings that into reach, or it takes two."""

NAPKIN_START = State(0, (0.0, 0.0), 0, 0)


def front_alone(back_off_max_m: float) -> Scene:
    return Scene(stations=STATIONS[:1], back_off_max_m=back_off_max_m, arm_motion_s=IDLE_S)


class HinderedCollisions(BarredCollisions):
    """Collisions of arms with a bar at every place of the base, deeper the further the base stands back."""

    def deepest_contact(self, base_in_table: Pose2, joints: FloatArray) -> Contact | None:
        return Contact("left forearm", "bar", 0.01 + FRONT_X - base_in_table.x_m)


class HinderedRobot(BarredRobot):
    def collisions(  # type: ignore[override]
        self, table: Table, torso_m: float, *args: float, **options: float
    ) -> HinderedCollisions:
        return HinderedCollisions(Pr2.collisions(self, table, torso_m, *args, **options), self._is_barred)


def refused(x_m: float, back_off_max_m: float) -> Plan:
    """Return the answer for a napkin that a robot without obstacles could fold."""
    plan = planned(napkin(HALF, x_m=x_m), front_alone(back_off_max_m))
    assert plan.status == "infeasible"
    return plan


def test_a_drag_that_the_arms_cannot_make_is_the_reason_for_the_fold_that_needs_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    open_way = planned(napkin(HALF, x_m=JUST_TOO_FAR), front_alone(0.1))
    assert [p.kind for p in open_way.primitives] == ["drag", "fold"]
    barred(monkeypatch, lambda arm, base: True)
    (reason,) = refused(JUST_TOO_FAR, 0.1).reasons
    assert (reason.fold, reason.code, reason.station) == (0, Code.COLLISION, "front")
    assert reason.message.startswith("fold 0 'half': to drag the cloth by (-0.10, 0.00) m, from front ")
    assert (reason.point, reason.short_by_m, reason.offset_m) == (None, None, (0.0, 0.0))


def test_where_the_arms_collide_in_a_drag_the_cloth_has_come_as_far_as_the_hand(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(problem, "load_robot", lambda name: HinderedRobot(lambda arm, base: True))
    (reason,) = refused(JUST_TOO_FAR, 0.1).reasons
    # It is worst at the drag's end, 0.1 m behind where it began: at the station, where the base is least far back. The
    # left hand has the near corner there, which lay at (-0.35, 0.15), 2 cm over the table.
    assert (reason.code, reason.arm, reason.station) == (Code.COLLISION, "left", "front")
    assert reason.point == pytest.approx((JUST_TOO_FAR - 0.1, 0.15, 0.02))
    assert reason.offset_m == pytest.approx((-0.1, 0.0))
    assert reason.short_by_m == pytest.approx(0.01 + 0.1)
    assert reason.is_at_least and "at least" in reason.message
    assert "with the left gripper at (-0.45, 0.15) m, 0.02 m over the table, the left forearm " in reason.message


def test_a_drag_that_only_another_would_make_useful_is_told_of_no_fold(monkeypatch: pytest.MonkeyPatch) -> None:
    open_way = planned(napkin(HALF, x_m=FAR_TOO_FAR), front_alone(0.1))
    assert [p.kind for p in open_way.primitives] == ["drag", "drag", "fold"]
    barred(monkeypatch, lambda arm, base: True)
    # All that the fold needs could be brought into reach, so that it is no reason that it is not.
    (drag,) = refused(FAR_TOO_FAR, 0.1).reasons
    assert (drag.fold, drag.code) == (None, Code.COLLISION)
    assert drag.message.startswith("to drag the cloth by (-0.10, 0.00) m, from front ")


@pytest.mark.long
def test_arms_that_collide_in_the_fold_itself_are_told_before_those_that_do_in_a_drag(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # From where the napkin is within reach as it lies; drags only lead to more of the same.
    barred(monkeypatch, lambda arm, base: True)
    (reason,) = refused(-0.5, 0.3).reasons
    assert (reason.fold, reason.code, reason.offset_m) == (0, Code.COLLISION, (0.0, 0.0))
    assert "to drag" not in reason.message


def test_of_collisions_in_one_situation_the_mildest_is_kept_and_one_of_unknown_depth_is_none_of_them() -> None:
    def collision(depth_m: float) -> Obstacle:
        contact = (
            None
            if math.isinf(depth_m)
            else BlockingContact("left", (0.0, 0.0, 0.0), "table", ("left forearm", "table top"), depth_m)
        )
        return Obstacle(0, Code.COLLISION, None, depth_m, NAPKIN_START, contact=contact)

    for depths in ([math.inf, math.inf, 0.02, 0.01], [0.01, math.inf, 0.02], [0.02, 0.01, math.inf]):
        met = Obstacles()
        for depth_m in depths:
            met.note(collision(depth_m))
        assert [o.severity for o in met.of(0)] == [0.01]
