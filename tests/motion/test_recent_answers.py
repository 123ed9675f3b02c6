"""Answers are kept while they are used, and whoever gave them is not kept."""

import gc
import weakref

from planner.motion.answer_memory import RecentAnswers


class Asked:
    """Answers with twice the number, and remembers what it was asked."""

    def __init__(self) -> None:
        self.about: list[int] = []
        self.known = RecentAnswers[int, int](2)

    def twice(self, number: int) -> int:
        return self.known.answer(number, self._twice)

    def _twice(self, number: int) -> int:
        self.about.append(number)
        return 2 * number


def test_what_was_used_last_is_kept() -> None:
    asked = Asked()
    assert [asked.twice(number) for number in (1, 2, 1, 3, 1, 2)] == [2, 4, 2, 6, 2, 4]
    assert asked.about == [1, 2, 3, 2], "2 had to make room for 3"


def test_who_answers_goes_without_the_garbage_collector() -> None:
    gc.disable()
    try:
        asked = Asked()
        asked.twice(1)
        gone = weakref.ref(asked)
        del asked
        assert gone() is None
    finally:
        gc.enable()
