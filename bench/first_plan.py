"""The time of a process's first plan against its second: each time in a new process."""

import json
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from statistics import median

from bench.measurement import Ratio
from bench.paper import TABLE_2
from bench.report import Report, Row, seconds

COLUMNS = ("garment", "import [s]", "first plan [s]", "CPU [s]", "second plan [s]", "times as long")
ROOT = Path(__file__).parent.parent


def first_plan(garments: Sequence[str], repetitions: int) -> Report:
    """Measure the first and the second plan of the nine garments, in a new process for each repetition."""
    chosen = [garment for garment in TABLE_2 if garment in garments]
    for garment in chosen[:1]:
        _times_in_fresh_process(garment)  # thrown away: it may have to compile kernels
    rows = [_row(garment, [_times_in_fresh_process(garment) for _ in range(repetitions)]) for garment in chosen]
    title = "First and second plan of a new process (kernels on disk)"
    return Report("first-plan", title, COLUMNS, tuple(rows), repetitions)


def _times_in_fresh_process(garment: str) -> dict[str, float]:
    command = [sys.executable, "-m", "bench.fresh_process", garment]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, check=True, text=True)
    times: dict[str, float] = json.loads(done.stdout)
    return times


def _row(garment: str, runs: Sequence[dict[str, float]]) -> Row:
    times = {name: median(run[name] for run in runs) for name in runs[0]}
    longer = Ratio.of([run["first_plan_s"] for run in runs], [run["second_plan_s"] for run in runs])
    line = (garment, *(seconds(time_s, 3) for time_s in times.values()), str(longer))
    return Row((line,), {"garment": garment, **times, "plan_time_ratio": asdict(longer)})
