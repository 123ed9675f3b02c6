"""Long work gives way to short work, and takes turns while short work keeps coming."""

import threading
from concurrent.futures import wait

import pytest

from app.jobs.courtesy import GIVE_WAY_S, RECENT_S, WAIT_SHARE, Courtesy, LongWork
from app.jobs.job_pool import JobPool, ShouldStop
from tests.patience import PATIENCE_S


class Clock:
    """A clock that is set by hand."""

    def __init__(self) -> None:
        self.now_s = 0.0

    def __call__(self) -> float:
        return self.now_s


def ran_together(courtesy: Courtesy) -> int:
    """Return how many of three jobs were at work at once, at most; each asks fifty times whether to stop."""
    lock, at_work, most = threading.Lock(), 0, 0

    def work(should_stop: ShouldStop) -> None:
        nonlocal at_work, most
        should_stop()
        for _ in range(50):
            with lock:
                at_work += 1
                most = max(most, at_work)
            threading.Event().wait(0.0005)
            with lock:
                at_work -= 1
            should_stop()

    pool = JobPool(workers=3, courtesy=courtesy)
    wait([pool.start(work).future for _ in range(3)])
    pool.close()
    return most


def test_short_work_is_done_one_after_the_other_unless_some_takes_long() -> None:
    courtesy = Courtesy(Clock())
    begun, go, order = threading.Event(), threading.Event(), list[str]()

    def hold() -> None:
        with courtesy.short_work():
            begun.set()
            assert go.wait(PATIENCE_S)
            order.append("first")

    def follow() -> None:
        with courtesy.short_work():
            order.append("second")

    for ends, expected in ((True, ["first", "second"]), (False, ["second", "first"])):
        order.clear()
        begun.clear()
        go.clear()
        first, second = threading.Thread(target=hold), threading.Thread(target=follow)
        first.start()
        assert begun.wait(PATIENCE_S)
        second.start()
        if ends:  # the second waits in vain, and then goes on without a turn
            threading.Timer(0.2 * GIVE_WAY_S, go.set).start()
            first.join()
            second.join()
        else:
            second.join()
            go.set()
            first.join()
        assert order == expected


def test_long_work_waits_for_short_work_in_proportion_to_what_it_has_done() -> None:
    courtesy, clock = Courtesy(Clock()), Clock()
    waited: list[float] = []
    courtesy.give_way = waited.append  # type: ignore[method-assign]
    work = LongWork(courtesy, clock)
    for worked_s in (0.01, 0.2):
        clock.now_s += worked_s
        work.give_way()
        work.end()
    assert waited == pytest.approx([WAIT_SHARE * 0.01, WAIT_SHARE * 0.2])


def test_searches_take_turns_while_short_work_keeps_coming() -> None:
    clock = Clock()
    courtesy = Courtesy(clock)
    assert ran_together(courtesy) > 1
    with courtesy.short_work():
        pass
    assert ran_together(courtesy) == 1
    clock.now_s += RECENT_S
    assert ran_together(courtesy) > 1


def test_a_turn_goes_to_the_one_that_waits_and_not_back_to_who_had_it() -> None:
    courtesy = Courtesy(Clock())
    with courtesy.short_work():
        pass
    order: list[str] = []
    first, second = LongWork(courtesy), LongWork(courtesy)
    first.give_way()

    def ask() -> None:
        second.give_way()
        order.append("second")
        second.end()

    asking = threading.Thread(target=ask)
    asking.start()
    while not courtesy._next.locked():
        threading.Event().wait(0.001)
    first.give_way()
    order.append("first")
    asking.join()
    first.end()
    assert order == ["second", "first"]


def test_who_keeps_a_turn_for_long_does_not_hold_the_others_up_for_ever() -> None:
    courtesy = Courtesy(Clock())
    with courtesy.short_work():
        pass
    keeps, waits = LongWork(courtesy), LongWork(courtesy)
    keeps.give_way()
    clock = threading.Timer(60.0, keeps.end)
    clock.start()
    waits.give_way()  # ends after GIVE_WAY_S, without a turn
    assert clock.is_alive() and GIVE_WAY_S < 60.0
    clock.cancel()
    waits.end()
    keeps.end()
