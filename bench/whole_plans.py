"""The processor time of whole plans of the nine garments in one process: joint paths and trajectory included.

What a process keeps from plan to plan saves work in the next: where arms reach, and joint paths. Each garment is
therefore planned with nothing known but compiled kernels, with joint paths known, and with both known. The garment is
replayed each time.
"""

from collections.abc import Callable, Mapping, Sequence
from statistics import median
from time import process_time
from typing import Final

from bench.measurement import BenchmarkError
from bench.paper import TABLE_2
from bench.report import Report, Row
from planner import Garment, load_garment, make_plan
from planner.motion.transfer_planner import forget_paths
from planner.planning.problem import forget_garments
from planner.robots.load_robot import load_robot
from planner.task.task import DEFAULT_ROBOT

COLUMNS: Final = ("garment", "cost [s]", "nothing known, CPU [ms]", "joint paths known", "reach known too")


def whole_plans(garments: Sequence[str], repetitions: int) -> Report:
    """Measure the nine garments, the three states of knowledge in turns, and add the medians up in the last row."""
    chosen = [garment for garment in TABLE_2 if garment in garments]
    rows = [_measured(garment, repetitions) for garment in chosen]
    if len(rows) > 1:
        names = [name for name in rows[0] if name.endswith("_ms")]
        total = {name: sum(float(row[name]) for row in rows) for name in names}
        rows.append({"garment": "all", "cost_s": sum(float(row["cost_s"]) for row in rows), **total})
    title = "Whole plans of a process that has planned before"
    return Report("whole-plans", title, COLUMNS, tuple(_row(row) for row in rows), repetitions)


def _measured(name: str, repetitions: int) -> dict[str, str | float]:
    garment = load_garment(name)
    forget_reach = load_robot(DEFAULT_ROBOT).forget_reach
    forgotten: Mapping[str, Sequence[Callable[[], None]]] = {
        "anew_cpu_ms": (forget_garments, forget_paths, forget_reach),
        "paths_known_cpu_ms": (forget_garments, forget_reach),
        "all_known_cpu_ms": (forget_garments,),
    }
    cost_s, _ = _planned(garment)
    times_s: dict[str, list[float]] = {known: [] for known in forgotten}
    for _ in range(repetitions):
        for known, forget in forgotten.items():
            for one in forget:
                one()
            again_s, cpu_s = _planned(garment)
            if again_s != cost_s:
                raise BenchmarkError(f"{name} takes {again_s} s after {cost_s} s: what is known changes the plan")
            times_s[known].append(cpu_s)
    return {"garment": name, "cost_s": cost_s, **{known: 1e3 * median(times) for known, times in times_s.items()}}


def _planned(garment: Garment) -> tuple[float, float]:
    """Return the plan's cost, and the processor time that it took to plan (s)."""
    begun = process_time()
    plan = make_plan(garment)
    cpu_s = process_time() - begun
    if plan.cost_s is None:
        raise BenchmarkError(f"{garment.name} has no plan")
    return plan.cost_s, cpu_s


def _row(found: Mapping[str, str | float]) -> Row:
    garment, cost_s, *times_ms = found.values()
    return Row(((str(garment), f"{cost_s:.3f}", *(f"{time_ms:.0f}" for time_ms in times_ms)),), dict(found))
