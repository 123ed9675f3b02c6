"""Kernels are compiled before the first plan."""

import math
import subprocess
import sys

import pytest

from planner.planning.robot_task import default_scene
from planner.planning.warm_up import _use_kernels, compile_kernels, napkin
from planner.robots.known_robots import shipped_robots

# What the process prints at last: the functions that planning has still compiled, or loaded.
PROGRAM = """
import sys
from random import Random
from numba.core.dispatcher import Dispatcher
from planner import load_garment, make_plan
from planner.planning.warm_up import compile_kernels
from tests.laws.tasks import rough_task

def compiled():
    modules = [module for name, module in sys.modules.items() if name.startswith("planner.")]
    functions = [one for module in modules for one in vars(module).values() if isinstance(one, Dispatcher)]
    return {(one.py_func.__module__, one.__name__, each) for one in functions for each in map(str, one.signatures)}

compile_kernels()
before = compiled()
assert len(before) > 10
plans = [make_plan(load_garment(name)) for name in sys.argv[1:]]
for seed in (3, 16):  # places that a hand has within reach but not within comfort, and beyond all displacements tried
    rough_task(Random(seed)).plan()
print([plan.status for plan in plans], [name for _, name, _ in compiled() - before])
"""


@pytest.mark.long
def test_no_garment_has_to_wait_for_the_compiler() -> None:
    # One arm and two, drags, hanging cloth, arms that must be led past each other, and no plan with its reasons.
    garments = ("shirt", "scarf", "big-towel", "t-shirt", "scarf-halved")
    done = subprocess.run([sys.executable, "-c", PROGRAM, *garments], capture_output=True, text=True, check=True)
    assert done.stdout.split("] ")[1].strip() == "[]"
    assert done.stdout.startswith("['solved', 'solved', 'solved', 'solved', 'infeasible']")


SAMPLING = """
from planner.planning.warm_up import compile_kernels
from planner.robots.posture_samples import axis_samples, posture_samples
from planner.robots.posture_samples import rolled_samples, unrolled

compile_kernels("so101-pair")
print([one.__name__ for one in (axis_samples, posture_samples, rolled_samples, unrolled) if not one.signatures])
"""


def test_a_small_robot_compiles_what_arms_of_other_joints_need() -> None:
    # Its own arms have five joints, and need no samples for all rolls.
    done = subprocess.run([sys.executable, "-c", SAMPLING], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_every_shipped_robot_has_room_for_the_garment_that_is_planned_first() -> None:
    for robot in shipped_robots():
        table, (xs, ys) = default_scene(robot).table, zip(*napkin(robot).outline, strict=True)
        assert max(xs) - min(xs) <= 0.5 * min(table.depth_m, table.width_m)
        assert max(ys) - min(ys) <= 0.5 * min(table.depth_m, table.width_m)


@pytest.mark.parametrize("robot", ["pr2", "so101-pair"])
def test_the_bound_on_the_driving_is_asked_where_nothing_is_in_reach(
    monkeypatch: pytest.MonkeyPatch, robot: str
) -> None:
    # At the table two hands have a hundred ways each: for TIAGo Pro the bound took 17 s, in every process.
    asked = []
    monkeypatch.setattr("planner.planning.warm_up.DrivingBound", lambda context, start: asked.append(context))
    _use_kernels.__wrapped__(robot, is_backwards=False)
    (context,) = asked
    assert all(math.hypot(pose.x_m, pose.y_m) > 10.0 for _, pose in context.scene.stations)


def test_the_kernels_of_a_robot_are_used_once_by_whatever_name_it_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    compile_kernels()
    monkeypatch.setattr("planner.planning.warm_up.Problem.of", lambda *_: pytest.fail("used once more"))
    compile_kernels("pr2")
    compile_kernels(name="pr2")
