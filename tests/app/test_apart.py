import os
import signal
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from app.files.import_errors import UnitsNeededError
from app.jobs.apart import LostProcessError, StoppedError, ignore, run_apart
from planner.errors import FoldError, FoldingError, GarmentError, UnknownGarmentError
from planner.message import Message
from tests.app.processes import descendants, wait_until


def count(tell: Callable[[object], None], up_to: int) -> int:
    for number in range(up_to):
        tell(number)
    return os.getpid()


def run_for_ever(tell: Callable[[object], None]) -> None:
    tell(os.getpid())
    while True:
        pass


def fail(_: object, error: Exception) -> None:
    raise error


def crash(_: object) -> None:
    os._exit(7)


def apart(work: Callable[..., Any], *arguments: object) -> Any:
    return run_apart(work, bool, ignore, *arguments)


def test_work_is_done_in_another_process_and_tells_news_on_the_way() -> None:
    heard: list[object] = []
    assert run_apart(count, bool, heard.append, 3) not in (None, os.getpid())
    assert heard == [0, 1, 2]


def test_work_that_would_never_end_is_ended_when_it_is_stopped() -> None:
    pids: list[int] = []
    stop = threading.Event()

    def note(pid: int) -> None:
        pids.append(pid)
        stop.set()

    with pytest.raises(StoppedError):
        run_apart(run_for_ever, stop.is_set, note)
    wait_until(lambda: pids[0] not in descendants(os.getpid()))


@pytest.mark.parametrize(
    "error",
    [
        GarmentError("outline[3]", "edges cross"),
        FoldError("folds[0].start", "is beside the cloth").within("garment"),
        UnknownGarmentError("nothing"),
        UnitsNeededError(Message("unit_unlikely", "nobody says", {"unit_m": 1.0}), {"mm": (0.1, 0.2)}),
        FoldingError("no"),
    ],
)
def test_an_error_comes_with_all_that_it_holds(error: FoldingError) -> None:
    with pytest.raises(type(error)) as raised:
        apart(fail, error)
    held, expected = dict(raised.value.__dict__), error.__dict__
    held.pop("__notes__")
    assert str(raised.value) == str(error) and held == expected


def test_a_bug_comes_with_the_place_where_it_is() -> None:
    with pytest.raises(ZeroDivisionError) as raised:
        apart(fail, ZeroDivisionError("no"))
    assert "in fail" in raised.value.__notes__[0]


# A template that fails, and then one that does not; `print` is what both are asked for.
PROGRAM = """
from app.jobs import apart

whole, apart._TEMPLATE = apart._TEMPLATE, "tests.app.broken_template"
patience_s, apart._STARTED_WITHIN_S = apart._STARTED_WITHIN_S, 0.5
for _ in range(2):
    try:
        apart.run_apart(print, bool, apart.ignore)
    except apart.PlannerNotLoadedError as error:
        print(error)
apart._TEMPLATE, apart._STARTED_WITHIN_S = whole, patience_s
apart.run_apart(print, bool, apart.ignore)
print("done")
"""


def test_a_template_that_cannot_load_the_planner_is_told_and_replaced() -> None:
    done = subprocess.run([sys.executable, "-c", PROGRAM], capture_output=True, text=True, check=False, timeout=120.0)
    told = [line for line in done.stdout.splitlines() if not line.startswith("<")]
    assert told == ["the planner could not be loaded; the server's log says why"] * 2 + ["done"], done.stderr
    assert "the kernels are for another machine" in done.stderr


@pytest.mark.long
@pytest.mark.slow
def test_a_template_that_was_ended_from_outside_is_replaced() -> None:
    assert apart(count, 1)
    for pid in descendants(os.getpid()):
        if "forkserver" in Path(f"/proc/{pid}/cmdline").read_text():
            os.kill(pid, signal.SIGKILL)
    assert apart(count, 1)


def test_a_process_that_crashes_is_told_from_one_that_was_stopped() -> None:
    with pytest.raises(LostProcessError, match="7"):
        apart(crash)
