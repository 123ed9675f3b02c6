"""Workers: warm processes that do pieces of work, and end when their answer is no longer wanted."""

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from app.files.import_errors import UnitsNeededError
from app.worker.process import Caller, ignore
from app.worker.stop import Stop, StoppedError
from app.worker.template import LostProcessError
from app.worker.workers import Team, Workers
from planner.errors import FoldError, FoldingError, GarmentError, UnknownGarmentError
from planner.message import Message
from planner.robots.own_robots import robots_folder, use_robots_folder
from tests.app.processes import descendants, is_alive
from tests.patience import FOR_EVER_S, PATIENCE_S, wait_until


def count(caller: Caller, up_to: int) -> int:
    for number in range(up_to):
        caller.tell(number)
    return os.getpid()


def run_for_ever(caller: Caller) -> None:
    caller.tell(os.getpid())
    while True:
        pass


def until_stopped(caller: Caller) -> int:
    caller.tell(os.getpid())
    wait_until(caller.should_stop)
    return 1


def wait_for(caller: Caller, file: Path) -> int:
    caller.tell(os.getpid())
    wait_until(file.exists)
    return os.getpid()


def start_a_child(_: Caller) -> int:
    return subprocess.Popen([sys.executable, "-c", f"import time; time.sleep({FOR_EVER_S})"]).pid


def fail(_: Caller, error: Exception) -> None:
    raise error


def crash(_: Caller) -> None:
    os._exit(7)


def answer_with_what_cannot_be_sent(_: Caller) -> object:
    return lambda: None


def niceness(_: Caller) -> int:
    return os.nice(0)


def folder_of_robots(_: Caller) -> Path:
    return robots_folder()


def count_in_workers_of_its_own(_: Caller) -> tuple[int, int]:
    with Workers() as own:
        return os.getpid(), own.run(count, Stop(), ignore, 1)


@pytest.fixture(scope="module")
def shared() -> Iterator[Workers]:
    with Workers(kept=2) as workers:
        yield workers


@pytest.fixture
def workers() -> Iterator[Workers]:
    with Workers(kept=2) as workers:
        yield workers


def done(workers: Workers, work: Any, *arguments: object) -> Any:
    return workers.run(work, Stop(), ignore, *arguments)


def test_work_is_done_in_another_process_and_tells_news_on_the_way(shared: Workers) -> None:
    heard: list[object] = []
    assert shared.run(count, Stop(), heard.append, 3) not in (None, os.getpid())
    assert heard == [0, 1, 2]


def test_the_next_work_finds_the_worker_warm(workers: Workers) -> None:
    assert done(workers, count, 1) == done(workers, count, 1)


def test_work_for_a_key_goes_to_the_worker_that_served_it_and_other_work_elsewhere(workers: Workers) -> None:
    served = {key: workers.run_for(key, count, Stop(), ignore, 1) for key in "ab"}
    assert served["a"] != served["b"]
    for key in "baab":
        assert workers.run_for(key, count, Stop(), ignore, 1) == served[key]


def test_work_for_a_key_waits_for_earlier_work_for_it(workers: Workers, tmp_path: Path) -> None:
    begun = threading.Event()
    with ThreadPoolExecutor(2) as threads:
        first = threads.submit(workers.run_for, "a", wait_for, Stop(), lambda _: begun.set(), tmp_path / "go")
        assert begun.wait(FOR_EVER_S)
        second = threads.submit(workers.run_for, "a", count, Stop(), ignore, 1)
        assert done(workers, count, 1) != 0
        assert not second.done()
        (tmp_path / "go").touch()
        assert first.result() == second.result()


def test_who_waits_for_the_worker_of_a_key_can_be_stopped(workers: Workers, tmp_path: Path) -> None:
    begun, stop = threading.Event(), Stop()
    with ThreadPoolExecutor(2) as threads:
        first = threads.submit(workers.run_for, "a", wait_for, Stop(), lambda _: begun.set(), tmp_path / "go")
        assert begun.wait(FOR_EVER_S)
        second = threads.submit(workers.run_for, "a", count, stop, ignore, 1)
        stop.set()
        with pytest.raises(StoppedError):
            second.result()
        (tmp_path / "go").touch()
        first.result()


def test_no_more_idle_workers_are_kept_than_asked_for(workers: Workers, tmp_path: Path) -> None:
    done(workers, count, 1)  # the template of all workers runs, and stays
    workers.end_idle()
    before = descendants(os.getpid())
    running: list[int] = []
    with ThreadPoolExecutor(3) as threads:
        futures = [threads.submit(workers.run, wait_for, Stop(), running.append, tmp_path / "go") for _ in range(3)]
        wait_until(lambda: len(running) == 3)
        (tmp_path / "go").touch()
        assert len({future.result() for future in futures}) == 3
    wait_until(lambda: sum(map(is_alive, running)) == 2)
    workers.end_idle()
    assert not any(map(is_alive, running))
    assert descendants(os.getpid()) <= before


def test_work_that_is_stopped_may_end_by_itself_and_its_worker_stays(workers: Workers) -> None:
    pids, stop = [], Stop()

    def note(pid: int) -> None:
        pids.append(pid)
        stop.set()

    with pytest.raises(StoppedError):
        workers.run(until_stopped, stop, note)
    assert [done(workers, count, 1)] == pids
    # The stop was for the work before: the next is not stopped by it.
    pids.clear()
    stop = Stop()
    with pytest.raises(StoppedError):
        workers.run(until_stopped, stop, note)
    assert [done(workers, count, 1)] == pids


