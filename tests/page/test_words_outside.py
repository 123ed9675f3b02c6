"""No word that a person reads stands outside the catalogues."""

import re
from html.parser import HTMLParser

from tests.page.catalogues import ENGLISH
from tests.page.scripts import STATIC, Text, texts

READ_IN = {
    "label",
    "text",
    "hint",
    "title",
    "textContent",
    "placeholder",
    "ariaLabel",
    "words",
    "refuse#0",
    "notice#0",
    "openDialog#0",
    "append#0",
    "replaceChildren#0",
    "Error#0",
    *(f"element#{n}" for n in range(2, 9)),
    *(f"button#{n}" for n in range(2, 9)),
}
"""Where a text is read by a person, whatever it says."""

NOT_READ_IN = {
    "say#0",
    "inEnglish#0",
    "element#0",
    "element#1",
    "button#0",
    "querySelector#0",
    "matchMedia#0",
    "comparison",
}
"""Where a text is a key or a name, whatever it says."""

ALLOWED = {
    "board/rules.js": "in English; shown by `translated`",
    "board/edits.js": "the halves of English fold names, left for right",
    "dom.js": "says to a programmer that an element is missing",
    "main.js": "the name of the program",
}
"""Scripts in which a text may look like words, and why."""

SENTENCE = re.compile(
    r"[A-Z][a-z]+ [a-z]|[a-z]{2,}[,.:;!?]? [a-z]{2,}|\b[A-Z][a-z]{2,}[.!?\u2026]|^[A-Z][a-z]{2,}$|[a-z] \{\}"
)
"""Matches text for people: a sentence, or a word that begins with a capital."""

CLASSES = re.compile(r"^[a-z{}][a-z{}-]*( (is-|has-)?[a-z{}][a-z{}-]*)*$")
"""Names of styles, one after the other."""

KEYS = {
    "Escape",
    "Enter",
    "Tab",
    "Backspace",
    "Delete",
    "Home",
    "End",
    "Shift",
    "Arrow",
    "ArrowUp",
    "ArrowDown",
    "ArrowLeft",
    "ArrowRight",
    "ContextMenu",
}
"""Names of keys, as the browser tells them."""


def is_read(text: Text) -> bool:
    """Return whether a text is one that a person reads."""
    if text.context in NOT_READ_IN or text.words in {*KEYS, *ENGLISH} or not re.search("[A-Za-z]{2}", text.words):
        return False
    if text.context in READ_IN:
        return not re.fullmatch(r"[^A-Za-z]*(\{\}[^A-Za-z]*)*", text.words)
    return bool(SENTENCE.search(text.words)) and not CLASSES.match(text.words)


def test_no_script_says_a_word_of_its_own() -> None:
    found = [text for text in texts() if is_read(text)]
    assert [text for text in found if text.file not in ALLOWED] == []
    assert {text.file for text in found} == set(ALLOWED), "an exception that is none any more"


class Read(HTMLParser):
    """Gathers what a person reads of a page as it comes, before any script has run."""

    def __init__(self) -> None:
        """Begin with none."""
        super().__init__()
        self.words: list[str] = []

    def handle_starttag(self, _: str, attrs: list[tuple[str, str | None]]) -> None:
        """Take the names and hints of an element."""
        self.words += [
            value for name, value in attrs if name in {"aria-label", "title", "placeholder", "alt"} and value
        ]

    def handle_data(self, data: str) -> None:
        """Take the text between tags that is no script."""
        self.words += [data.strip()] if data.strip() and self.cdata_elem is None else []


def test_the_page_itself_says_its_name_alone() -> None:
    page = Read()
    page.feed((STATIC / "index.html").read_text(encoding="utf-8"))
    assert set(page.words) == {"Pleat"}
