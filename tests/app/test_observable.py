import threading

from app.observable import Observable


def test_no_change_of_several_threads_is_lost() -> None:
    observable = Observable(0)

    def count() -> None:
        for _ in range(500):
            observable.change(lambda value: value + 1)

    threads = [threading.Thread(target=count) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert observable.value == 2000


def test_listeners_are_told_of_changes_alone_and_may_change_the_value_themselves() -> None:
    observable: Observable[tuple[str, ...]] = Observable(("one",))
    told: list[tuple[str, ...]] = []

    def listen() -> None:
        told.append(observable.value)
        observable.change(lambda value: (*value, "more") if len(value) < 3 else value)

    unsubscribe = observable.subscribe(listen)
    observable.change(lambda value: value)
    assert told == []
    assert observable.change(lambda _: ("two",)) == ("two",)
    assert told == [("two",), ("two", "more"), ("two", "more", "more")]
    unsubscribe()
    observable.change(lambda _: ("three",))
    assert len(told) == 3
