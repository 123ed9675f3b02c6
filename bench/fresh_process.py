"""A process that has planned nothing yet: ``python -m bench.fresh_process GARMENT`` prints its times as JSON.

It imports the planner, then makes the same plan twice. The first plan reads the robot's description and loads the
compiled kernels from the disk; the second finds them in memory.
"""

import json
import sys
from time import perf_counter, process_time


def times_of(garment_name: str) -> dict[str, float]:
    """Return the times of import, first plan, its CPU and second plan (s); the planner must not be imported before."""
    started = perf_counter()
    from planner import load_garment, make_plan

    imported = perf_counter()
    garment = load_garment(garment_name)
    loaded, cpu_s = perf_counter(), process_time()
    make_plan(garment)
    planned, cpu_s = perf_counter(), process_time() - cpu_s
    make_plan(garment)
    again = perf_counter()
    return {
        "import_s": imported - started,
        "first_plan_s": planned - loaded,
        "first_plan_cpu_s": cpu_s,
        "second_plan_s": again - planned,
    }


if __name__ == "__main__":
    sys.stdout.write(json.dumps(times_of(sys.argv[1])))
