"""Answers are kept while they are used, and whoever gave them is not kept."""

import gc
import weakref

from planner.motion.answer_memory import RecentAnswers, digest


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


def test_a_question_is_asked_once_even_where_the_answer_is_no() -> None:
    known, asked = RecentAnswers[int, bool](8), list[int]()

    def ask(key: int) -> bool:
        asked.append(key)
        return False

    assert [known.answer(1, ask) for _ in range(3)] == [False] * 3
    assert asked == [1]


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


def test_in_a_digest_no_byte_passes_from_one_part_to_the_next() -> None:
    assert digest(b"ab", b"c") == digest(b"ab", b"c") != digest(b"a", b"bc")
