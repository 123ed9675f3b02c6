"""Short answers kept by digests of long questions."""

from functools import partial

from planner.motion.answer_memory import AnswerMemory


def test_a_question_is_asked_once_even_where_the_answer_is_no() -> None:
    memory, asked = AnswerMemory[bool](8), list[str]()

    def ask() -> bool:
        asked.append("asked")
        return False

    assert [memory.answer(ask, b"cloth", b"joints") for _ in range(3)] == [False] * 3
    assert len(asked) == 1


def test_no_byte_passes_from_one_part_to_the_next() -> None:
    memory = AnswerMemory[float](8)
    assert memory.answer(lambda: 1.0, b"ab", b"c") == 1.0
    assert memory.answer(lambda: 2.0, b"a", b"bc") == 2.0


def test_once_there_are_many_answers_all_are_forgotten() -> None:
    memory = AnswerMemory[float](2)
    for number in range(3):
        memory.answer(partial(float, number), bytes([number]))
    assert memory.answer(lambda: 9.0, bytes([0])) == 9.0
    assert memory.answer(lambda: 9.0, bytes([2])) == 2.0
