"""The drivers of arms with libraries of their own, before stand-ins with the libraries' names and units."""

import math
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import pytest

from app.drivers import ur_arms
from app.drivers.driver import DriverError, LostError
from app.drivers.lerobot_arms import LerobotDriver, so_followers
from app.drivers.run import Ended, Recording, run_plan
from app.drivers.ur_arms import UrDriver
from planner import Plan
from planner.robots.card import RobotCard
from planner.robots.load_robot import load_robot
from tests.app.drivers.manual_clock import ManualClock
from tests.required import required

MOTORS = ("shoulder_pan", "shoulder_lift", "elbow_flex", "wrist_flex", "wrist_roll", "gripper")


@dataclass
class Follower:
    """LeRobot's follower of an SO-101: motors by ``NAME.pos``, in degrees, the gripper from 0 to 100."""

    motors: dict[str, float]
    actions: list[dict[str, float]] = field(default_factory=list)
    is_connected: bool = False
    breaks_after: int = 10**9

    def connect(self) -> None:
        self.is_connected = True

    def get_observation(self) -> Mapping[str, Any]:
        assert self.is_connected
        return {f"{name}.pos": value for name, value in self.motors.items()}

    def send_action(self, action: dict[str, float]) -> Mapping[str, Any]:
        if len(self.actions) >= self.breaks_after:
            raise ConnectionError("no status packet")
        for name, value in action.items():
            motor = name.removesuffix(".pos")
            assert name.endswith(".pos") and motor in self.motors, name
            low, high = (0.0, 100.0) if motor == "gripper" else (-180.0, 180.0)
            assert low - 1e-6 <= value <= high + 1e-6, name
            self.motors[motor] = value
        self.actions.append(action)
        return action

    def disconnect(self) -> None:
        self.is_connected = False


def followers(card: RobotCard) -> dict[str, Follower]:
    return {
        arm.name: Follower(dict(zip(MOTORS, (*map(math.degrees, arm.home), 100.0), strict=True))) for arm in card.arms
    }


def run(plan: Plan, card: RobotCard, driver: LerobotDriver | UrDriver) -> Ended:
    return run_plan(plan, card, driver, lambda _leg: True, lambda _leg, _t_s: None, Recording(card, ManualClock()))


def test_lerobots_arms_end_where_the_plan_does_in_degrees(plan: Plan, card: RobotCard) -> None:
    arms = followers(card)
    assert run(plan, card, LerobotDriver(card, arms, ManualClock())) == Ended("done", len(plan.steps))
    path = required(plan.trajectory)
    wanted = dict(zip(path.arms.names, path.arms.at(path.duration_s).tolist(), strict=True))
    for name, arm in arms.items():
        assert not arm.is_connected
        for motor in MOTORS[:-1]:
            assert arm.motors[motor] == pytest.approx(math.degrees(wanted[f"{name}_{motor}"]), abs=1e-6)
        track = next(track for track in path.grippers if track.arm == name)
        widest = next(one for one in card.arms if one.name == name).gripper.opening_max_m
        assert arm.motors["gripper"] == pytest.approx(100.0 * track.opening_at(path.duration_s) / widest, abs=1e-6)


def test_an_arm_that_does_not_answer_ends_the_run(plan: Plan, card: RobotCard) -> None:
    arms = followers(card)
    arms["right"].breaks_after = 20
    ended = run(plan, card, LerobotDriver(card, arms, ManualClock()))
    assert ended.how == "lost" and "'right'" in ended.why and "no status packet" in ended.why
    left = arms["left"]
    assert left.actions[-1] == {f"{name}.pos": value for name, value in left.motors.items()}, "it is held where it is"


def test_lerobot_drives_its_own_arms_alone_and_wants_a_port_for_each(card: RobotCard) -> None:
    with pytest.raises(DriverError, match="needs a port for right"):
        LerobotDriver(card, {"left": followers(card)["left"]})
    with pytest.raises(DriverError, match="Two UR5e has others"):
        LerobotDriver(load_robot("ur5e-pair").card, {})


@pytest.mark.parametrize("library", ["lerobot", "rtde_control"])
def test_a_library_that_is_missing_is_named(monkeypatch: pytest.MonkeyPatch, library: str) -> None:
    for name in (library, "lerobot.robots", "lerobot.robots.so_follower"):
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(DriverError, match="pip install"):
        if library == "lerobot":
            so_followers({"left": "/dev/null"})
        else:
            ur_arms.connected("127.0.0.1")


@dataclass
class UrArm:
    """A UR arm that follows: each joint is servoed by less than it can turn in a tick."""

    q: list[float]
    closed: float = 0.0
    is_stopped: bool = False
    is_lost: bool = False

    def joints(self) -> list[float]:
        if self.is_lost:
            raise RuntimeError("the connection is lost")
        return list(self.q)

    def servo(self, joints: list[float], tick_s: float) -> None:
        assert len(joints) == 6
        assert max(abs(a - b) for a, b in zip(joints, self.q, strict=True)) <= 1.05 * math.pi * tick_s + 1e-9
        self.q = list(joints)

    def gripper(self) -> float:
        return self.closed

    def grip(self, closed: float) -> None:
        assert 0.0 <= closed <= 1.0
        self.closed = closed

    def stop(self) -> None:
        self.is_stopped = True

    def close(self) -> None:
        pass


def test_ur_arms_are_servoed_in_the_order_of_their_joints(monkeypatch: pytest.MonkeyPatch) -> None:
    card = load_robot("ur5e-pair").card
    arms = {f"{arm.name}.example": UrArm(list(arm.home)) for arm in card.arms}
    monkeypatch.setattr(ur_arms, "connected", lambda address: arms[address])
    driver = UrDriver(card, {arm.name: f"{arm.name}.example" for arm in card.arms}, ManualClock())
    driver.connect()
    left = card.arms[0]
    here = driver.read()
    assert [here[name] for name in left.joint_names] == pytest.approx(left.home)
    assert here[left.gripper.joint_name] == pytest.approx(left.gripper.angle(left.gripper.opening_max_m))
    driver.put({**here, left.joint_names[5]: left.home[5] + 0.01})
    assert arms["left.example"].q[5] == pytest.approx(left.home[5] + 0.01)
    driver.grip({left.gripper.joint_name: left.gripper.angle(0.0)})
    assert arms["left.example"].closed == pytest.approx(1.0) and arms["right.example"].closed == 0.0
    arms["right.example"].is_lost = True
    with pytest.raises(LostError, match="'right' does not answer"):
        driver.read()
    driver.stop()
    assert all(arm.is_stopped for arm in arms.values())
    with pytest.raises(DriverError, match="that of left, right"):
        UrDriver(card, {})
    with pytest.raises(DriverError, match="Two SO-101 has others"):
        UrDriver(load_robot("so101-pair").card, {})
