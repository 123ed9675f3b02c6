import threading

from app.watched import Watched


def test_no_change_of_several_threads_is_lost() -> None:
    watched = Watched(0)

    def count() -> None:
        for _ in range(500):
            watched.change(lambda value: value + 1)

    threads = [threading.Thread(target=count) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert watched.value == 2000


def test_listeners_are_told_of_changes_alone_and_may_change_the_value_themselves() -> None:
    watched: Watched[tuple[str, ...]] = Watched(("one",))
    told: list[tuple[str, ...]] = []

    def listen() -> None:
        told.append(watched.value)
        watched.change(lambda value: (*value, "more") if len(value) < 3 else value)

    unsubscribe = watched.subscribe(listen)
    watched.change(lambda value: value)
    assert told == []
    assert watched.change(lambda _: ("two",)) == ("two",)
    assert told == [("two",), ("two", "more"), ("two", "more", "more")]
    unsubscribe()
    watched.change(lambda _: ("three",))
    assert len(told) == 3
