"""Texts that all pages of a document are sent are made once."""

from concurrent.futures import ThreadPoolExecutor

from app.open_document import SharedTexts


def test_a_text_is_made_once_for_all_who_ask_and_anew_for_another_key() -> None:
    texts = SharedTexts()
    made: list[int] = []

    def make() -> str:
        made.append(len(made))
        return f"text {made[-1]}"

    with ThreadPoolExecutor(8) as askers:
        assert set(askers.map(lambda _: texts.text("plan", 1, make), range(40))) == {"text 0"}
    assert texts.text("plan", 2, make) == "text 1"
    assert texts.text("document", 2, make) == "text 2"
    assert texts.text("plan", 2, make) == "text 1"
    assert made == [0, 1, 2]
