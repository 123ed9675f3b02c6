"""A plan performed by a robot that is not there: the way to it, its steps, and what ends it early."""

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory

from app.drivers.driver import Joints, LostError
from app.drivers.run import Ended, Leg, Recording, run_plan
from app.drivers.simulated import SimulatedDriver
from planner import Plan
from planner.errors import RequestError
from planner.planning.way_to_step import WayToStep
from planner.robots.card import RobotCard
from tests.app.drivers.manual_clock import ManualClock
from tests.required import required


@dataclass
class Bench:
    """A simulated robot whose every order is kept."""

    card: RobotCard
    clock: ManualClock = field(default_factory=ManualClock)
    orders: list[tuple[float, Joints]] = field(default_factory=list)
    legs: list[Leg] = field(default_factory=list)
    is_stopped: bool = False
    fails: Callable[["Bench"], None] = lambda _bench: None

    def __post_init__(self) -> None:
        bench = self

        class Kept(SimulatedDriver):
            stuck = ""

            def put(self, joints: Joints) -> None:
                bench.orders.append((bench.clock.now_s(), joints))
                bench.fails(bench)
                super().put({name: value for name, value in joints.items() if name != self.stuck})

            def stop(self) -> None:
                bench.is_stopped = True

        self.driver = Kept(self.card, self.clock)
        self.recording = Recording(self.card, self.clock)

    def run(self, plan: Plan, *, from_step: int = 0, speed: float = 1.0, until: int | None = None) -> Ended:
        def confirm(leg: Leg) -> bool:
            self.legs.append(leg)
            return until is None or leg.step is None or leg.step < until

        return run_plan(
            plan, self.card, self.driver, confirm, lambda _leg, _t_s: None, self.recording, from_step, speed
        )


@pytest.fixture
def bench(card: RobotCard) -> Bench:
    return Bench(card)


def test_the_joints_go_where_the_plan_has_them_when_it_has_them(bench: Bench, plan: Plan) -> None:
    path = required(plan.trajectory)
    assert bench.run(plan) == Ended("done", len(plan.steps))
    start_s = bench.orders[-1][0] - path.duration_s
    planned = [order for order in bench.orders if order[0] >= start_s and "base_x_m" in order[1]]
    assert len(planned) > 50.0 * path.duration_s - len(plan.steps)
    for t_s, joints in planned:
        wanted = path.arms.at(t_s - start_s)
        np.testing.assert_allclose([joints[name] for name in path.arms.names], wanted, atol=2e-3)


def test_a_share_of_the_speed_takes_so_much_longer(bench: Bench, plan: Plan, card: RobotCard) -> None:
    slow = Bench(card)
    bench.run(plan)
    slow.run(plan, speed=0.25)
    assert sum(leg.duration_s for leg in slow.legs) == pytest.approx(4.0 * sum(leg.duration_s for leg in bench.legs))


def test_arms_that_are_elsewhere_are_led_to_the_first_pose(bench: Bench, plan: Plan) -> None:
    bench.driver.joints["left_shoulder_pan"] = 0.8
    assert bench.run(plan).how == "done"
    assert bench.legs[0] == Leg("to the first pose", bench.legs[0].duration_s)
    ways = [(t_s, joints) for t_s, joints in bench.orders if "base_x_m" not in joints and "left_shoulder_pan" in joints]
    assert ways[0][1]["left_shoulder_pan"] == pytest.approx(0.8)
    speeds = dict(zip(bench.card.arms[0].joint_names, bench.card.arms[0].speeds_rad_s, strict=True))
    for (t0_s, before), (t1_s, after) in pairwise(ways):
        for name, most in speeds.items():
            assert abs(after[name] - before[name]) <= 1.01 * most * (t1_s - t0_s) + 1e-9


def test_without_a_free_way_nothing_moves(bench: Bench, plan: Plan) -> None:
    bench.driver.joints |= {"left_shoulder_lift": 1.6, "left_elbow_flex": 0.0}  # its gripper deep in the table
    ended = bench.run(plan)
    assert ended.how == "lost" and "no way" in ended.why and not bench.orders


def test_each_step_is_confirmed_or_the_run_ends(bench: Bench, plan: Plan) -> None:
    assert bench.run(plan, until=1) == Ended("stopped", 1, "not confirmed")
    assert [leg.step for leg in bench.legs if leg.step is not None] == [0, 1]
    assert plan.steps[0].kind in next(leg.what for leg in bench.legs if leg.step == 0)


@pytest.mark.parametrize(("error", "how"), [(KeyboardInterrupt(), "stopped"), (LostError("no answer"), "lost")])
def test_ctrl_c_and_a_lost_robot_stop_the_arms(bench: Bench, plan: Plan, error: BaseException, how: str) -> None:
    def fail(now: Bench) -> None:
        if len(now.orders) == 40:
            raise error

    bench.fails = fail
    ended = bench.run(plan)
    assert (ended.how, ended.done) == (how, 0)
    assert bench.is_stopped and len(bench.orders) == 40


@pytest.mark.parametrize("step", [0, 1])
def test_a_robot_that_does_not_come_where_a_step_ends_is_lost(bench: Bench, plan: Plan, step: int) -> None:
    def hold(now: Bench) -> None:
        if now.legs[-1].step == step:
            now.driver.joints[now.driver.stuck] = 0.7

    bench.fails, bench.driver.stuck = hold, "right_shoulder_pan"
    ended = bench.run(plan)
    assert (ended.how, ended.done) == ("lost", step)
    assert "'right_shoulder_pan' is" in ended.why and bench.is_stopped


def test_a_run_begins_at_a_step_that_begins_with_free_grippers(bench: Bench, plan: Plan) -> None:
    last = len(plan.steps) - 1
    assert not plan.state_after(last - 1).held
    assert bench.run(plan, from_step=last) == Ended("done", len(plan.steps))
    assert [leg.step for leg in bench.legs if leg.step is not None] == [last]
    with pytest.raises(RequestError, match="from_step: 9 is not between"):
        WayToStep.of(plan, 9)


def test_what_was_sent_and_read_is_kept_as_ros_messages(bench: Bench, plan: Plan, tmp_path: Path) -> None:
    bench.run(plan)
    (tmp_path / "run.mcap").write_bytes(bench.recording.mcap({"ended": "done"}))
    with (tmp_path / "run.mcap").open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        found = [(channel.topic, message) for _, channel, __, message in reader.iter_decoded_messages()]
    topics = [topic for topic, _ in found]
    assert topics.count("/left_arm_controller/joint_trajectory") == len(bench.legs)
    assert topics.count("/right_gripper_controller/joint_trajectory") == sum(leg.step is not None for leg in bench.legs)
    states = [message for topic, message in found if topic == "/joint_states"]
    assert set(states[-1].name) == set(bench.driver.joints)
    at_end = required(plan.trajectory).arms.at(required(plan.cost_s))
    read = dict(zip(states[-1].name, states[-1].position, strict=True))
    np.testing.assert_allclose([read[name] for name in required(plan.trajectory).arms.names], at_end, atol=1e-6)
