import gc
import threading
import weakref
from concurrent.futures import wait
from functools import partial

import pytest

from app.jobs.job_pool import JobPool
from app.worker.stop import Stop
from planner import load_garment, make_plan
from tests.patience import PATIENCE_S


def test_no_more_jobs_run_at_once_than_there_are_workers() -> None:
    pool = JobPool(workers=2)
    running, most, lock = 0, 0, threading.Lock()
    both = threading.Barrier(2)

    def work(_: object) -> None:
        nonlocal running, most
        with lock:
            running += 1
            most = max(most, running)
        both.wait(PATIENCE_S)
        with lock:
            running -= 1

    for job in [pool.start(work) for _ in range(6)]:
        job.future.result(PATIENCE_S)
    assert most == 2


def test_a_stopped_job_is_told_and_one_that_waits_never_begins() -> None:
    pool = JobPool(workers=1)
    begun, told = threading.Event(), threading.Event()

    def long_work(should_stop: object) -> None:
        begun.set()
        assert callable(should_stop)
        while not should_stop():
            pass
        told.set()

    first, second = pool.start(long_work), pool.start(long_work)
    assert begun.wait(PATIENCE_S)
    second.stop()
    first.stop()
    assert told.wait(PATIENCE_S)
    assert second.future.cancelled()


def test_closing_the_pool_stops_everything() -> None:
    pool = JobPool(workers=1)

    def until_stopped(should_stop: object) -> str:
        assert callable(should_stop)
        while not should_stop():
            pass
        return "stopped"

    begun = pool.start(until_stopped)
    pool.close()
    assert begun.future.cancelled() or begun.future.result(PATIENCE_S) == "stopped"


def test_a_job_that_comes_while_the_pool_closes_is_stopped_and_keeps_no_thread_from_its_end() -> None:
    pool = JobPool(workers=2)
    begun, threads = threading.Event(), []

    def until_stopped(should_stop: object) -> None:
        threads.append(threading.current_thread())
        begun.set()
        assert callable(should_stop)
        while not should_stop():
            pass
        late = pool.start(until_stopped)
        assert late.future.cancelled()

    job = pool.start(until_stopped)
    assert begun.wait(PATIENCE_S)
    pool.close(5.0)
    job.future.result(PATIENCE_S)
    assert [thread.is_alive() for thread in threads] == [False]


def test_a_jobs_error_comes_with_its_answer() -> None:
    def fail(_: object) -> None:
        raise ValueError("no")

    with pytest.raises(ValueError, match="no"):
        JobPool(workers=1).start(fail).future.result(PATIENCE_S)


def test_a_stopped_search_ends_as_out_of_budget() -> None:
    plan = make_plan(load_garment("shirt"), should_stop=lambda: True)
    assert plan.status == "budget_exceeded"


def test_a_job_that_has_ended_is_freed_at_once_with_all_that_its_work_knew() -> None:
    class Known:
        pass

    def nothing(known: Known, should_stop: Stop) -> None:
        """Do no work, but know something."""

    pool = JobPool(workers=1)
    gc.disable()
    try:
        for is_stopped in (False, True):
            known = Known()
            gone = weakref.ref(known)
            job = pool.start(partial(nothing, known))
            if is_stopped:
                job.stop()
            wait([job.future])
            del known, job
            pool.start(lambda _: None).future.result()  # the thread has let go of the one before by then
            assert gone() is None
    finally:
        gc.enable()
        pool.close()
