"""Kernels are compiled before the first plan."""

import subprocess
import sys

from planner.planning.robot_task import default_scene
from planner.planning.warm_up import compile_kernels, napkin
from planner.robots.described_robot import shipped_robots

# What the process prints at last: the functions that planning has still compiled, or loaded.
PROGRAM = """
import sys
from numba.core.dispatcher import Dispatcher
from planner import load_garment, make_plan
from planner.planning.warm_up import compile_kernels

def compiled():
    modules = [module for name, module in sys.modules.items() if name.startswith("planner.")]
    functions = [one for module in modules for one in vars(module).values() if isinstance(one, Dispatcher)]
    return {(one.py_func.__module__, one.__name__, each) for one in functions for each in map(str, one.signatures)}

compile_kernels()
before = compiled()
assert len(before) > 10
plans = [make_plan(load_garment(name)) for name in sys.argv[1:]]
print([plan.status for plan in plans], [name for _, name, _ in compiled() - before])
"""


def test_no_garment_has_to_wait_for_the_compiler():
    # One arm and two, drags, hanging cloth, arms that must be led past each other, and no plan with its reasons.
    garments = ("shirt", "scarf", "big-towel", "t-shirt", "scarf-halved")
    done = subprocess.run([sys.executable, "-c", PROGRAM, *garments], capture_output=True, text=True, check=True)
    assert done.stdout.split("] ")[1].strip() == "[]"
    assert done.stdout.startswith("['solved', 'solved', 'solved', 'solved', 'infeasible']")


SAMPLING = """
from planner.planning.warm_up import compile_kernels
from planner.robots.posture_samples import axis_samples, posture_samples
from planner.robots.rolled_samples import rolled_samples, unrolled

compile_kernels("so101-pair")
print([one.__name__ for one in (axis_samples, posture_samples, rolled_samples, unrolled) if not one.signatures])
"""


def test_a_small_robot_compiles_what_arms_of_other_joints_need():
    # Its own arms have five joints, and need no samples for all rolls.
    done = subprocess.run([sys.executable, "-c", SAMPLING], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_every_shipped_robot_has_room_for_the_garment_that_is_planned_first():
    for robot in shipped_robots():
        table, (xs, ys) = default_scene(robot).table, zip(*napkin(robot).outline, strict=True)
        assert max(xs) - min(xs) <= 0.5 * min(table.depth_m, table.width_m)
        assert max(ys) - min(ys) <= 0.5 * min(table.depth_m, table.width_m)


def test_no_bound_on_the_driving_of_a_described_robot_is_made_only_to_compile_it(monkeypatch):
    # Two hands with a hundred ways each: for TIAGo Pro it took 17 s, at the first plan of every process.
    made = []
    monkeypatch.setattr("planner.planning.warm_up.DrivingBound", lambda *given: made.append(given))
    compile_kernels.__wrapped__("so101-pair")
    assert not made
    compile_kernels.__wrapped__()
    assert len(made) == 1