@pytest.mark.parametrize("is_alone", [False, True])
def test_work_that_would_never_end_is_killed_when_it_is_stopped(workers: Workers, is_alone: bool) -> None:
    pids: list[int] = []
    stop = Stop()

    def note(pid: int) -> None:
        pids.append(pid)
        stop.set()

    with pytest.raises(StoppedError):
        (workers.run_alone if is_alone else workers.run)(run_for_ever, stop, note)
    wait_until(lambda: not is_alive(pids[0]))


def test_what_is_stopped_before_it_begins_does_not_begin(workers: Workers) -> None:
    stop = Stop()
    stop.set()
    with pytest.raises(StoppedError):
        workers.run(run_for_ever, stop, ignore)


def test_work_done_alone_ends_with_its_process_and_all_that_it_started(workers: Workers) -> None:
    warm = done(workers, count, 1)
    assert workers.run_alone(count, Stop(), ignore, 1) != warm
    child = workers.run_alone(start_a_child, Stop(), ignore)
    wait_until(lambda: not is_alive(child))
    assert done(workers, count, 1) == warm


def test_a_worker_that_has_been_killed_meanwhile_is_replaced(workers: Workers) -> None:
    pid = done(workers, count, 1)
    os.kill(pid, signal.SIGKILL)
    wait_until(lambda: not is_alive(pid))
    assert done(workers, count, 1) != pid


def test_an_error_of_the_listener_ends_the_work(workers: Workers) -> None:
    def refuse(pid: int) -> None:
        raise ValueError(pid)

    with pytest.raises(ValueError, match=r"\d") as raised:
        workers.run(run_for_ever, Stop(), refuse)
    wait_until(lambda: not is_alive(raised.value.args[0]))


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
def test_an_error_comes_with_all_that_it_holds_and_the_worker_stays(shared: Workers, error: FoldingError) -> None:
    with pytest.raises(type(error)) as raised:
        done(shared, fail, error)
    held, expected = dict(raised.value.__dict__), error.__dict__
    held.pop("__notes__")
    assert str(raised.value) == str(error) and held == expected
    assert done(shared, count, 1)


def test_a_bug_comes_with_the_place_where_it_is(shared: Workers) -> None:
    with pytest.raises(ZeroDivisionError) as raised:
        done(shared, fail, ZeroDivisionError("no"))
    assert "in fail" in raised.value.__notes__[0]


def test_what_cannot_be_sent_is_an_error_either_way(shared: Workers) -> None:
    with pytest.raises(AttributeError, match="lambda"):
        done(shared, answer_with_what_cannot_be_sent)
    with pytest.raises(AttributeError, match="lambda"):
        done(shared, count, lambda: None)
    assert done(shared, count, 1)


def test_a_process_that_crashes_is_told_from_one_that_was_stopped(shared: Workers) -> None:
    with pytest.raises(LostProcessError, match="7"):
        done(shared, crash)


def test_a_worker_looks_for_robots_where_its_caller_does(
    shared: Workers, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("planner.robots.own_robots._chosen", [])
    for name in ("one", "other"):
        use_robots_folder(tmp_path / name)
        assert done(shared, folder_of_robots) == tmp_path / name


def test_a_worker_may_have_workers_of_its_own_that_end_with_it(workers: Workers) -> None:
    pid, below = workers.run_alone(count_in_workers_of_its_own, Stop(), ignore)
    assert pid != below
    wait_until(lambda: not is_alive(pid) and not is_alive(below))


# A template that fails, and then one that does not; what they are asked for is the niceness of their workers.
PROGRAM = """
from app.worker import process, stop, template, workers
from tests.app.worker.test_workers import niceness

def ask(more):
    with workers.Workers(niceness=more) as some:
        return some.run(niceness, stop.Stop(), process.ignore)

whole, template._PRELOADED = template._PRELOADED, "tests.app.worker.broken_template"
patience_s, template._STARTED_WITHIN_S = template._STARTED_WITHIN_S, 0.5
for _ in range(2):
    try:
        ask(0)
    except template.PlannerNotLoadedError as error:
        print(error)
template._PRELOADED, template._STARTED_WITHIN_S = whole, patience_s
print(ask(0))
print(ask(3))
"""


def test_a_template_that_cannot_load_the_planner_is_told_and_replaced_and_workers_in_the_background_are_nicer() -> None:
    even = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    command = [sys.executable, "-c", PROGRAM]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=PATIENCE_S, env=even)
    *told, usual, nicer = done.stdout.splitlines()
    assert told == ["the planner could not be loaded; the server's log says why"] * 2, done.stderr
    assert "the kernels are for another machine" in done.stderr
    assert 0 < int(usual) < 16 and int(nicer) == int(usual) + 3


@pytest.mark.long
@pytest.mark.slow
def test_a_template_that_was_ended_from_outside_is_replaced(workers: Workers) -> None:
    assert done(workers, count, 1)
    for pid in descendants(os.getpid()):
        if "forkserver" in Path(f"/proc/{pid}/cmdline").read_text():
            os.kill(pid, signal.SIGKILL)

            def is_gone(pid: int = pid) -> bool:
                return not is_alive(pid)

            wait_until(is_gone)
    assert done(workers, count, 1)


def test_a_team_that_is_left_stops_what_it_has_begun_and_begins_nothing_more() -> None:
    begun = threading.Event()
    with Team(1) as team:
        running = team.start(team.run, run_for_ever, team.stop, lambda _: begun.set())
        waiting = team.start(team.run, count, team.stop, ignore, 1)
        assert begun.wait(PATIENCE_S)
    with pytest.raises(StoppedError):
        running.result()
    assert waiting.cancelled()
