"""One small plan for all tests of what is made of plans: both arms, a blue fold with a drive, a red one."""

from dataclasses import replace

from planner import Plan
from planner.robots.card import RobotCard
from planner.robots.load_robot import load_robot
from tests.replay.planned import shipped_plan

CARD = load_robot("pr2").card


def small_plan() -> Plan:
    """Return the plan, made once in a process."""
    return shipped_plan("letter-towel")


def one_armed() -> tuple[Plan, RobotCard]:
    """Return the motion of its first arm alone, as of a robot that has no other, no lift and a base that is fixed."""
    plan, arm = small_plan(), CARD.arms[0]
    assert plan.trajectory is not None
    path = plan.trajectory
    count = len(arm.joint_names)
    rows, rates = (tuple(row[:count] for row in each) for each in (path.arms.positions, path.arms.velocities))
    arms = replace(path.arms, names=arm.joint_names, positions=rows, velocities=rates)
    card = replace(CARD, arms=(arm,), lift_joint=None, base_kind="fixed")
    return replace(plan, trajectory=replace(path, arms=arms, grippers=path.grippers[:1])), card


def unsolved() -> Plan:
    """Return a plan of the same task that is none."""
    return replace(small_plan(), status="infeasible", steps=(), trajectory=None)
