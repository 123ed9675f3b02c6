"""Plans for robots that a card and a URDF describe: joints that take the tools where the steps say, step by step."""

import json

import numpy as np
import pinocchio as pin
import pytest

from planner import Plan, load_garment, make_plan
from planner.motion.timeline import Timeline
from planner.planning.plan_check import require_replay
from planner.robots.described_robot import read_robot
from planner.robots.load_robot import load_robot
from tests.required import required
from tests.small_plan import napkin_plan

NAME = "so101-pair"


@pytest.fixture(scope="module")
def plan() -> Plan:
    return napkin_plan()


def test_two_small_arms_fold_a_napkin_where_they_stand(plan: Plan) -> None:
    assert plan.is_solved
    assert {step.kind for step in plan.steps} == {"fold"}
    assert {step.after.base.station for step in plan.steps} == {None}


def test_a_plan_reads_back_and_replays(plan: Plan) -> None:
    again = Plan.from_dict(json.loads(json.dumps(plan.to_dict())))
    assert again == plan
    require_replay(again)


@pytest.mark.long
@pytest.mark.parametrize("garment", ["tie", "scarf"])
@pytest.mark.parametrize("robot", ["ur5e-pair", "panda-pair", "baxter"])
def test_cloth_that_hangs_far_over_the_edge_of_the_table_is_folded(robot: str, garment: str) -> None:
    hanging = make_plan(load_garment(garment), robot=robot, time_limit_s=60.0)
    assert hanging.is_solved, hanging.reasons
    table_m = hanging.scene.table.height_m
    assert min(grip.pick[2] for step in hanging.steps for grip in step.grips) < table_m - 0.1
    require_replay(hanging)


def test_samples_have_every_actuated_joint_of_the_urdf_within_its_limits(plan: Plan) -> None:
    model = pin.buildModelFromXML(read_robot(NAME).urdf)
    for sample in Timeline.of(plan).samples(5.0):
        joints = sample.to_dict()["joints"]
        assert set(joints) == set(model.names[1:])
        for name, value in joints.items():
            index = model.joints[model.getJointId(name)].idx_q
            assert model.lowerPositionLimit[index] - 1e-9 <= value <= model.upperPositionLimit[index] + 1e-9


def test_the_tools_are_where_the_grips_are_when_they_take_the_cloth(plan: Plan) -> None:
    """Another kinematics says where the joints bring the tool; arms of five joints are asked position and pitch."""
    robot = load_robot(NAME)
    model = pin.buildModelFromXML(read_robot(NAME).urdf)
    data, step = model.createData(), plan.steps[0]
    base, height_m = step.after.base.pose, plan.scene.table.height_m
    joints_at = required(plan.trajectory).joints_at
    for grip in step.grips:
        arm = next(one for one in read_robot(NAME).arms if one.card.name == grip.arm)
        nearest = np.inf
        for t in np.linspace(0.0, required(plan.cost_s), 601):
            q = pin.neutral(model)
            for name, value in joints_at(float(t)).items():
                q[model.joints[model.getJointId(name)].idx_q] = value
            pin.framesForwardKinematics(model, data, q)
            frame = data.oMf[model.getFrameId(arm.card.tool.link)]
            tool = frame.act(np.array(arm.card.tool.offset_m))
            at = base.to_outer(tool) - np.array([0.0, 0.0, height_m])
            nearest = min(nearest, float(np.linalg.norm(at - grip.pick)))
        assert nearest < 1e-4
    assert [arm.name for arm in robot.card.arms] == ["left", "right"]
