"""Kernels are compiled before the first plan."""

import subprocess
import sys

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
