"""A stop is set once, and wakes whoever has asked for that."""

from app.worker.stop import Stop


def test_what_is_to_be_done_then_is_done_once_and_at_once_where_it_is_set_already() -> None:
    stop, done = Stop(), list[str]()
    stop.then(lambda: done.append("before"))
    assert not stop() and not done
    stop.set()
    stop.set()
    stop.then(lambda: done.append("after"))
    assert stop() and done == ["before", "after"]


def test_what_was_taken_back_is_not_done() -> None:
    stop, done = Stop(), list[str]()
    forget = stop.then(lambda: done.append("taken back"))
    stop.then(lambda: done.append("kept"))
    forget()
    stop.set()
    assert done == ["kept"]
