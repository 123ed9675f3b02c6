"""One small plan for all tests of what is made of plans: both arms, a blue fold with a drive, a red one."""

from dataclasses import replace
from functools import cache

from planner import Plan, make_plan
from planner.robots.card import RobotCard
from planner.robots.load_robot import load_robot
from tests.builders import fold, garment
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


@cache
def napkin_plan() -> Plan:
    """Return the plan of a napkin that a pair of SO-101 folds twice."""
    outline = [(0.0, 0.0), (0.2, 0.0), (0.2, 0.16), (0.0, 0.16)]
    napkin = garment(outline, fold((0.1, 0.16), (0.1, 0.0)), fold((0.0, 0.08), (0.1, 0.08)))
    plan = make_plan(napkin, robot="so101-pair", time_limit_s=60.0)
    assert plan.is_solved and len(plan.steps) >= 2
    return plan


def unsolved() -> Plan:
    """Return a plan of the same task that is none."""
    return replace(small_plan(), status="infeasible", steps=(), trajectory=None)
