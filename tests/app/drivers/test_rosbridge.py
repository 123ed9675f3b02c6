"""The driver for ROS 2 before a stand-in with the rules of `joint_trajectory_controller`."""

import signal
import threading
from collections.abc import Iterator

import pytest

from app.drivers.driver import DriverError
from app.drivers.rosbridge import RosbridgeDriver
from app.drivers.run import Ended, Leg, Recording, run_plan
from planner import Plan
from planner.robots.card import RobotCard
from planner.robots.load_robot import load_robot
from tests.app.drivers.joint_trajectory_controllers import JointTrajectoryControllers
from tests.patience import PATIENCE_S, wait_until
from tests.required import required


@pytest.fixture
def controllers(card: RobotCard) -> Iterator[JointTrajectoryControllers]:
    with JointTrajectoryControllers(card) as found:
        yield found


def run(plan: Plan, card: RobotCard, address: str) -> tuple[Ended, list[Leg]]:
    legs: list[Leg] = []

    def confirm(leg: Leg) -> bool:
        legs.append(leg)
        return True

    driver = RosbridgeDriver(card, address)
    return run_plan(plan, card, driver, confirm, lambda _leg, _t_s: None, Recording(card), speed=0.5), legs


def test_controllers_take_every_goal_of_a_plan(
    controllers: JointTrajectoryControllers, plan: Plan, card: RobotCard
) -> None:
    controllers.joints["left_shoulder_pan"] = 0.6
    ended, legs = run(plan, card, controllers.address)
    assert controllers.refused == []
    assert ended == Ended("done", len(plan.steps))
    arms = [goal for goal in controllers.goals if goal["action"] == "/left_arm_controller/follow_joint_trajectory"]
    assert len(arms) == len(legs)
    path = required(plan.trajectory)
    wanted = dict(zip(path.arms.names, path.arms.at(path.duration_s).tolist(), strict=True))
    assert {name: controllers.joints[name] for name in wanted} == pytest.approx(wanted, abs=1e-6)


def test_a_goal_that_is_refused_ends_the_run_with_the_reason(
    controllers: JointTrajectoryControllers, plan: Plan, card: RobotCard
) -> None:
    controllers.limits |= {name: (low, high, speed / 100.0) for name, (low, high, speed) in controllers.limits.items()}
    ended, _ = run(plan, card, controllers.address)
    assert ended.how == "lost" and "is too fast" in ended.why and "_controller" in ended.why


def test_a_goal_that_is_rejected_ends_the_run(
    controllers: JointTrajectoryControllers, plan: Plan, card: RobotCard, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.drivers.rosbridge._ACTION", "control_msgs/action/Other")
    ended, _ = run(plan, card, controllers.address)
    assert ended.how == "lost" and "another action" in ended.why


@pytest.fixture
def keyboard() -> Iterator[None]:
    """Have Ctrl-C interrupt this process, whatever became of that in it before."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    blocked = signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
    yield
    signal.pthread_sigmask(signal.SIG_SETMASK, blocked)
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("keyboard")
def test_ctrl_c_cancels_every_goal(controllers: JointTrajectoryControllers, plan: Plan, card: RobotCard) -> None:
    controllers.holds, main = True, threading.main_thread().ident or 0

    def interrupt() -> None:
        assert controllers.accepted.wait(PATIENCE_S)
        signal.pthread_kill(main, signal.SIGINT)  # wakes it from its wait, as the keyboard does

    threading.Thread(target=interrupt, daemon=True).start()
    ended, _ = run(plan, card, controllers.address)
    assert (ended.how, ended.done) == ("stopped", 0), ended.why
    wait_until(lambda: controllers.cancelled)


def test_a_connection_that_breaks_ends_the_run(
    controllers: JointTrajectoryControllers, plan: Plan, card: RobotCard
) -> None:
    controllers.drops = True
    ended, _ = run(plan, card, controllers.address)
    assert ended.how == "lost" and "connection" in ended.why


def test_a_bridge_that_is_not_there_and_a_base_that_drives_are_refused(card: RobotCard) -> None:
    with pytest.raises(DriverError, match="rosbridge is not at ws://127"):
        RosbridgeDriver(card, "ws://127.0.0.1:1").connect()
    with pytest.raises(DriverError, match="PR2 drives"):
        RosbridgeDriver(load_robot("pr2").card)
