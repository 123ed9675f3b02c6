"""A study whose process is killed again and again gives the table of one that ran through."""

import subprocess
import sys
from pathlib import Path

import pytest

from app.studies.results import Results
from app.studies.run_study import Progress, run_study
from app.studies.table import CSV, PARQUET
from app.studies.workers import InProcess
from tests.app.studies.planners import fake_plan
from tests.app.studies.study_samples import study

KILLS = 5
EACH = 7
"""Answers that a process tells before it is killed."""

_ASKED = {"table": {"height_m": {"from": 0.5, "to": 1.0, "count": 101}}}


def run_aloud(folder: Path) -> Progress:
    """Run the study, and print how far it is after each answer."""
    asked = study(**_ASKED)
    with Results(folder) as results:
        results.begin(asked, resume=True)
        return run_study(asked, results, InProcess(fake_plan), lambda now: print(now.done, flush=True))


def run_and_kill(folder: Path) -> int:
    """Run the study in a process, kill that after some answers, and return how many it has told."""
    command = f"from pathlib import Path; from {__name__} import run_aloud; run_aloud(Path({str(folder)!r}))"
    process = subprocess.Popen([sys.executable, "-c", command], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    told = [process.stdout.readline() for _ in range(1 + EACH)]  # the first is what was known already
    process.kill()
    told += process.communicate()[0].split("\n")[:-1]
    assert process.returncode < 0, "it came to its end"
    return int(told[-1])


@pytest.mark.long
def test_a_study_killed_five_times_loses_no_answer_and_gives_the_table_of_one_that_was_not(tmp_path: Path) -> None:
    told = [run_and_kill(tmp_path / "parts") for _ in range(KILLS)]
    assert told == sorted(told)
    last = run_aloud(tmp_path / "parts")
    assert told[-1] <= last.begun_with < last.count
    run_aloud(tmp_path / "whole")
    for name in (PARQUET, CSV, "report.html"):
        assert (tmp_path / "parts" / name).read_bytes() == (tmp_path / "whole" / name).read_bytes()
